// From plan records to a world, and the order of an episode in it.
#include "runtime/stage/episode_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/base/check.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/moves.h"
#include "runtime/stage/robot_of.h"

namespace probe::stage {
namespace {
// m/N: how far things sink into fingers whose paths begin anew where they are measured, each
// control step, and so press with nothing for a moment. In the engine that law was made for, what
// sank in goes on pressing then; between fingers that give way to nothing all would fall out of the
// hand.
constexpr double kFingersGive = 1e-6;

// The longer third phase of settling, if something still moves faster than this (m/s, rad/s, summed
// over objects and joints of fixtures), and how long it is (s). From the reference's reset.
constexpr double kStillSpeed = 1e-3, kStillSpin = 1e-2, kExtraSettle = 1.5;
// m/s: what is faster when all of that is over is in the air, not rolling or sliding out.
constexpr double kSettledSpeed = 0.5;

// An articulation that nobody drives, its joints at `positions`. Its springs rest where the fixture
// says, wherever settling has left the joints.
world::ArticulationSpec passive(const LoadedFixture& loaded, std::span<const double> positions) {
  const Fixture& fixture = loaded.fixture;
  world::ArticulationSpec spec;
  spec.name = fixture.name;
  spec.model = &loaded.parts.model;
  spec.base = fixture.base;
  spec.driven = false;
  spec.joints = fixture.joints;
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    if (!spec.joints[i].rest) spec.joints[i].rest = fixture.positions[i];
  }
  spec.positions.assign(positions.begin(), positions.end());
  for (std::size_t link = 0; link < loaded.parts.shapes.size(); ++link) {
    if (loaded.parts.shapes[link] == nullptr) continue;
    spec.links.push_back(
        {loaded.parts.model.links[link].name, loaded.parts.shapes[link], fixture.friction, 0});
  }
  return spec;
}

}  // namespace

EpisodeWorld::EpisodeWorld(const plan::Plan& plan, const plan::TaskRecord& task,
                           std::shared_ptr<const SharedAssets> assets, robot::Robot robot,
                           robot::Controller controller, TaskBodies bodies,
                           std::vector<PlacedTree> trees)
    : plan_(plan),
      task_(task),
      scene_(plan.scenes()[task.scene]),
      record_(plan.robots()[scene_.robot]),
      assets_(std::move(assets)),
      robot_(std::move(robot)),
      controller_(std::move(controller)),
      space_(robot::action_space_of(robot_)),
      bodies_(std::move(bodies)),
      instruments_(plan, task, bodies_, std::move(trees), robot_.model->find_link(robot_.tcp_link)),
      substeps_(static_cast<int>(std::lround(scene_.physics_hz / record_.control_hz))) {}

Result<std::unique_ptr<EpisodeWorld>> EpisodeWorld::create(
    const plan::Plan& plan, std::uint32_t task_index, std::shared_ptr<const SharedAssets> assets) {
  const plan::TaskRecord& task = plan.tasks()[task_index];
  const plan::RobotRecord& record = plan.robots()[plan.scenes()[task.scene].robot];
  const UrdfParts* parts = assets->robot(record.urdf);
  PROBE_CHECK(parts != nullptr, "assets are loaded for the tasks that run");

  PROBE_ASSIGN(robot::Robot robot, robot_of(plan, record, *parts));
  PROBE_ASSIGN(std::vector<PlacedTree> trees, placed_trees(plan, task, *assets));
  PROBE_ASSIGN(auto controller, robot::Controller::create(parts->model, robot.control, robot.law));
  PROBE_ASSIGN(TaskBodies bodies, task_bodies(plan, task, *assets));
  PROBE_ASSIGN(policy::Privileged view, make_privileged(plan, task_index, *assets, bodies));
  auto made = std::unique_ptr<EpisodeWorld>(
      new EpisodeWorld(plan, task, std::move(assets), std::move(robot), std::move(controller),
                       std::move(bodies), std::move(trees)));
  made->privileged_ = std::move(view);
  PROBE_ASSIGN(made->drives_, drives_of(plan, record, parts->model));
  return made;
}

EpisodeWorld::Arrangement EpisodeWorld::arrangement(std::vector<Pose> objects) const {
  Arrangement at{std::move(objects), {}};
  for (const LoadedFixture* loaded : assets_->fixtures(task_.scene)) {
    const std::vector<double>& positions = loaded->fixture.positions;
    at.fixture_joints.insert(at.fixture_joints.end(), positions.begin(), positions.end());
  }
  return at;
}

