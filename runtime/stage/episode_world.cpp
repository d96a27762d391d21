// From plan records to a world, and from the world's state to measurements.
#include "runtime/stage/episode_world.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"
#include "runtime/stage/goal.h"
#include "runtime/stage/scene_view.h"

namespace probe::stage {
namespace {

// Contact of a finger, as the reference's metrics count it: N s.
constexpr double kContactImpulse = 1e-6;
// The longer third phase of settling, if something still moves faster than this (m/s, rad/s, summed
// over objects). From the reference's reset.
constexpr double kStillSpeed = 1e-3, kStillSpin = 1e-2, kExtraSettle = 1.5;

bool is_kind(const plan::BodyRecord& body, plan::BodyKind kind) {
  return body.kind == static_cast<std::uint32_t>(kind);
}

// Half extents along the body's own axes, reordered so that z is the one nearest the vertical; x
// and y keep their order.
Vec3 upright_half(const Vec3& half, const Quat& rotation) {
  const Mat3 axes = rotation.toRotationMatrix();
  int up = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(axes(2, axis)) > std::abs(axes(2, up))) up = axis;
  }
  if (up == 0) return {half.y(), half.z(), half.x()};
  if (up == 1) return {half.x(), half.z(), half.y()};
  return half;
}

Result<robot::EeDeltaPoseController> make_controller(const plan::Plan& plan,
                                                     const plan::RobotRecord& robot,
                                                     const robot::RobotModel& model,
                                                     const std::vector<std::string>& joints) {
  const std::string where = "robot `" + std::string(plan.text(robot.name)) + "`";
  robot::EeControlSpec spec;
  spec.tcp_link = std::string(plan.text(robot.tcp));
  spec.grip_closed = robot.grip_closed;
  spec.grip_open = robot.grip_open;
  for (const plan::FingerRecord& finger : robot.fingers) {
    const std::string name(plan.text(finger.link));
    const int link = model.find_link(name);
    if (link < 0) return Failure{Fault::kUrdf, "no link `" + name + "`", model.path};
    const int joint = model.links[static_cast<std::size_t>(link)].parent_joint;
    if (joint < 0)
      return Failure{Fault::kUrdf, "finger `" + name + "` hangs on no joint", model.path};
    spec.finger_joints.push_back(model.joints[static_cast<std::size_t>(joint)].name);
  }
  for (const std::string& joint : joints) {
    if (std::find(spec.finger_joints.begin(), spec.finger_joints.end(), joint) ==
        spec.finger_joints.end()) {
      spec.arm_joints.push_back(joint);
    }
  }
  std::vector<std::string> order = spec.arm_joints;
  order.insert(order.end(), spec.finger_joints.begin(), spec.finger_joints.end());
  if (order != joints) {
    return Failure{Fault::kPlan, "drives stand in another order than arm joints, then the fingers'",
                   where};
  }
  return robot::EeDeltaPoseController::create(model, spec);
}

}  // namespace

Result<std::unique_ptr<EpisodeWorld>> EpisodeWorld::create(
    const plan::Plan& plan, std::uint32_t task_index, std::shared_ptr<const SharedAssets> assets) {
  const plan::TaskRecord& task = plan.tasks()[task_index];
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const plan::RobotRecord& robot = plan.robots()[scene.robot];
  const RobotParts* parts = assets->robot(robot.urdf);
  PROBE_CHECK(parts != nullptr, "assets are loaded for the tasks that run");

  std::vector<std::string> joints = drive_joints(plan, robot);
  PROBE_ASSIGN(robot::Tree tree, robot::Tree::create(parts->model, joints));
  PROBE_ASSIGN(auto controller, make_controller(plan, robot, parts->model, joints));
  auto made = std::unique_ptr<EpisodeWorld>(
      new EpisodeWorld(plan, std::move(assets), std::move(tree), std::move(controller)));
  made->task_ = &task;
  made->scene_ = &scene;
  made->robot_ = &robot;
  made->parts_ = parts;
  made->joints_ = std::move(joints);
  made->tcp_link_ = std::string(plan.text(robot.tcp));
  made->tcp_ = parts->model.find_link(made->tcp_link_);
  made->base_ = base_pose(scene);
  made->substeps_ = static_cast<int>(std::lround(scene.physics_hz / robot.control_hz));
  made->link_poses_.resize(made->tree_.link_count());
  made->jacobian_.resize(6, static_cast<Eigen::Index>(made->tree_.joint_count()));
  PROBE_TRY(made->read_bodies());
  PROBE_ASSIGN(made->privileged_.goal, goal_of(plan, task_index));
  return made;
}

