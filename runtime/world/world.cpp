#include "runtime/world/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/world/snapshot.h"
#include "runtime/world/stepper.h"

namespace probe::world {
namespace {

using std::size_t;

constexpr double kTooFast = 50.0;      // m/s
constexpr double kTooDeep = 1.0;       // m below the surface
constexpr double kTooFar = 100.0;      // m from the world's origin
constexpr double kBeyondLimit = 1e-3;  // m or rad that a joint may start past a limit, by rounding

Failure fail(std::string message) { return {Fault::kWorld, std::move(message), ""}; }

bool is_solid(const scene::CollisionShape& shape) {
  if (shape.parts.empty() || !(shape.volume > 0) || !std::isfinite(shape.volume)) return false;
  if (!shape.center_of_mass.allFinite() || !shape.unit_inertia.allFinite()) return false;
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(shape.unit_inertia).eigenvalues();
  return moments[0] > 0 && moments[0] + moments[1] >= moments[2] * (1 - 1e-9);
}

Box whole_box(const scene::CollisionShape& shape) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const scene::ConvexPart& part : shape.parts) {
    low = low.cwiseMin(part.center - part.half);
    high = high.cwiseMax(part.center + part.half);
  }
  return {0.5 * (low + high), 0.5 * (high - low)};
}

Collider make_collider(std::shared_ptr<const scene::CollisionShape> shape, double friction,
                       double patch) {
  Collider c;
  c.local = whole_box(*shape);
  c.part_boxes.resize(shape->parts.size());
  for (const scene::ConvexPart& part : shape->parts) c.rounded = c.rounded || part.round > 0;
  c.shape = std::move(shape);
  c.friction = friction;
  c.patch = patch;
  return c;
}

Status check_numbers(const WorldSpec& spec) {
  if (!(spec.dt > 0) || !(spec.dt <= 0.02))
    return fail("the substep must be above 0 and at most 0.02 s");
  if (!spec.gravity.allFinite() || !std::isfinite(spec.surface_z))
    return fail("gravity or surface is not finite");
  if (!(spec.surface_friction >= 0) || !std::isfinite(spec.surface_friction)) {
    return fail("the surface's friction is negative or not finite");
  }
  if (!(spec.linear_damping >= 0) || !(spec.angular_damping >= 0))
    return fail("damping is negative or not a number");
  return {};
}

class ContactWorld final : public World {
 public:
  explicit ContactWorld(WorldSpec spec) : spec_(std::move(spec)) {}

  Status build();

  const WorldSpec& spec() const override { return spec_; }
  std::span<const double> joints() const override {
    return {stepper_.joints.q.data(), joint_count()};
  }
  std::span<const double> joint_speeds() const override {
    return {stepper_.joints.u.data(), joint_count()};
  }
  double drive_load() const override { return stepper_.drive_load; }
  void set_targets(std::span<const double> targets) override {
    PROBE_CHECK(targets.size() == joint_count(), "one target per driven joint");
    std::copy(targets.begin(), targets.end(), stepper_.joints.target.begin());
  }
  BodyState body(size_t index) const override;
  Pose link_pose(size_t link) const override;
  Pose frame_pose(std::string_view link_name) const override;
  void set_body(size_t index, const Pose& model_pose) override;
  void set_joints(std::span<const double> q) override;
  void lock_tilt(bool locked) override;
  void stop_bodies() override;
  Status step(int substeps) override;
  std::span<const ContactImpulse> contacts() const override { return contacts_; }
  std::span<const ContactImpulse> contact_sums() const override { return sums_; }
  std::span<const ExcludedLinks> excluded_links() const override { return excluded_; }
  std::vector<std::byte> save() const override { return save_state(stepper_); }
  Status restore(std::span<const std::byte> state) override;
  Sha256 state_hash() const override { return hash_state(stepper_); }

 private:
  size_t joint_count() const { return static_cast<size_t>(stepper_.drives.count); }
  Status add_arm();
  Status add_joints(std::vector<int>* order);
  Status limit_followers();
  Status add_links();
  Status add_bodies();
  Status add_fixtures();
  std::vector<LinkPair> hitting_links();
  Status check_state() const;
  void wake_all();
  void publish_contacts();
  void publish_sums();
  Party party(int collider) const;
  // Link poses are of the present q: what the stepper left may be one substep old.
  void refresh() const;