EpisodeWorld::Arrangement EpisodeWorld::begun(const plan::EpisodeRecord& episode,
                                              std::vector<Pose> objects) const {
  Arrangement at = arrangement(std::move(objects));
  std::ranges::copy(plan::joint_starts_of(plan_.tables(), scene_, episode),
                    at.fixture_joints.begin());
  return at;
}

world::WorldSpec EpisodeWorld::spec_at(const Arrangement& at, bool with_robot_links) const {
  const UrdfParts& parts = *assets_->robot(record_.urdf);
  world::WorldSpec spec;
  world::ArticulationSpec& arm = spec.articulations.emplace_back();
  arm.model = &parts.model;
  arm.base = base_pose(scene_);
  // While objects fall nobody drives the arm: it floats.
  arm.by_efforts = with_robot_links && controller_.kind().reads == robot::Reads::kDynamics;
  arm.joints = drives_;
  arm.positions = arm_;
  const bool begins_anew = controller_.kind().kind == robot::ControlKind::kEeDeltaInterpolated;
  for (std::size_t k = 0; with_robot_links && k < bodies_.robot_links; ++k) {
    const auto link = static_cast<std::size_t>(bodies_.links[k].link);
    const bool finger = k < robot_.fingers.size();
    arm.links.push_back({parts.model.links[link].name, parts.shapes[link],
                         finger ? record_.finger_friction : record_.link_friction,
                         finger ? record_.finger_patch : 0,
                         finger && begins_anew ? kFingersGive : 0});
  }
  std::span<const double> left = at.fixture_joints;
  for (const LoadedFixture* loaded : assets_->fixtures(task_.scene)) {
    spec.articulations.push_back(passive(*loaded, left.first(loaded->fixture.positions.size())));
    left = left.subspan(loaded->fixture.positions.size());
  }
  const auto records = plan_.bodies(task_);
  for (std::size_t i = 0; i < bodies_.objects; ++i) {
    const plan::ObjectRecord& object = plan_.objects()[records[i].index];
    const auto shape = assets_->object_shape(records[i].index);
    const plan::MassRecord* mass = plan_.mass(object);
    spec.bodies.push_back({std::string(plan_.text(records[i].name)), shape,
                           mass == nullptr ? object.density : mass->mass / shape->volume,
                           object.friction, at.objects[i]});
    if (const plan::DampingRecord* damping = plan_.damping(object)) {
      spec.bodies.back().damping = damping->shift;
      spec.bodies.back().turn_damping = damping->turn;
    }
  }
  if (bodies_.fixture != TaskBodies::kNone) {
    spec.fixtures.push_back({std::string(plan_.text(records[bodies_.fixture].name)),
                             assets_->shape(scene_.fixture_collision),
                             {to_vec(scene_.fixture_position), Quat::Identity()},
                             scene_.friction});
  }
  spec.dt = 1 / scene_.physics_hz;
  spec.surface_z = scene_.surface_z;
  spec.surface_friction = scene_.friction;
  spec.air = {scene_.air_density, scene_.air_viscosity};
  return spec;
}

// The arm has no collision shapes while objects fall: that is how it is out of the way.
Result<EpisodeWorld::Arrangement> EpisodeWorld::settle(const Arrangement& placed) {
  PROBE_ASSIGN(auto world, world::World::create(spec_at(placed, false)));
  const int phase = static_cast<int>(std::lround(task_.settle * scene_.physics_hz));
  world->lock_tilt(true);
  PROBE_TRY(world->step(phase));
  world->lock_tilt(false);
  world->stop_bodies();
  PROBE_TRY(world->step(phase));
  if (still_moves(*world)) {
    PROBE_TRY(world->step(static_cast<int>(std::lround(kExtraSettle * scene_.physics_hz))));
  }
  PROBE_TRY(check_settled(*world));
  Arrangement settled;
  for (std::size_t i = 0; i < bodies_.objects; ++i) settled.objects.push_back(world->body(i).pose);
  const auto joints = world->joints().subspan(controller_.joint_count());
  settled.fixture_joints.assign(joints.begin(), joints.end());
  return settled;
}

bool EpisodeWorld::still_moves(const world::World& world) const {
  double speed = 0, spin = 0;
  for (std::size_t i = 0; i < bodies_.objects; ++i) {
    speed += world.body(i).velocity.norm();
    spin += world.body(i).spin.norm();
  }
  auto rates = world.joint_speeds().subspan(controller_.joint_count());
  for (const LoadedFixture* loaded : assets_->fixtures(task_.scene)) {
    const robot::RobotModel& model = loaded->parts.model;
    for (const world::JointSpec& joint : loaded->fixture.joints) {
      const auto index = static_cast<std::size_t>(model.find_joint(joint.joint));
      const bool slides = model.joints[index].kind == robot::JointKind::kPrismatic;
      (slides ? speed : spin) += std::abs(rates.front());
      rates = rates.subspan(1);
    }
  }
  return speed > kStillSpeed || spin > kStillSpin;
}

