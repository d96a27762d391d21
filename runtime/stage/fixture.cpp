#include "runtime/stage/fixture.h"

#include <map>

namespace probe::stage {

Fixture fixture_of(const plan::Plan& plan, const plan::FixtureRecord& record) {
  Fixture fixture;
  fixture.name = std::string(plan.text(record.name));
  fixture.urdf = std::string(plan.text(plan.assets()[record.urdf].path));
  fixture.base = {to_vec(record.position), to_quat(record.rotation)};
  fixture.friction = record.friction;
  const auto armatures = plan.armatures(record);
  for (const plan::FixtureJointRecord& joint : plan.joints(record)) {
    world::JointSpec spec;
    spec.joint = std::string(plan.text(joint.joint));
    spec.stiffness = joint.stiffness;
    spec.damping = joint.damping;
    spec.friction = joint.friction;
    spec.rest = joint.rest;
    if (!armatures.empty()) spec.armature = armatures[fixture.joints.size()];
    fixture.joints.push_back(std::move(spec));
    fixture.positions.push_back(joint.start);
  }
  for (const plan::ShownRecord& shown : plan.shown(record)) {
    fixture.shown.push_back({std::string(plan.text(shown.link)), shown.joint,
                             shown.side == static_cast<std::uint32_t>(plan::ShownSide::kBelow),
                             shown.at});
  }
  return fixture;
}

Status check_parts(const plan::Plan& plan, const plan::FixtureRecord& record,
                   const robot::RobotModel& model) {
  const std::string urdf(plan.text(plan.assets()[record.urdf].path));
  const auto quoted = [&plan](plan::StringRef text) {
    return "`" + std::string(plan.text(text)) + "`";
  };
  std::map<int, const plan::PartRecord*> by_link;
  for (const plan::PartRecord& part : plan.parts(record)) {
    const int link = model.find_link(plan.text(part.link));
    const std::string what = "link " + quoted(part.link) + " for part " + quoted(part.name);
    if (link < 0) return Failure{Fault::kUrdf, "no " + what, urdf};
    if (!model.links[static_cast<std::size_t>(link)].can_collide())
      return Failure{Fault::kUrdf, what + " has no collision, nothing can touch it", urdf};
    const auto [known, is_new] = by_link.emplace(link, &part);
    if (!is_new)
      return Failure{Fault::kUrdf, what + " is part " + quoted(known->second->name), urdf};
    if (by_link.rbegin()->first != link)
      return Failure{Fault::kUrdf, what + " is not in the description's order", urdf};
  }
  for (const plan::ShownRecord& shown : plan.shown(record)) {
    const int link = model.find_link(plan.text(shown.link));
    const std::string what = "link " + quoted(shown.link) + ", which is seen at times,";
    if (link < 0) return Failure{Fault::kUrdf, "no " + what, urdf};
    if (model.links[static_cast<std::size_t>(link)].can_collide())
      return Failure{Fault::kUrdf, what + " has collision: what is felt is always seen", urdf};
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].can_collide() || by_link.contains(static_cast<int>(i))) continue;
    return Failure{
        Fault::kUrdf,
        "link `" + model.links[i].name + "` is no part of fixture " + quoted(record.name), urdf};
  }
  return {};
}

}  // namespace probe::stage