  WorldSpec spec_;
  mutable Stepper stepper_;
  std::vector<int> urdf_links_;  // of ArmSpec::links
  std::vector<ContactImpulse> contacts_, sums_;
  std::vector<ExcludedLinks> excluded_;
};

Status ContactWorld::add_arm() {
  const ArmSpec& arm = spec_.arm;
  if (arm.model == nullptr) {
    if (!arm.drives.empty() || !arm.links.empty())
      return fail("drives or links are given without a robot");
    return {};
  }
  if (!is_finite(arm.base)) return fail("the robot's base pose is not finite");
  if (arm.joints.size() != arm.drives.size())
    return fail("initial joints and drives differ in number");
  std::vector<int> order;
  PROBE_TRY(add_joints(&order));
  PROBE_ASSIGN(stepper_.arm, ArmDynamics::create(*arm.model, arm.base, order));
  PROBE_TRY(limit_followers());
  PROBE_TRY(stepper_.arm->update(stepper_.joints.q));
  return add_links();
}

Status ContactWorld::add_joints(std::vector<int>* order) {
  const ArmSpec& arm = spec_.arm;
  if (arm.drives.size() > kMaxJoints) {
    return fail("a robot may have at most " + std::to_string(kMaxJoints) + " driven joints");
  }
  Drives& drives = stepper_.drives;
  for (size_t i = 0; i < arm.drives.size(); ++i) {
    const Drive& drive = arm.drives[i];
    const int joint = arm.model->find_joint(drive.joint);
    if (joint < 0) return fail("no joint `" + drive.joint + "` in the robot");
    if (std::find(order->begin(), order->end(), joint) != order->end()) {
      return fail("joint `" + drive.joint + "` has two drives");
    }
    const robot::Joint& described = arm.model->joints[static_cast<size_t>(joint)];
    if (described.kind == robot::JointKind::kFixed)
      return fail("joint `" + drive.joint + "` is fixed but has a drive");
    if (!(drive.stiffness >= 0) || !(drive.damping >= 0) || !(drive.limit > 0) ||
        !std::isfinite(drive.stiffness) || !std::isfinite(drive.damping)) {
      return fail("the drive of joint `" + drive.joint + "` has a negative or non-finite number");
    }
    if (!std::isfinite(arm.joints[i]))
      return fail("the initial position of joint `" + drive.joint + "` is not finite");
    order->push_back(joint);
    drives.stiffness[i] = drive.stiffness;
    drives.damping[i] = drive.damping;
    drives.limit[i] = drive.limit;
    const bool endless = described.kind == robot::JointKind::kContinuous;
    drives.lower[i] = endless ? -std::numeric_limits<double>::infinity() : described.lower;
    drives.upper[i] = endless ? std::numeric_limits<double>::infinity() : described.upper;
    drives.prismatic[i] = described.kind == robot::JointKind::kPrismatic;
    if (arm.joints[i] < drives.lower[i] - kBeyondLimit ||
        arm.joints[i] > drives.upper[i] + kBeyondLimit) {
      return fail("joint `" + drive.joint + "` starts at " + std::to_string(arm.joints[i]) +
                  ", beyond its limits of " + std::to_string(drives.lower[i]) + " and " +
                  std::to_string(drives.upper[i]));
    }
    stepper_.joints.q[i] = stepper_.joints.target[i] = arm.joints[i];
  }
  drives.count = static_cast<int>(arm.drives.size());
  return {};
}

// The limits of a joint that follows bind the one it follows.
Status ContactWorld::limit_followers() {
  Drives& drives = stepper_.drives;
  for (const ArmDynamics::Follower& follower : stepper_.arm->followers()) {
    const robot::Joint& joint = spec_.arm.model->joints[static_cast<size_t>(follower.joint)];
    if (joint.kind == robot::JointKind::kContinuous || follower.scale == 0) continue;
    const double at_lower = (joint.lower - follower.offset) / follower.scale;
    const double at_upper = (joint.upper - follower.offset) / follower.scale;
    const size_t i = static_cast<size_t>(follower.leader);
    drives.lower[i] = std::max(drives.lower[i], std::min(at_lower, at_upper));
    drives.upper[i] = std::min(drives.upper[i], std::max(at_lower, at_upper));
    if (drives.lower[i] > drives.upper[i]) {
      return fail("joint `" + joint.name + "` mimics `" + spec_.arm.drives[i].joint +
                  "`, but no position is within the limits of both");
    }
  }
  return {};
}