// An episode begins with everything at rest: in the air it would begin where nothing can be.
Status EpisodeWorld::check_settled(const world::World& world) const {
  for (std::size_t i = 0; i < bodies_.objects; ++i) {
    const auto body = world.body(i);
    const double speed = body.velocity.norm();
    if (speed <= kSettledSpeed) continue;
    return Failure{
        Fault::kWorld,
        fmt::format("`{}` has not come to rest: it moves at {:.1f} m/s, its middle {:.2f} m "
                    "above the surface, when the time to settle ends",
                    bodies_.names[i], speed, body.center.z() - scene_.surface_z),
        ""};
  }
  return {};
}

Status EpisodeWorld::begin_world(const Arrangement& at) {
  PROBE_ASSIGN(world_, world::World::create(spec_at(at, true)));
  PROBE_ASSIGN(world::ControlLoop loop, world::ControlLoop::create(*world_, controller_));
  loop_ = std::move(loop);
  return {};
}

Status EpisodeWorld::begin_view(std::uint32_t index) {
  const auto task = static_cast<std::uint32_t>(&task_ - plan_.tasks().data());
  PROBE_ASSIGN(ToDo to_do, to_dos_.of(plan_, task, index, bodies_));
  privileged_.goal = to_do.goal;
  privileged_.solution = std::move(to_do.solution);
  const std::vector<double> joints = begun(plan_.episodes(task_)[index], {}).fixture_joints;
  for (policy::PrivilegedFixture& fixture : privileged_.fixtures) {
    if (fixture.joint) fixture.joint->rest = joints[fixture.joint->number];
  }
  return {};
}

Status EpisodeWorld::reset(std::uint32_t index) {
  PROBE_TRY(begin_view(index));
  const plan::EpisodeRecord& episode = plan_.episodes(task_)[index];
  std::vector<Pose> placed;
  for (const plan::PlacementRecord& placement : plan_.placements(episode)) {
    placed.push_back({to_vec(placement.position), to_quat(placement.rotation)});
  }
  if (placed.size() != bodies_.objects) {
    return Failure{Fault::kPlan,
                   "episode " + std::to_string(index) + " places another number of objects",
                   "task `" + std::string(plan_.text(task_.name)) + "`"};
  }
  const auto joints = plan_.joints(scene_, episode);
  arm_.assign(joints.begin(), joints.end());
  waiting_.clear();
  PROBE_ASSIGN(const Arrangement settled, settle(begun(episode, std::move(placed))));
  PROBE_TRY(begin_world(settled));
  if (episode.arm.count != 0) PROBE_TRY(check_arm());
  controller_.reset(robot_q());
  PROBE_TRY(idle());
  steps_ = 0;
  measure();
  starts_ = instruments_.starts(sample_);
  for (const auto legs : plan::moves_of(plan_.tables(), task_))
    world_->lead(legs.front().body, Vec3::Zero());
  return {};
}

// An arm that does not begin where its scene says must not begin in something.
Status EpisodeWorld::check_arm() const {
  constexpr double kRubs = 1e-3;  // m
  const auto found = world_->robot_stands_in(kRubs);
  if (!found) return {};
  return Failure{Fault::kWorld,
                 fmt::format("the arm begins {:.1f} cm in `{}`", 100 * found->depth,
                             bodies_.names[bodies_.local(found->other)]),
                 ""};
}

// What the arm is told while it waits: to stay where it was told to be, the gripper open.
policy::Action EpisodeWorld::stay() const {
  return robot::standstill(space_, controller_.targets(), 1);
}

// What the controller reads. Of an action of another size it says so.
policy::Action EpisodeWorld::in_law(const policy::Action& action) const {
  const auto* osc = std::get_if<robot::OscPose>(&robot_.law);
  if (osc == nullptr || action.size() != robot::kActionSize) return action;
  return robot::shares_of(*osc, action.tool());
}

// The arm stays.
Status EpisodeWorld::idle() {
  for (std::uint32_t i = 0; i < task_.idle; ++i)
    PROBE_TRY(loop_->step(in_law(stay()), substeps_, &controller_, world_.get()));
  return {};
}

