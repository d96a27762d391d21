#include "runtime/robot/action_space.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "runtime/base/check.h"

namespace probe::robot {
namespace {

constexpr std::array<std::string_view, kActionSize> kToolNames = {"dx", "dy", "dz",     "rx",
                                                                  "ry", "rz", "gripper"};

}  // namespace

std::vector<std::string> ActionSpace::names() const {
  if (!is_of_joints()) return {kToolNames.begin(), kToolNames.end()};
  std::vector<std::string> all = joints;
  all.emplace_back(kToolNames.back());
  return all;
}

ActionSpace action_space_of(const Robot& robot) {
  const KindRow& row = row_of(robot.law);
  if (!row.per_joint) return {};
  ActionSpace space{row.layout};
  for (const std::string& name : robot.control.arm_joints) {
    const int index = robot.model->find_joint(name);
    PROBE_CHECK(index >= 0, "the arm's joints are the description's");
    const Joint& joint = robot.model->joints[static_cast<std::size_t>(index)];
    space.joints.push_back(name);
    space.slides.push_back(joint.kind == JointKind::kPrismatic);
  }
  return space;
}

Action standstill(const ActionSpace& space, std::span<const double> joints, double gripper) {
  Action stay = Action::zeros(space.size());
  if (space.layout == ActionLayout::kJoints) {
    PROBE_CHECK(joints.size() >= space.joints.size(), "a position for each joint of the arm");
    std::copy_n(joints.begin(), space.joints.size(), stay.begin());
  }
  stay.gripper() = gripper;
  return stay;
}

}  // namespace probe::robot
