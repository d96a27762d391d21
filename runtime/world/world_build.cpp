#include "runtime/world/world_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "runtime/plan/magnitudes.h"
#include "runtime/world/colliders.h"

namespace probe::world {
namespace {

using std::size_t;

constexpr double kBeyondLimit = 1e-3;  // m or rad that a joint may start past a limit, by rounding
// s, of a substep: ten times the reference's; tests go to 5 ms. A plan's verifier asks the same.
constexpr double kLongest = 1 / plan::info(plan::Magnitude::kPhysicsRate).least;
constexpr double kEndless = std::numeric_limits<double>::infinity();

Failure fail(std::string message) { return {Fault::kWorld, std::move(message), ""}; }

// A mass of its own may have moments that were rounded for printing.
constexpr double kRounded = 2e-3;

bool is_solid(const scene::CollisionShape& shape) {
  if (shape.parts.empty() || !(shape.volume > 0) || !std::isfinite(shape.volume)) return false;
  if (!shape.center_of_mass.allFinite() || !shape.unit_inertia.allFinite()) return false;
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(shape.unit_inertia).eigenvalues();
  return moments[0] > 0 && moments[0] + moments[1] >= moments[2] * (1 - kRounded);
}

Status check_numbers(const WorldSpec& spec) {
  if (!(spec.dt > 0) || !(spec.dt <= kLongest))
    return fail(fmt::format("the substep must be above 0 and at most {:g} s", kLongest));
  if (!spec.gravity.allFinite() || !std::isfinite(spec.surface_z))
    return fail("gravity or surface is not finite");
  if (!(spec.surface_friction >= 0) || !std::isfinite(spec.surface_friction)) {
    return fail("the surface's friction is negative or not finite");
  }
  if (!(spec.linear_damping >= 0) || !(spec.angular_damping >= 0))
    return fail("damping is negative or not a number");
  if (!(spec.air.density >= 0) || !(spec.air.viscosity >= 0) ||
      !std::isfinite(spec.air.density + spec.air.viscosity)) {
    return fail("the air's density or viscosity is negative or not finite");
  }
  return {};
}

// "the robot" for the one that most worlds have, else by name.
std::string called(const WorldSpec& spec, const ArticulationSpec& articulation) {
  if (spec.articulations.size() == 1 && articulation.driven) return "the robot";
  const bool named = !articulation.name.empty();
  return "`" + (named ? articulation.name : articulation.model->name) + "`";
}

class Builder {
 public:
  explicit Builder(const WorldSpec& spec) : spec_(spec), stepper_(*made_.stepper) {}
  Result<BuiltWorld> build();

 private:
  Status add_articulation(const ArticulationSpec& articulation);
  Status add_joints(const ArticulationSpec& articulation, int first, std::vector<int>* order);
  Status add_joint(const ArticulationSpec& articulation, size_t index, size_t at,
                   std::vector<int>* order);
  Status limit_followers(const ArticulationSpec& articulation, const Articulation& made);
  Status add_links(const ArticulationSpec& articulation, Articulation* made);
  Status add_bodies();
  Status add_fixtures();
  std::vector<LinkPair> hitting_links();
  bool may_hit(size_t i, size_t k);

