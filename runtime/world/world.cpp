// What is told of a world and to it, in the terms of its spec; the substep itself is stepper.cpp's.
#include "runtime/world/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/world/colliders.h"
#include "runtime/world/dynamics.h"
#include "runtime/world/snapshot.h"
#include "runtime/world/world_build.h"

namespace probe::world {
namespace {

using std::size_t;

// Where an episode is lost: nothing on a table is meant to get there.
constexpr double kTooFast = 50.0;  // m/s
constexpr double kTooDeep = 1.0;   // m below the surface
constexpr double kTooFar = 100.0;  // m from the world's origin

std::string in(double limit, const char* unit) { return fmt::format("{:g} {}", limit, unit); }

Failure lost(std::string message) { return {Fault::kWorld, std::move(message), ""}; }

}  // namespace

World::World(WorldSpec spec) : spec_(std::move(spec)) {}
World::~World() = default;

Result<std::unique_ptr<World>> World::create(WorldSpec spec) {
  std::unique_ptr<World> world(new World(std::move(spec)));
  PROBE_ASSIGN(BuiltWorld built, build_world(world->spec_));
  world->stepper_ = std::move(built.stepper);
  world->targets_ = std::move(built.targets);
  world->urdf_links_ = std::move(built.urdf_links);
  world->excluded_ = std::move(built.excluded);
  for (size_t b = 0; b < world->spec_.bodies.size(); ++b) {
    const BodySpec& body = world->spec_.bodies[b];
    if (!is_finite(body.pose) || !(body.pose.rotation.norm() > 0.5)) {
      return lost("body `" + body.name + "` starts at a pose that is not finite or not a rotation");
    }
    world->set_body(b, body.pose);
  }
  return world;
}

std::span<const double> World::joints() const {
  return {stepper_->joints.q.data(), static_cast<size_t>(stepper_->drives.count)};
}

std::span<const double> World::joint_speeds() const {
  return {stepper_->joints.u.data(), static_cast<size_t>(stepper_->drives.count)};
}

double World::drive_load() const { return stepper_->drive_load; }

void World::set_targets(std::span<const double> targets, std::span<const double> speeds) {
  PROBE_CHECK(targets.size() == targets_.size(), "one target per driven joint");
  PROBE_CHECK(speeds.empty() || speeds.size() == targets_.size(), "one speed per driven joint");
  const Drives& drives = stepper_->drives;
  for (size_t i = 0; i < targets.size(); ++i) {
    const size_t at = targets_[i];
    double target = targets[i];
    // k (q* - q) + d (v* - u) is the drive k (q' - q) - d u with q' = q* + d v* / k, its limit
    // included.
    if (!speeds.empty() && speeds[i] != 0)
      target += drives.damping[at] / drives.stiffness[at] * speeds[i];
    stepper_->joints.target[at] = target;
  }
}

Result<World::ToolRef> World::find_tool(std::string_view link, size_t joints,
                                        size_t articulation) const {
  PROBE_CHECK(articulation < spec_.articulations.size(), "an articulation of the spec");
  const ArticulationSpec& of = spec_.articulations[articulation];
  const int index = of.model->find_link(link);
  if (index < 0) return lost("no link `" + std::string(link) + "` in `" + of.model->name + "`");
  if (joints > of.joints.size() || joints > size_t{robot::kMaxChainJoints}) {
    return lost(
        fmt::format("{} joints are said to move `{}`, there are {} and at most {} are handled",
                    joints, link, of.joints.size(), robot::kMaxChainJoints));
  }
  const JointTree& tree = *stepper_->articulations[articulation].tree;
  for (int k = tree.carrier(index).moving; k >= 0; k = tree.parent(k)) {
    const auto moved_by = static_cast<size_t>(tree.link(k).coordinate - tree.first());
    if (moved_by >= joints) {
      return lost("joint `" + of.joints[moved_by].joint + "` moves `" + std::string(link) +
                  "`, but is none of the arm's");
    }
  }
  return ToolRef{articulation, index, joints};
}

void World::read_dynamics(const ToolRef& tool, robot::Dynamics* out) const {
  const Articulation& of = stepper_->articulations[tool.articulation];
  of.tree->update(stepper_->joints.q);
  world::read_dynamics({*of.tree, of.tree->carrier(tool.link), tool.joints}, stepper_->drives,
                       stepper_->joints, stepper_->ambient.gravity, out);
}

void World::read_dynamics_at(const ToolRef& tool, std::span<const double> q,
                             robot::Dynamics* out) const {
  PROBE_CHECK(q.size() == tool.joints, "a position for each joint of the tool");
  const Articulation& of = stepper_->articulations[tool.articulation];
  Joints there = stepper_->joints;
  there.u = JointArray{};
  std::copy(q.begin(), q.end(), there.q.begin() + of.range.first);
  of.tree->update(there.q);
  world::read_dynamics({*of.tree, of.tree->carrier(tool.link), tool.joints}, stepper_->drives,
                       there, stepper_->ambient.gravity, out);
  of.tree->update(stepper_->joints.q);
}

void World::set_efforts(size_t articulation, std::span<const double> efforts) {
  PROBE_CHECK(
      articulation < spec_.articulations.size() && spec_.articulations[articulation].by_efforts,
      "an articulation by efforts");
  const JointRange range = stepper_->articulations[articulation].range;
  PROBE_CHECK(efforts.size() == static_cast<size_t>(range.count), "one effort a joint");
  std::copy(efforts.begin(), efforts.end(), stepper_->joints.effort.begin() + range.first);
}

BodyState World::body(size_t index) const {
  PROBE_CHECK(index < stepper_->bodies.size(), "a body of the spec");
  const Body& b = stepper_->bodies[index];
  BodyState state;
  state.center = b.position;
  state.pose = {b.position - b.rotation * b.model_to_center, b.rotation};
  state.velocity = b.velocity;
  state.spin = b.spin;
  return state;
}

Pose World::link_pose(size_t link) const {
  PROBE_CHECK(link < urdf_links_.size(), "a link of the spec");
  const auto of = static_cast<size_t>(stepper_->colliders[link].articulation);
  JointTree& tree = *stepper_->articulations[of].tree;
  tree.update(stepper_->joints.q);  // what the stepper left may be one substep old
  return tree.pose(tree.carrier(urdf_links_[link]));
}

Pose World::frame_pose(std::string_view link_name, size_t articulation) const {
  PROBE_CHECK(articulation < spec_.articulations.size(), "an articulation of the spec");
  const int link = spec_.articulations[articulation].model->find_link(link_name);
  PROBE_CHECK(link >= 0, "a link of the articulation");
  JointTree& tree = *stepper_->articulations[articulation].tree;
  tree.update(stepper_->joints.q);
  return tree.pose(tree.carrier(link));
}

void World::set_body(size_t index, const Pose& model_pose) {
  PROBE_CHECK(index < stepper_->bodies.size(), "a body of the spec");
  // Whatever slept on it or beside it must find out.
  wake_all();
  Body& b = stepper_->bodies[index];
  b.rotation = model_pose.rotation.normalized();
  b.axes = b.rotation.toRotationMatrix();
  b.position = model_pose.position + b.rotation * b.model_to_center;
  b.velocity = b.spin = Vec3::Zero();
  b.led = false;
  b.let_go_at.reset();
  const int collider = static_cast<int>(stepper_->links + index);
  place_body(b, &stepper_->colliders[static_cast<size_t>(collider)]);
  drop_records(collider, &stepper_->table);
}

void World::set_joints(std::span<const double> q) {
  PROBE_CHECK(q.size() == joints().size(), "one position a joint");
  Sleepers rest = stepper_->sleepers();
  for (size_t a = 0; a < stepper_->articulations.size(); ++a) {
    wake_articulation(a, stepper_->substep, &rest);
  }
  Joints& joints = stepper_->joints;
  std::copy(q.begin(), q.end(), joints.q.begin());
  joints.target = joints.q;
  joints.u = JointArray{};
  joints.limit_impulse = {};
  joints.friction_impulse = {};
  joints.saturated = {};
  for (size_t l = 0; l < stepper_->links; ++l) drop_records(static_cast<int>(l), &stepper_->table);
}

void World::wake_all() {
  Sleepers rest = stepper_->sleepers();
  for (size_t b = 0; b < stepper_->bodies.size(); ++b) wake_body(b, stepper_->substep, &rest);
  for (size_t a = 0; a < stepper_->articulations.size(); ++a) {
    wake_articulation(a, stepper_->substep, &rest);
  }
}

void World::lock_tilt(bool locked) {
  if (stepper_->ambient.tilt_locked == locked) return;
  stepper_->ambient.tilt_locked = locked;
  wake_all();
}

void World::stop_bodies() {
  for (Body& body : stepper_->bodies) body.velocity = body.spin = Vec3::Zero();
}

std::optional<Overlap> World::robot_stands_in(double least) const {
  // On copies: looking changes no solver state.
  PairTable table = stepper_->table;
  Candidates scratch;
  Problem problem;
  problem.bodies = &stepper_->bodies;
  find_contacts(stepper_->parameters, stepper_->plane, stepper_->substep, stepper_->articulations,
                stepper_->colliders, &table, &scratch, &problem);
  const auto is_robot = [&](int collider) {
    if (collider < 0) return false;
    const Collider& c = stepper_->colliders[static_cast<size_t>(collider)];
    return c.body < 0 && c.path != 0 &&
           stepper_->articulations[static_cast<size_t>(c.articulation)].driven;
  };
  std::optional<Overlap> deepest;
  for (const Contact& contact : problem.contacts) {
    const bool a = is_robot(contact.collider_a), b = is_robot(contact.collider_b);
    if (a == b || -contact.gap <= (deepest ? deepest->depth : least)) continue;
    deepest = {party(a ? contact.collider_a : contact.collider_b),
               party(a ? contact.collider_b : contact.collider_a), -contact.gap};
  }
  return deepest;
}

void World::lead(size_t index, const Vec3& velocity) {
  PROBE_CHECK(index < stepper_->bodies.size(), "a body of the spec");
  Body& body = stepper_->bodies[index];
  if (!body.led) {
    Sleepers rest = stepper_->sleepers();
    wake_body(index, stepper_->substep, &rest);
    // What held it up no longer does.
    drop_records(static_cast<int>(stepper_->links + index), &stepper_->table);
    body.led = true;
    body.let_go_at.reset();
  }
  body.velocity = velocity;
}

void World::let_go(size_t index) {
  PROBE_CHECK(index < stepper_->bodies.size(), "a body of the spec");
  probe::world::let_go(&stepper_->bodies[index]);
}

std::optional<Vec3> World::led_to(size_t index) const {
  PROBE_CHECK(index < stepper_->bodies.size(), "a body of the spec");
  const Body& body = stepper_->bodies[index];
  return body.led ? body.position : body.let_go_at;
}

bool World::is_led(size_t index) const {
  PROBE_CHECK(index < stepper_->bodies.size(), "a body of the spec");
  return stepper_->bodies[index].led;
}

Status World::check_state() const {
  const Joints& j = stepper_->joints;
  for (size_t a = 0; a < spec_.articulations.size(); ++a) {
    const auto first = static_cast<size_t>(stepper_->articulations[a].range.first);
    for (size_t k = 0; k < spec_.articulations[a].joints.size(); ++k) {
      const std::string& name = spec_.articulations[a].joints[k].joint;
      const size_t i = first + k;
      if (!std::isfinite(j.target[i]))
        return lost("the target of joint `" + name + "` is not finite");
      if (!std::isfinite(j.q[i]) || !std::isfinite(j.u[i])) {
        return lost("joint `" + name + "` has a position or speed that is not finite");
      }
    }
  }
  for (size_t b = 0; b < stepper_->bodies.size(); ++b) {
    const Body& body = stepper_->bodies[b];
    const std::string_view name = spec_.bodies[b].name;
    // Written so that a number that is not finite fails too.
    if (!(body.velocity.squaredNorm() + body.spin.squaredNorm() + body.position.squaredNorm() <
          std::numeric_limits<double>::infinity()) ||
        !body.rotation.coeffs().allFinite()) {
      return lost("body `" + std::string(name) + "` has a pose or velocity that is not finite");
    }
    if (body.velocity.squaredNorm() > kTooFast * kTooFast) {
      return lost("body `" + std::string(name) + "` is faster than " + in(kTooFast, "m/s"));
    }
    if (body.position.z() < spec_.surface_z - kTooDeep) {
      return lost("body `" + std::string(name) + "` is more than " + in(kTooDeep, "m") +
                  " below the surface");
    }
    if (body.position.squaredNorm() > kTooFar * kTooFar) {
      return lost("body `" + std::string(name) + "` is farther than " + in(kTooFar, "m") + " away");
    }
  }
  return {};
}

Status World::step(int substeps, const std::function<void()>& control) {
  PROBE_TRY(check_state());
  begin_sums(stepper_->substep, &stepper_->table);
  stepper_->drive_load = 0;
  for (int i = 0; i < substeps; ++i) {
    stepper_->joints.effort = JointArray{};
    if (control) control();
    PROBE_TRY(stepper_->advance());
    PROBE_TRY(check_state());
  }
  if (substeps <= 0) return {};
  publish_contacts();
  publish_sums();
  return {};
}

Party World::party(int collider) const {
  if (collider < 0) return {PartyKind::kSurface, 0};
  size_t c = static_cast<size_t>(collider);
  if (c < stepper_->links) return {PartyKind::kLink, static_cast<std::uint16_t>(c)};
  c -= stepper_->links;
  if (c < stepper_->bodies.size()) return {PartyKind::kBody, static_cast<std::uint16_t>(c)};
  return {PartyKind::kFixture, static_cast<std::uint16_t>(c - stepper_->bodies.size())};
}

void World::publish_contacts() {
  contacts_.clear();
  for (const ColliderPair& pair : stepper_->table.pairs) {
    Vec3 sum = Vec3::Zero();
    for (const ColliderPair::Entry& entry : pair.near) {
      const PairRecord& record = stepper_->table.record(entry.record);
      if (record.valid && (record.frozen || record.last + 1 == stepper_->substep))
        sum += record.impulse;
    }
    if (sum != Vec3::Zero()) contacts_.push_back({party(pair.a), party(pair.b), sum});
  }
}

void World::publish_sums() {
  sums_.clear();
  for (ColliderPair& pair : stepper_->table.pairs) {
    for (const ColliderPair::Entry& entry : pair.near) {
      const PairRecord& record = stepper_->table.record(entry.record);
      if (record.frozen) add_frozen(record, stepper_->substep, stepper_->table, &pair);
    }
    if (pair.sum != Vec3::Zero()) sums_.push_back({party(pair.a), party(pair.b), pair.sum});
  }
}

Status World::restore(std::span<const std::byte> state) {
  PROBE_TRY(restore_state(state, stepper_.get()));
  publish_contacts();
  sums_.clear();
  return {};
}

std::vector<std::byte> World::save() const { return save_state(*stepper_); }

Sha256 World::state_hash() const { return hash_state(*stepper_); }

}  // namespace probe::world