Status ContactWorld::add_links() {
  const ArmSpec& arm = spec_.arm;
  for (const ArmSpec::Link& link : arm.links) {
    const int index = arm.model->find_link(link.name);
    if (index < 0) return fail("no link `" + link.name + "` in the robot");
    if (link.shape == nullptr || link.shape->parts.empty())
      return fail("link `" + link.name + "` has no shape");
    if (!(link.friction >= 0) || !(link.patch >= 0) || !std::isfinite(link.friction + link.patch)) {
      return fail("link `" + link.name + "` has negative or non-finite friction");
    }
    Collider c = make_collider(link.shape, link.friction, link.patch);
    const ArmDynamics::Carrier& carrier = stepper_.arm->carrier(index);
    c.moving_link = carrier.moving;
    c.path = stepper_.arm->path(carrier.moving);
    const Pose in_carrier = carrier.offset * Pose{link.shape->center_of_mass, Quat::Identity()};
    c.carrier_axes = in_carrier.rotation.toRotationMatrix();
    c.carrier_offset = in_carrier.position;
    if (carrier.moving < 0) place_still(arm.base * in_carrier, &c);
    stepper_.colliders.push_back(std::move(c));
    urdf_links_.push_back(index);
  }
  stepper_.links = stepper_.colliders.size();
  return {};
}

// All pairs of links but those that cannot move against each other, neighbours in the tree, whose
// hulls usually overlap at the joint, and pairs that overlap in the initial position.
std::vector<LinkPair> ContactWorld::hitting_links() {
  std::vector<LinkPair> pairs;
  if (!spec_.arm.self_collision || !stepper_.arm) return pairs;
  place_links(*stepper_.arm, JointArray{}, stepper_.links, &stepper_.colliders);
  const auto parent = [&](const Collider& c) {
    return c.moving_link < 0 ? -2 : stepper_.arm->parent(c.moving_link);
  };
  for (size_t i = 0; i < stepper_.links; ++i) {
    for (size_t k = i + 1; k < stepper_.links; ++k) {
      const Collider& a = stepper_.colliders[i];
      const Collider& b = stepper_.colliders[k];
      ExcludedLinks out{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(k), {}};
      if (a.moving_link == b.moving_link) {
        out.reason = ExcludedLinks::Reason::kRigid;
      } else if (parent(a) == b.moving_link || parent(b) == a.moving_link) {
        out.reason = ExcludedLinks::Reason::kNeighbours;
      } else if (is_touching(a, b, &stepper_.table.scratch)) {
        out.reason = ExcludedLinks::Reason::kTouchingAtStart;
      } else {
        pairs.push_back({static_cast<int>(i), static_cast<int>(k)});
        continue;
      }
      excluded_.push_back(out);
    }
  }
  return pairs;
}

Status ContactWorld::add_bodies() {
  for (const BodySpec& body : spec_.bodies) {
    const std::string name = "body `" + body.name + "`";
    if (body.shape == nullptr || !is_solid(*body.shape)) {
      return fail(name + " has a shape whose volume or inertia no body can have");
    }
    if (!(body.density > 0) || !std::isfinite(body.density))
      return fail(name + " has a density that is not positive");
    if (!(body.friction >= 0) || !std::isfinite(body.friction))
      return fail(name + " has negative or non-finite friction");
    Body b;
    b.mass = body.density * body.shape->volume;
    b.inertia = body.density * body.shape->unit_inertia;
    b.inertia_inverse = b.inertia.inverse();
    b.model_to_center = body.shape->center_of_mass;
    if (!(b.mass > 1e-9) || !b.inertia_inverse.allFinite())
      return fail(name + " has next to no mass");
    Collider c = make_collider(body.shape, body.friction, 0);
    c.body = static_cast<int>(stepper_.bodies.size());
    stepper_.bodies.push_back(b);
    stepper_.colliders.push_back(std::move(c));
  }
  return {};
}

