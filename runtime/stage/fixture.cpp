#include "runtime/stage/fixture.h"

namespace probe::stage {

Fixture fixture_of(const plan::Plan& plan, const plan::FixtureRecord& record) {
  Fixture fixture;
  fixture.name = std::string(plan.text(record.name));
  fixture.urdf = std::string(plan.text(plan.assets()[record.urdf].path));
  const auto& q = record.rotation;
  fixture.base = {to_vec(record.position), Quat(q[0], q[1], q[2], q[3])};
  fixture.friction = record.friction;
  for (const plan::FixtureJointRecord& joint : plan.joints(record)) {
    world::JointSpec spec;
    spec.joint = std::string(plan.text(joint.joint));
    spec.stiffness = joint.stiffness;
    spec.damping = joint.damping;
    spec.friction = joint.friction;
    spec.rest = joint.rest;
    fixture.joints.push_back(std::move(spec));
    fixture.positions.push_back(joint.start);
  }
  return fixture;
}

}  // namespace probe::stage
