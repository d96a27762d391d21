#include "compiler/define/weight.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace probe::sema {
namespace {

// How far a joint goes from where it stands at 0, at most: m or rad.
double farthest(const robot::RobotModel& model, const robot::Joint& joint) {
  const bool follows = joint.mimic >= 0;
  const robot::Joint& own = follows ? model.joints[static_cast<std::size_t>(joint.mimic)] : joint;
  if (own.kind == robot::JointKind::kContinuous && joint.mimic_scale != 0)
    return std::numeric_limits<double>::infinity();
  const auto at = [&](double position) {
    return std::abs(follows ? joint.mimic_scale * position + joint.mimic_offset : position);
  };
  return std::max(at(own.lower), at(own.upper));
}

// What a joint carries: kg, and kg m of levers about its axis, at most.
struct Load {
  double mass = 0, moment = 0;
};

// Where a link is, seen from a joint above: known over fixed joints only, and by no more than
// `slack` elsewhere once another moves it.
struct Hung {
  Pose pose;
  double slack = 0;  // m
  bool is_loose = false;
};

// Adds what hangs at a link. Lengths add up, so no way of the joints below has a longer lever.
void add_load(const robot::RobotModel& model, int link, const Hung& hung, const Vec3& axis,
              Load& load) {
  const robot::Link& here = model.links[static_cast<std::size_t>(link)];
  const Vec3 at = hung.is_loose ? hung.pose.position : hung.pose.apply(here.center_of_mass);
  const double slack = hung.slack + (hung.is_loose ? here.center_of_mass.norm() : 0);
  load.mass += here.mass;
  if (here.mass > 0) load.moment += here.mass * (axis.cross(at).norm() + slack);
  for (const robot::Joint& joint : model.joints) {
    if (joint.parent_link != link) continue;
    Hung next = hung;
    if (hung.is_loose) {
      next.slack += joint.origin.position.norm();
    } else {
      next.pose = hung.pose * joint.origin;
    }
    next.is_loose = hung.is_loose || joint.kind != robot::JointKind::kFixed;
    if (joint.kind == robot::JointKind::kPrismatic) next.slack += farthest(model, joint);
    add_load(model, joint.child_link, next, axis, load);
  }
}

// Without what follows the joint. How its axis leans is known where no joint above turns it.
double weight_on_alone(const Fixture& fixture, const robot::Joint& joint) {
  const robot::RobotModel& model = *fixture.model;
  Quat turn = joint.origin.rotation;
  bool is_turned = false;
  for (int link = joint.parent_link;
       model.links[static_cast<std::size_t>(link)].parent_joint >= 0;) {
    const robot::Joint& above = model.joints[static_cast<std::size_t>(
        model.links[static_cast<std::size_t>(link)].parent_joint)];
    is_turned = is_turned || above.kind == robot::JointKind::kRevolute ||
                above.kind == robot::JointKind::kContinuous;
    turn = above.origin.rotation * turn;
    link = above.parent_link;
  }
  const Vec3 axis = to_quat(fixture.turn.rotation) * (turn * joint.axis);
  Load load;
  add_load(model, joint.child_link, {}, joint.axis, load);
  constexpr double kGravity = 9.81;
  const double upright = std::min(1.0, std::abs(axis.z()));
  if (joint.kind == robot::JointKind::kPrismatic)
    return load.mass * kGravity * (is_turned ? 1 : upright);
  const double level = is_turned ? 1 : std::sqrt(1 - upright * upright);
  return level > 0 ? load.moment * kGravity * level : 0;
}

}  // namespace

double weight_on(const Fixture& fixture, int joint) {
  const robot::RobotModel& model = *fixture.model;
  double force = weight_on_alone(fixture, model.joints[static_cast<std::size_t>(joint)]);
  for (const robot::Joint& follower : model.joints) {
    if (follower.mimic == joint && follower.mimic_scale != 0)
      force += std::abs(follower.mimic_scale) * weight_on_alone(fixture, follower);
  }
  return force;
}

}  // namespace probe::sema
