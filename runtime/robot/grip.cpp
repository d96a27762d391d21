#include "runtime/robot/grip.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace probe::robot {

double FingerRange::openness(std::span<const double> fingers) const {
  if (fingers.empty() || open == closed) return 1;
  double sum = 0;
  for (const double finger : fingers) sum += finger;
  const double mean = sum / static_cast<double>(fingers.size());
  return std::clamp((mean - closed) / (open - closed), 0.0, 1.0);
}

Result<FingerRange> finger_range(const RobotModel& model, std::span<const std::string> joints,
                                 bool opens_up) {
  FingerRange range;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string& name = joints[i];
    const int j = model.find_joint(name);
    if (j < 0)
      return Failure{Fault::kUrdf, fmt::format("no joint is named `{}`", name), model.path};
    const Joint& joint = model.joints[std::size_t(j)];
    if (joint.kind != JointKind::kPrismatic && joint.kind != JointKind::kRevolute) {
      return Failure{Fault::kUrdf,
                     fmt::format("the finger joint `{}` has no limits to move within", name),
                     model.path};
    }
    if (i == 0) range = {joint.lower, joint.upper};
    if (i == 0 && !opens_up) std::swap(range.closed, range.open);
  }
  return range;
}

}  // namespace probe::robot