// Where actions are late, what was said so many steps ago is done; before that the arm stays.
Status EpisodeWorld::act(const policy::Action& now) {
  policy::Action action = now;
  if (task_.delay != 0) {
    if (!std::ranges::all_of(now, [](double number) { return std::isfinite(number); }))
      return Failure{Fault::kPolicy, "an action has a number that is not finite", ""};
    waiting_.push_back(now);
    if (waiting_.size() <= task_.delay) return move(stay());
    action = waiting_.front();
    waiting_.pop_front();
  }
  return move(action);
}

// What nobody touched so far, from where it lay when the episode began. The way between two control
// steps is straight. At its end it is a thing like any other.
void EpisodeWorld::lead() {
  const double step = substeps_ / scene_.physics_hz;  // s
  for (const auto legs : plan::moves_of(plan_.tables(), task_)) {
    const std::size_t body = legs.front().body;
    if (!world_->is_led(body)) continue;
    if (steps_ * step >= plan::moves_until(legs)) {
      world_->lead(body, Vec3::Zero());
      world_->let_go(body);
      continue;
    }
    const auto [x, y] = plan::offset_at(legs, (steps_ + 1) * step);
    const Vec3 there = starts_[body].position + Vec3(x, y, 0);
    world_->lead(body, (there - world_->body(body).center) / step);
  }
}

// One control step.
Status EpisodeWorld::move(const policy::Action& action) {
  lead();
  PROBE_TRY(loop_->step(in_law(action), substeps_, &controller_, world_.get()));
  ++steps_;
  measure();
  return {};
}

WorldState EpisodeWorld::save() const {
  return {world_->save(), controller_.save(), starts_, steps_, {waiting_.begin(), waiting_.end()}};
}

Status EpisodeWorld::restore(const WorldState& state) {
  if (state.starts.size() != bodies_.count()) {
    return Failure{Fault::kWorld, "the saved state is of a task with other bodies",
                   "task `" + std::string(plan_.text(task_.name)) + "`"};
  }
  if (state.waiting.size() !=
      std::min<std::size_t>(task_.delay, static_cast<std::size_t>(state.steps))) {
    return Failure{Fault::kWorld, "the saved state has actions on their way of another task",
                   "task `" + std::string(plan_.text(task_.name)) + "`"};
  }
  if (std::ranges::any_of(state.waiting,
                          [&](const auto& one) { return one.size() != space_.size(); })) {
    return Failure{Fault::kWorld, "the saved state has actions on their way of another robot",
                   "task `" + std::string(plan_.text(task_.name)) + "`"};
  }
  if (!world_) {
    const auto joints = plan_.joints(scene_);
    arm_.assign(joints.begin(), joints.end());
    std::vector<Pose> anywhere(bodies_.objects);
    PROBE_TRY(begin_world(arrangement(std::move(anywhere))));
  }
  PROBE_TRY(world_->restore(state.physics));
  for (const auto legs : plan::moves_of(plan_.tables(), task_)) {
    if (world_->led_to(legs.front().body)) continue;
    return Failure{
        Fault::kWorld,
        fmt::format("the saved state does not say where `{}` was let go, which moves by itself",
                    bodies_.names[legs.front().body]),
        "task `" + std::string(plan_.text(task_.name)) + "`"};
  }
  PROBE_TRY(controller_.restore(state.control));
  starts_ = state.starts;
  steps_ = state.steps;
  waiting_.assign(state.waiting.begin(), state.waiting.end());
  measure();
  return {};
}

policy::Proprioception EpisodeWorld::proprioception() const {
  const auto q = robot_q();
  return {controller_.tcp_pose(q),
          controller_.openness(q),
          {q.begin(), q.end()},
          robot_.control.finger_joints.size()};
}

std::vector<std::string> EpisodeWorld::joint_names() const {
  std::vector<std::string> names = robot_.joints;
  for (const LoadedFixture* loaded : assets_->fixtures(task_.scene)) {
    for (const world::JointSpec& joint : loaded->fixture.joints) {
      names.push_back(name_in(loaded->fixture, joint.joint));
    }
  }
  return names;
}

void EpisodeWorld::measure() {
  instruments_.read(*world_, steps_, substeps_, controller_.openness(robot_q()), &sample_);
  objects_.clear();
  for (std::size_t i = 0; i < bodies_.objects; ++i) {
    objects_.push_back({sample_.bodies[i].origin, sample_.bodies[i].rotation});
  }
  update_privileged(sample_, bodies_, robot_.fingers.size(), &privileged_);
}

}  // namespace probe::stage