// Finds the places of objects, surface and links among the task's bodies, and what the privileged
// view says once.
Status EpisodeWorld::read_bodies() {
  const auto bodies = plan_.bodies(*task_);
  const std::string where = "task `" + std::string(plan_.text(task_->name)) + "`";
  object_count_ = 2 + task_->distractors;
  privileged_.base = base_;
  privileged_.surface_z = scene_->surface_z;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string name(plan_.text(bodies[i].name));
    if (is_kind(bodies[i], plan::BodyKind::kObject)) {
      const plan::ObjectRecord& object = plan_.objects()[bodies[i].index];
      const auto shape = assets_->shape(object.collision);
      if (!shape)
        return Failure{Fault::kAsset, "object `" + name + "` has no collision mesh", where};
      policy::PrivilegedObject view;
      view.name = name;
      for (const scene::ConvexPart& part : shape->parts) {
        view.parts.emplace_back();
        for (const Vec3& vertex : part.vertices) {
          view.parts.back().push_back(vertex + shape->center_of_mass);
        }
      }
      view.center_of_mass = shape->center_of_mass;
      view.box_min = to_vec(object.box_min);
      view.box_max = to_vec(object.box_max);
      privileged_.objects.push_back(std::move(view));
    }
    if (is_kind(bodies[i], plan::BodyKind::kSurface)) surface_ = static_cast<std::uint16_t>(i);
    if (is_kind(bodies[i], plan::BodyKind::kFixture)) {
      fixture_ = static_cast<std::uint16_t>(i);
      const auto shape = assets_->shape(scene_->fixture_collision);
      if (!shape)
        return Failure{Fault::kAsset, "fixture `" + name + "` has no collision mesh", where};
      for (const scene::ConvexPart& part : shape->parts) {
        privileged_.fixtures.emplace_back();
        for (const Vec3& vertex : part.vertices) {
          privileged_.fixtures.back().push_back(vertex + shape->center_of_mass +
                                                to_vec(scene_->fixture_position));
        }
      }
    }
    if (is_kind(bodies[i], plan::BodyKind::kLink)) {
      if (links_.empty()) first_link_ = static_cast<std::uint16_t>(i);
      const int link = parts_->model.find_link(name);
      if (link < 0) return Failure{Fault::kUrdf, "no link `" + name + "`", parts_->model.path};
      links_.push_back(link);
    }
  }
  if (privileged_.objects.size() != object_count_) {
    return Failure{Fault::kPlan, "bodies and distractors do not add up", where};
  }
  return {};
}

world::WorldSpec EpisodeWorld::spec_at(std::span<const Pose> poses, bool with_links) const {
  world::WorldSpec spec;
  world::ArticulationSpec& arm = spec.articulations.emplace_back();
  arm.model = &parts_->model;
  arm.base = base_;
  for (const plan::DriveRecord& drive : plan_.drives(*robot_)) {
    arm.joints.push_back(
        {std::string(plan_.text(drive.joint)), drive.stiffness, drive.damping, drive.limit});
  }
  const auto joints = plan_.joints(*scene_);
  arm.positions.assign(joints.begin(), joints.end());
  for (std::size_t k = 0; with_links && k < links_.size(); ++k) {
    const auto link = static_cast<std::size_t>(links_[k]);
    const bool finger = k < robot_->fingers.size();
    arm.links.push_back({parts_->model.links[link].name, parts_->shapes[link],
                         finger ? robot_->finger_friction : robot_->link_friction,
                         finger ? robot_->finger_patch : 0});
  }
  const auto bodies = plan_.bodies(*task_);
  for (std::size_t i = 0; i < object_count_; ++i) {
    const plan::ObjectRecord& object = plan_.objects()[bodies[i].index];
    spec.bodies.push_back({std::string(plan_.text(bodies[i].name)),
                           assets_->shape(object.collision), object.density, object.friction,
                           poses[i]});
  }
  if (fixture_ != kNoFixture) {
    spec.fixtures.push_back({std::string(plan_.text(bodies[fixture_].name)),
                             assets_->shape(scene_->fixture_collision),
                             {to_vec(scene_->fixture_position), Quat::Identity()},
                             scene_->friction});
  }
  spec.dt = 1 / scene_->physics_hz;
  spec.surface_z = scene_->surface_z;
  spec.surface_friction = scene_->friction;
  return spec;
}

