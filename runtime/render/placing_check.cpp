#include "runtime/render/placing_check.h"

#include <cmath>

namespace probe::render {

Status check_origin(const Visual& visual) {
  if (is_finite(visual.origin) && std::abs(visual.origin.rotation.norm() - 1) <= 1e-6) return {};
  return Failure{Fault::kRender, "the visual's origin is not finite or not a rotation",
                 visual.name};
}

Status check_poses(std::span<const Pose> poses, std::size_t count,
                   const std::function<std::string(std::size_t)>& name_of) {
  if (poses.size() != count) {
    return Failure{
        Fault::kRender,
        std::to_string(poses.size()) + " poses for " + std::to_string(count) + " visuals", ""};
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (is_finite(poses[i]) && std::abs(poses[i].rotation.squaredNorm() - 1) < 1e-3 &&
        poses[i].position.norm() < 1e6)
      continue;
    return Failure{Fault::kRender, "the pose is not finite, not rigid or farther than 1000 km",
                   name_of(i)};
  }
  return {};
}

}  // namespace probe::render