Status ContactWorld::add_fixtures() {
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

Status ContactWorld::build() {
  PROBE_TRY(check_numbers(spec_));
  stepper_.parameters.dt = spec_.dt;
  stepper_.ambient = {spec_.gravity, spec_.linear_damping, spec_.angular_damping, false};
  stepper_.plane = {spec_.surface_z, spec_.surface_friction};
  stepper_.sleeping = spec_.sleeping;
  PROBE_TRY(add_arm());
  PROBE_TRY(add_bodies());
  PROBE_TRY(add_fixtures());
  make_pairs(stepper_.colliders, stepper_.links, stepper_.bodies.size(), hitting_links(),
             stepper_.plane, &stepper_.table);
  for (size_t b = 0; b < spec_.bodies.size(); ++b) {
    if (!is_finite(spec_.bodies[b].pose) || !(spec_.bodies[b].pose.rotation.norm() > 0.5)) {
      return fail("body `" + spec_.bodies[b].name +
                  "` starts at a pose that is not finite or not a rotation");
    }
    set_body(b, spec_.bodies[b].pose);
  }
  return {};
}

BodyState ContactWorld::body(size_t index) const {
  PROBE_CHECK(index < stepper_.bodies.size(), "a body of the spec");
  const Body& b = stepper_.bodies[index];
  BodyState state;
  state.center = b.position;
  state.pose = {b.position - b.rotation * b.model_to_center, b.rotation};
  state.velocity = b.velocity;
  state.spin = b.spin;
  return state;
}

void ContactWorld::refresh() const {
  // A failure here (a q that is not finite) is reported by the next step.
  if (stepper_.arm) (void)stepper_.arm->update(stepper_.joints.q);
}

Pose ContactWorld::link_pose(size_t link) const {
  PROBE_CHECK(link < urdf_links_.size(), "a link of the spec");
  refresh();
  return stepper_.arm->pose(stepper_.arm->carrier(urdf_links_[link]));
}

Pose ContactWorld::frame_pose(std::string_view link_name) const {
  PROBE_CHECK(spec_.arm.model != nullptr, "a world with a robot");
  const int link = spec_.arm.model->find_link(link_name);
  PROBE_CHECK(link >= 0, "a link of the robot");
  refresh();
  return stepper_.arm->pose(stepper_.arm->carrier(link));
}

void ContactWorld::set_body(size_t index, const Pose& model_pose) {
  PROBE_CHECK(index < stepper_.bodies.size(), "a body of the spec");
  // Whatever slept on it or beside it must find out.
  wake_all();
  Body& b = stepper_.bodies[index];
  b.rotation = model_pose.rotation.normalized();
  b.axes = b.rotation.toRotationMatrix();
  b.position = model_pose.position + b.rotation * b.model_to_center;
  b.velocity = b.spin = Vec3::Zero();
  const int collider = static_cast<int>(stepper_.links + index);
  place_body(b, &stepper_.colliders[static_cast<size_t>(collider)]);
  drop_records(collider, &stepper_.table);
}

void ContactWorld::set_joints(std::span<const double> q) {
  PROBE_CHECK(q.size() == joint_count(), "one position per driven joint");
  std::copy(q.begin(), q.end(), stepper_.joints.q.begin());
  stepper_.joints.target = stepper_.joints.q;
  stepper_.joints.u = JointArray{};
  stepper_.joints.limit_impulse = {};
  stepper_.joints.saturated = {};
  for (size_t l = 0; l < stepper_.links; ++l) drop_records(static_cast<int>(l), &stepper_.table);
}

void ContactWorld::wake_all() {
  Sleepers rest = stepper_.sleepers();
  for (size_t b = 0; b < stepper_.bodies.size(); ++b) wake(b, stepper_.substep, &rest);
}

void ContactWorld::lock_tilt(bool locked) {
  if (stepper_.ambient.tilt_locked == locked) return;
  stepper_.ambient.tilt_locked = locked;
  wake_all();
}

void ContactWorld::stop_bodies() {
  for (Body& body : stepper_.bodies) body.velocity = body.spin = Vec3::Zero();
}

Status ContactWorld::check_state() const {
  for (size_t i = 0; i < joint_count(); ++i) {
    const Joints& j = stepper_.joints;
    if (!std::isfinite(j.target[i]))
      return fail("the target of joint `" + spec_.arm.drives[i].joint + "` is not finite");
    if (!std::isfinite(j.q[i]) || !std::isfinite(j.u[i])) {
      return fail("joint `" + spec_.arm.drives[i].joint +
                  "` has a position or speed that is not finite");
    }
  }
  for (size_t b = 0; b < stepper_.bodies.size(); ++b) {
    const Body& body = stepper_.bodies[b];
    const std::string_view name = spec_.bodies[b].name;
    // Written so that a number that is not finite fails too.
    if (!(body.velocity.squaredNorm() + body.spin.squaredNorm() + body.position.squaredNorm() <
          std::numeric_limits<double>::infinity()) ||
        !body.rotation.coeffs().allFinite()) {
      return fail("body `" + std::string(name) + "` has a pose or velocity that is not finite");
    }
    if (body.velocity.squaredNorm() > kTooFast * kTooFast) {
      return fail("body `" + std::string(name) + "` is faster than 50 m/s");
    }
    if (body.position.z() < spec_.surface_z - kTooDeep) {
      return fail("body `" + std::string(name) + "` is more than 1 m below the surface");
    }
    if (body.position.squaredNorm() > kTooFar * kTooFar) {
      return fail("body `" + std::string(name) + "` is farther than 100 m away");
    }
  }
  return {};
}

Status ContactWorld::step(int substeps) {
  PROBE_TRY(check_state());
  begin_sums(stepper_.substep, &stepper_.table);
  stepper_.drive_load = 0;
  for (int i = 0; i < substeps; ++i) {
    PROBE_TRY(stepper_.advance());
    PROBE_TRY(check_state());
  }
  if (substeps <= 0) return {};
  publish_contacts();
  publish_sums();
  return {};
}

Party ContactWorld::party(int collider) const {
  if (collider < 0) return {PartyKind::kSurface, 0};
  size_t c = static_cast<size_t>(collider);
  if (c < stepper_.links) return {PartyKind::kLink, static_cast<std::uint16_t>(c)};
  c -= stepper_.links;
  if (c < stepper_.bodies.size()) return {PartyKind::kBody, static_cast<std::uint16_t>(c)};
  return {PartyKind::kFixture, static_cast<std::uint16_t>(c - stepper_.bodies.size())};
}

void ContactWorld::publish_contacts() {
  contacts_.clear();
  for (const ColliderPair& pair : stepper_.table.pairs) {
    Vec3 sum = Vec3::Zero();
    for (std::uint32_t r = pair.first; r < pair.first + pair.count; ++r) {
      const PairRecord& record = stepper_.table.records[r];
      if (record.valid && (record.frozen || record.last + 1 == stepper_.substep))
        sum += record.impulse;
    }
    if (sum != Vec3::Zero()) contacts_.push_back({party(pair.a), party(pair.b), sum});
  }
}

void ContactWorld::publish_sums() {
  sums_.clear();
  for (ColliderPair& pair : stepper_.table.pairs) {
    for (std::uint32_t r = pair.first; r < pair.first + pair.count; ++r) {
      const PairRecord& record = stepper_.table.records[r];
      if (record.frozen) add_frozen(record, stepper_.substep, &pair, stepper_.table);
    }
    if (pair.sum != Vec3::Zero()) sums_.push_back({party(pair.a), party(pair.b), pair.sum});
  }
}

Status ContactWorld::restore(std::span<const std::byte> state) {
  PROBE_TRY(restore_state(state, &stepper_));
  publish_contacts();
  sums_.clear();
  return {};
}

}  // namespace

Result<std::unique_ptr<World>> World::create(WorldSpec spec) {
  auto world = std::make_unique<ContactWorld>(std::move(spec));
  PROBE_TRY(world->build());
  return std::unique_ptr<World>(std::move(world));
}

}  // namespace probe::world