// The arm has no collision shapes while objects fall: that is how it is out of the way.
Result<std::vector<Pose>> EpisodeWorld::settle(std::span<const Pose> placed) {
  PROBE_ASSIGN(auto world, world::World::create(spec_at(placed, false)));
  const int phase = static_cast<int>(std::lround(task_->settle * scene_->physics_hz));
  world->lock_tilt(true);
  PROBE_TRY(world->step(phase));
  world->lock_tilt(false);
  world->stop_bodies();
  PROBE_TRY(world->step(phase));
  double speed = 0, spin = 0;
  for (std::size_t i = 0; i < object_count_; ++i) {
    speed += world->body(i).velocity.norm();
    spin += world->body(i).spin.norm();
  }
  if (speed > kStillSpeed || spin > kStillSpin) {
    PROBE_TRY(world->step(static_cast<int>(std::lround(kExtraSettle * scene_->physics_hz))));
  }
  std::vector<Pose> settled;
  for (std::size_t i = 0; i < object_count_; ++i) settled.push_back(world->body(i).pose);
  return settled;
}

Status EpisodeWorld::reset(std::uint32_t index) {
  const plan::EpisodeRecord& episode = plan_.episodes(*task_)[index];
  std::vector<Pose> placed;
  for (const plan::PlacementRecord& placement : plan_.placements(episode)) {
    const auto& q = placement.rotation;
    placed.push_back({to_vec(placement.position), Quat(q[0], q[1], q[2], q[3])});
  }
  if (placed.size() != object_count_) {
    return Failure{Fault::kPlan,
                   "episode " + std::to_string(index) + " places another number of objects",
                   "task `" + std::string(plan_.text(task_->name)) + "`"};
  }
  PROBE_ASSIGN(const std::vector<Pose> settled, settle(placed));
  PROBE_ASSIGN(world_, world::World::create(spec_at(settled, true)));
  controller_.reset(world_->joints());
  steps_ = 0;
  measure();
  take_starts();
  return {};
}

Status EpisodeWorld::act(const policy::Action& action) {
  PROBE_ASSIGN(const auto targets, controller_.targets(action, world_->joints()));
  world_->set_targets(targets);
  PROBE_TRY(world_->step(substeps_));
  ++steps_;
  measure();
  return {};
}

WorldState EpisodeWorld::save() const {
  return {world_->save(), controller_.save(), starts_, steps_};
}

Status EpisodeWorld::restore(const WorldState& state) {
  if (state.starts.size() != plan_.bodies(*task_).size()) {
    return Failure{Fault::kWorld, "the saved state is of a task with other bodies",
                   "task `" + std::string(plan_.text(task_->name)) + "`"};
  }
  if (!world_) {
    const std::vector<Pose> anywhere(object_count_);
    PROBE_ASSIGN(world_, world::World::create(spec_at(anywhere, true)));
  }
  PROBE_TRY(world_->restore(state.physics));
  PROBE_TRY(controller_.restore(state.control));
  starts_ = state.starts;
  steps_ = state.steps;
  measure();
  return {};
}

policy::Proprioception EpisodeWorld::proprioception() const {
  const auto q = world_->joints();
  return {controller_.tcp_pose(q), controller_.openness(q), {q.begin(), q.end()}};
}

