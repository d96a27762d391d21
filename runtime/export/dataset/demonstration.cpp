#include "runtime/export/dataset/demonstration.h"

#include "runtime/robot/action_space.h"
#include "runtime/robot/laws.h"

namespace probe::dataset {

std::vector<std::string> action_names(const Shape& shape) {
  if (shape.law.empty()) return robot::ActionSpace{}.names();
  std::vector<std::string> names = shape.joints;
  names.resize(shape.action_size - 1);
  names.emplace_back("gripper");
  return names;
}

std::string action_meaning(const Shape& shape) {
  const robot::KindRow* law = robot::find_kind(shape.law);
  if (law == nullptr) {
    return "change of the end effector in the robot's base frame: m, rotation vector in rad; "
           "gripper, -1 closed to 1 open, absolute";
  }
  return std::string(law->layout == robot::ActionLayout::kJoints ? "position" : "step") +
         " of each arm joint, rad and m; gripper, -1 closed to 1 open, absolute";
}

}  // namespace probe::dataset
