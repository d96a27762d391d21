#include "compiler/model/moving_joint.h"

namespace probe::sema {

const robot::Joint* moving_joint(const robot::RobotModel& model, int link) {
  while (true) {
    const int above = model.links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) return nullptr;
    const robot::Joint& joint = model.joints[static_cast<std::size_t>(above)];
    if (joint.kind != robot::JointKind::kFixed) return &joint;
    link = joint.parent_link;
  }
}

std::string no_travel(const Fixture& fixture, const Fixture::Part& part) {
  const std::string name = "`" + fixture.body_name(part) + "`";
  const robot::RobotModel& model = *fixture.model;
  const robot::Joint* joint = moving_joint(model, part.index);
  if (joint == nullptr || joint->mimic < 0) return "nothing moves " + name + ", it has no travel";
  const std::string leader =
      "`" + fixture.name + "." + model.joints[static_cast<std::size_t>(joint->mimic)].name + "`";
  return name + " follows " + leader + " and has no travel of its own: measure " + leader;
}

}  // namespace probe::sema