void EpisodeWorld::take_starts() {
  const auto bodies = plan_.bodies(*task_);
  starts_.assign(bodies.size(), {});
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    starts_[i].position = sample_.bodies[i].position;
    if (i < object_count_) {
      const plan::ObjectRecord& object = plan_.objects()[bodies[i].index];
      const Vec3 half = (to_vec(object.box_max) - to_vec(object.box_min)) / 2;
      starts_[i].half = upright_half(half, sample_.bodies[i].rotation);
    }
  }
  for (std::size_t k = 0; k < robot_->fingers.size(); ++k) {
    starts_[first_link_ + k].opening = to_vec(robot_->fingers[k].opens).normalized();
  }
}

std::uint16_t EpisodeWorld::local_index(const world::Party& party) const {
  switch (party.kind) {
    case world::PartyKind::kSurface:
      return surface_;
    case world::PartyKind::kLink:
      return static_cast<std::uint16_t>(first_link_ + party.index);
    case world::PartyKind::kFixture:
      return fixture_;
    case world::PartyKind::kBody:
      break;
  }
  return party.index;
}

void EpisodeWorld::measure() {
  const auto q = world_->joints();
  const auto u = world_->joint_speeds();
  tree_.link_poses(q, link_poses_);
  const Eigen::Map<const Eigen::VectorXd> speeds(u.data(), static_cast<Eigen::Index>(u.size()));

  sample_.step = steps_;
  sample_.time = steps_ * substeps_ / scene_->physics_hz;
  sample_.grip = 1 - controller_.openness(q);
  sample_.tcp = base_.apply(link_poses_[static_cast<std::size_t>(tcp_)].position);
  sample_.bodies.assign(plan_.bodies(*task_).size(), {});
  objects_.clear();
  for (std::size_t i = 0; i < object_count_; ++i) {
    const world::BodyState state = world_->body(i);
    sample_.bodies[i] = {state.center, state.pose.position, state.velocity, state.spin,
                         state.pose.rotation};
    objects_.push_back(state.pose);
    privileged_.objects[i].pose = state.pose;
    privileged_.objects[i].finger_contact[0] = privileged_.objects[i].finger_contact[1] = false;
  }
  sample_.bodies[surface_].position = sample_.bodies[surface_].origin = {0, 0, scene_->surface_z};
  if (fixture_ != kNoFixture) {
    sample_.bodies[fixture_].position = sample_.bodies[fixture_].origin =
        to_vec(scene_->fixture_position);
  }
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Pose pose = base_ * link_poses_[static_cast<std::size_t>(links_[k])];
    tree_.jacobian(link_poses_, links_[k], jacobian_);
    const Eigen::Matrix<double, 6, 1> twist = jacobian_ * speeds;
    sample_.bodies[first_link_ + k] = {pose.position, pose.position,
                                       base_.rotation * Vec3(twist.head<3>()),
                                       base_.rotation * Vec3(twist.tail<3>()), pose.rotation};
  }

  sample_.contacts.clear();
  for (const world::ContactImpulse& contact : world_->contacts()) {
    const std::uint16_t a = local_index(contact.a), b = local_index(contact.b);
    // The world says what b exerts on a; a sample, what the lower index exerts on the higher.
    sample_.contacts.push_back(
        {std::min(a, b), std::max(a, b), a < b ? Vec3(-contact.on_a) : contact.on_a});
    for (std::uint16_t finger = 0; finger < 2; ++finger) {
      const auto link = static_cast<std::uint16_t>(first_link_ + finger);
      if (std::max(a, b) != link || std::min(a, b) >= object_count_) continue;
      privileged_.objects[std::min(a, b)].finger_contact[finger] |=
          contact.on_a.norm() >= kContactImpulse;
    }
  }
  std::sort(sample_.contacts.begin(), sample_.contacts.end(),
            [](const vm::ContactSample& x, const vm::ContactSample& y) {
              return x.a != y.a ? x.a < y.a : x.b < y.b;
            });
}

}  // namespace probe::stage