  const WorldSpec& spec_;
  BuiltWorld made_{std::make_unique<Stepper>(), {}, {}, {}};
  Stepper& stepper_;
};

Status Builder::add_articulation(const ArticulationSpec& articulation) {
  if (articulation.model == nullptr) return fail("joints and links are given without a robot");
  if (!is_finite(articulation.base)) {
    return fail(called(spec_, articulation) + "'s base pose is not finite");
  }
  if (articulation.positions.size() != articulation.joints.size())
    return fail("initial joints and drives differ in number");
  Articulation made;
  if (articulation.by_efforts && !articulation.driven) {
    return fail(called(spec_, articulation) + " is said to have a controller and to have none");
  }
  made.driven = articulation.driven;
  made.by_efforts = articulation.by_efforts;
  made.range = {stepper_.drives.count, static_cast<int>(articulation.joints.size())};
  std::vector<int> order;
  PROBE_TRY(add_joints(articulation, made.range.first, &order));
  PROBE_ASSIGN(made.tree,
               JointTree::create(*articulation.model, articulation.base, order, made.range.first));
  PROBE_TRY(limit_followers(articulation, made));
  made.tree->update(stepper_.joints.q);
  PROBE_TRY(add_links(articulation, &made));
  const bool in_air = spec_.air.density > 0 || spec_.air.viscosity > 0;
  if (in_air && made.by_efforts) made.air = air_bodies(*articulation.model, *made.tree);
  stepper_.articulations.push_back(std::move(made));
  return {};
}

Status Builder::add_joints(const ArticulationSpec& articulation, int first,
                           std::vector<int>* order) {
  const size_t count = static_cast<size_t>(first) + articulation.joints.size();
  if (count > kMaxJoints) {
    return fail((first == 0 ? "a robot" : "a world") + std::string(" may have at most ") +
                std::to_string(kMaxJoints) + " driven joints");
  }
  for (size_t i = 0; i < articulation.joints.size(); ++i) {
    PROBE_TRY(add_joint(articulation, i, static_cast<size_t>(first) + i, order));
  }
  stepper_.drives.count = static_cast<int>(count);
  return {};
}

Status Builder::add_joint(const ArticulationSpec& articulation, size_t index, size_t at,
                          std::vector<int>* order) {
  const JointSpec& wanted = articulation.joints[index];
  const std::string name = "joint `" + wanted.joint + "`";
  const int joint = articulation.model->find_joint(wanted.joint);
  if (joint < 0) return fail("no " + name + " in " + called(spec_, articulation));
  if (std::find(order->begin(), order->end(), joint) != order->end()) {
    return fail(name + " has two drives");
  }
  const robot::Joint& described = articulation.model->joints[static_cast<size_t>(joint)];
  if (described.kind == robot::JointKind::kFixed) return fail(name + " is fixed but has a drive");
  if (!(wanted.stiffness >= 0) || !(wanted.damping >= 0) || !(wanted.limit > 0) ||
      !std::isfinite(wanted.stiffness) || !std::isfinite(wanted.damping)) {
    return fail("the drive of " + name + " has a negative or non-finite number");
  }
  if (!(wanted.friction >= 0) || !(wanted.armature >= 0) || !(wanted.friction_fade >= 0) ||
      !(wanted.friction_give >= 0) ||
      !std::isfinite(wanted.friction + wanted.armature + wanted.friction_fade +
                     wanted.friction_give)) {
    return fail("the friction or armature of " + name + " is negative or not finite");
  }
  const double position = articulation.positions[index];
  if (!std::isfinite(position)) return fail("the initial position of " + name + " is not finite");
  order->push_back(joint);
  Drives& drives = stepper_.drives;
  drives.stiffness[at] = wanted.stiffness;
  drives.damping[at] = wanted.damping;
  drives.limit[at] = wanted.limit;
  drives.friction[at] = wanted.friction;
  drives.armature[at] = wanted.armature;
  drives.friction_fade[at] = wanted.friction_fade;
  drives.friction_give[at] = wanted.friction_give;
  const bool endless = described.kind == robot::JointKind::kContinuous;
  drives.lower[at] = endless ? -kEndless : described.lower;
  drives.upper[at] = endless ? kEndless : described.upper;
  drives.prismatic[at] = described.kind == robot::JointKind::kPrismatic;
  if (position < drives.lower[at] - kBeyondLimit || position > drives.upper[at] + kBeyondLimit) {
    return fail(name + " starts at " + std::to_string(position) + ", beyond its limits of " +
                std::to_string(drives.lower[at]) + " and " + std::to_string(drives.upper[at]));
  }
  const double rest = wanted.rest.value_or(position);
  if (!std::isfinite(rest)) return fail("the place where " + name + " rests is not finite");
  stepper_.joints.q[at] = position;
  stepper_.joints.target[at] = rest;
  if (articulation.driven) made_.targets.push_back(at);
  return {};
}

// The limits of a joint that follows bind the one it follows.
Status Builder::limit_followers(const ArticulationSpec& articulation, const Articulation& made) {
  Drives& drives = stepper_.drives;
  for (const JointTree::Follower& follower : made.tree->followers()) {
    const robot::Joint& joint = articulation.model->joints[static_cast<size_t>(follower.joint)];
    if (joint.kind == robot::JointKind::kContinuous || follower.scale == 0) continue;
    const double at_lower = (joint.lower - follower.offset) / follower.scale;
    const double at_upper = (joint.upper - follower.offset) / follower.scale;
    const size_t leader = static_cast<size_t>(follower.leader);
    const size_t i = static_cast<size_t>(made.range.first) + leader;
    drives.lower[i] = std::max(drives.lower[i], std::min(at_lower, at_upper));
    drives.upper[i] = std::min(drives.upper[i], std::max(at_lower, at_upper));
    if (drives.lower[i] > drives.upper[i]) {
      return fail("joint `" + joint.name + "` mimics `" + articulation.joints[leader].joint +
                  "`, but no position is within the limits of both");
    }
  }
  return {};
}

Status Builder::add_links(const ArticulationSpec& articulation, Articulation* made) {
  made->first_link = stepper_.colliders.size();
  for (const ArticulationSpec::Link& link : articulation.links) {
    const int index = articulation.model->find_link(link.name);
    if (index < 0) return fail("no link `" + link.name + "` in " + called(spec_, articulation));
    if (link.shape == nullptr || link.shape->parts.empty())
      return fail("link `" + link.name + "` has no shape");
    if (!(link.friction >= 0) || !(link.patch >= 0) || !std::isfinite(link.friction + link.patch)) {
      return fail("link `" + link.name + "` has negative or non-finite friction");
    }
    if (!(link.give >= 0) || !std::isfinite(link.give))
      return fail("link `" + link.name + "` gives way by a number that is negative or not finite");
    Collider c = make_collider(link.shape, link.friction, link.patch, link.give);
    const JointTree::Carrier& carrier = made->tree->carrier(index);
    c.articulation = static_cast<int>(stepper_.articulations.size());
    c.moving_link = carrier.moving;
    c.path = made->tree->path(carrier.moving);
    const Pose in_carrier = carrier.offset * Pose{link.shape->center_of_mass, Quat::Identity()};
    c.carrier_axes = in_carrier.rotation.toRotationMatrix();
    c.carrier_offset = in_carrier.position;
    if (carrier.moving < 0) place_still(articulation.base * in_carrier, &c);
    stepper_.colliders.push_back(std::move(c));
    made_.urdf_links.push_back(index);
  }
  made->links = stepper_.colliders.size() - made->first_link;
  stepper_.links = stepper_.colliders.size();
  return {};
}

// Links of different articulations hit each other unless both stand still. Of one articulation they
// do where it is asked for, but for those that cannot move against each other, neighbours in the
// tree, whose hulls usually overlap at the joint, and pairs that overlap in the initial position.
bool Builder::may_hit(size_t i, size_t k) {
  const Collider &a = stepper_.colliders[i], &b = stepper_.colliders[k];
  if (a.articulation != b.articulation) return a.path != 0 || b.path != 0;
  const size_t of = static_cast<size_t>(a.articulation);
  if (!spec_.articulations[of].self_collision) return false;
  const JointTree& tree = *stepper_.articulations[of].tree;
  const auto parent = [&](const Collider& c) {
    return c.moving_link < 0 ? -2 : tree.parent(c.moving_link);
  };
  ExcludedLinks out{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(k), {}};
  if (a.moving_link == b.moving_link) {
    out.reason = ExcludedLinks::Reason::kRigid;
  } else if (parent(a) == b.moving_link || parent(b) == a.moving_link) {
    out.reason = ExcludedLinks::Reason::kNeighbours;
  } else if (is_touching(a, b, &stepper_.scratch)) {
    out.reason = ExcludedLinks::Reason::kTouchingAtStart;
  } else {
    return true;
  }
  made_.excluded.push_back(out);
  return false;
}

std::vector<LinkPair> Builder::hitting_links() {
  std::vector<LinkPair> pairs;
  for (const Articulation& a : stepper_.articulations) {
    place_links(a, JointArray{}, &stepper_.colliders);
  }
  for (size_t i = 0; i < stepper_.links; ++i) {
    for (size_t k = i + 1; k < stepper_.links; ++k) {
      if (may_hit(i, k)) pairs.push_back({static_cast<int>(i), static_cast<int>(k)});
    }
  }
  return pairs;
}

Status Builder::add_bodies() {
  for (const BodySpec& body : spec_.bodies) {
    const std::string name = "body `" + body.name + "`";
    if (body.shape == nullptr || !is_solid(*body.shape)) {
      return fail(name + " has a shape whose volume or inertia no body can have");
    }
    if (!(body.density > 0) || !std::isfinite(body.density))
      return fail(name + " has a density that is not positive");
    if (!(body.friction >= 0) || !std::isfinite(body.friction))
      return fail(name + " has negative or non-finite friction");
    for (const double damping : {body.damping, body.turn_damping}) {
      if (!(damping >= 0) || !std::isfinite(damping))
        return fail(name + " has negative or non-finite damping");
    }
    Body b;
    b.mass = body.density * body.shape->volume;
    b.inertia = body.density * body.shape->unit_inertia;
    b.inertia_inverse = b.inertia.inverse();
    b.model_to_center = body.shape->center_of_mass;
    b.drag = spec_.dt * body.damping;
    b.turn_drag = spec_.dt * body.turn_damping;
    if (!(b.mass > 1e-9) || !b.inertia_inverse.allFinite())
      return fail(name + " has next to no mass");
    Collider c = make_collider(body.shape, body.friction, 0);
    c.body = static_cast<int>(stepper_.bodies.size());
    stepper_.bodies.push_back(b);
    stepper_.colliders.push_back(std::move(c));
  }
  return {};
}

Status Builder::add_fixtures() {
  for (const FixtureSpec& fixture : spec_.fixtures) {
    const std::string name = "fixture `" + fixture.name + "`";
    if (fixture.shape == nullptr || fixture.shape->parts.empty())
      return fail(name + " has no shape");
    if (!is_finite(fixture.pose) || !(fixture.pose.rotation.norm() > 0.5))
      return fail(name + " stands at a pose that is not finite or not a rotation");
    if (!(fixture.friction >= 0) || !std::isfinite(fixture.friction))
      return fail(name + " has negative or non-finite friction");
    Collider c = make_collider(fixture.shape, fixture.friction, 0);
    const Pose at{fixture.pose.position, fixture.pose.rotation.normalized()};
    place_still(at * Pose{fixture.shape->center_of_mass, Quat::Identity()}, &c);
    stepper_.colliders.push_back(std::move(c));
  }
  return {};
}

Result<BuiltWorld> Builder::build() {
  PROBE_TRY(check_numbers(spec_));
  stepper_.parameters.dt = spec_.dt;
  stepper_.ambient = {spec_.gravity, spec_.linear_damping, spec_.angular_damping, false};
  stepper_.plane = {spec_.surface_z, spec_.surface_friction};
  stepper_.air = spec_.air;
  stepper_.sleeping = spec_.sleeping;
  for (const ArticulationSpec& articulation : spec_.articulations) {
    PROBE_TRY(add_articulation(articulation));
  }
  PROBE_TRY(add_bodies());
  PROBE_TRY(add_fixtures());
  make_pairs(stepper_.colliders, stepper_.links, stepper_.bodies.size(), hitting_links(),
             stepper_.plane, &stepper_.table);
  return std::move(made_);
}

}  // namespace

Result<BuiltWorld> build_world(const WorldSpec& spec) { return Builder(spec).build(); }

}  // namespace probe::world
