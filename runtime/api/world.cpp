#include "runtime/api/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "runtime/api/arrays.h"
#include "runtime/api/calls.h"
#include "runtime/robot/action.h"
#include "runtime/stage/stage_state.h"
#include "runtime/vm/claims.h"

namespace probe::api {
namespace {

std::array<double, 7> numbers_of(const Pose& pose) {
  const Vec3& p = pose.position;
  const Quat& q = pose.rotation;
  return {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

Result<policy::Action> read_action(std::span<const double> numbers, std::size_t size) {
  policy::Action action = policy::Action::zeros(size);
  if (numbers.size() != size) {
    return usage("an action has " + std::to_string(size) + " numbers, found " +
                 std::to_string(numbers.size()));
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    action[i] = numbers[i];
    if (std::isfinite(numbers[i]) && std::fabs(numbers[i]) <= robot::kAbsurdAction) continue;
    return usage("number " + std::to_string(i) + " of the action is " +
                 (std::isfinite(numbers[i]) ? "larger than any policy means: metres, radians, a "
                                              "gripper from -1 to 1 are expected"
                                            : "not finite"));
  }
  return action;
}

ActionBounds::ActionBounds(const robot::Robot& robot) : space(robot::action_space_of(robot)) {
  constexpr double kShift = 0.05,
                   kTurn = 0.25;  // m, rad in a control step: a share of what arms do
  // What the law cuts steps to is what they can be.
  const auto* const steps = std::get_if<robot::JointDelta>(&robot.law);
  const double most = steps == nullptr ? 0 : steps->most;
  for (std::size_t i = 0; i + 1 < space.size(); ++i) {
    high.push_back(most > 0 ? most : space.is_length(i) ? kShift : kTurn);
    low.push_back(-high.back());
    if (space.layout != robot::ActionLayout::kJoints) continue;
    const auto index = static_cast<std::size_t>(robot.model->find_joint(space.joints[i]));
    const robot::Joint& joint = robot.model->joints[index];
    const bool turns_on = joint.kind == robot::JointKind::kContinuous;
    low.back() = turns_on ? -std::numbers::pi : joint.lower;
    high.back() = turns_on ? std::numbers::pi : joint.upper;
  }
  low.push_back(-1);
  high.push_back(1);
}

vlaprobe_action_space ActionBounds::told() const {
  const vlaprobe_action_kind kind = !space.is_of_joints() ? VLAPROBE_TOOL
                                    : space.layout == robot::ActionLayout::kJointSteps
                                        ? VLAPROBE_JOINT_STEPS
                                        : VLAPROBE_JOINT_POSITIONS;
  return {kind, static_cast<std::int32_t>(space.size()),
          array_of(std::span<const double>(low), {low.size()}),
          array_of(std::span<const double>(high), {high.size()})};
}

Status check_picture_size(std::int32_t width, std::int32_t height) {
  constexpr std::int32_t kLargest = 8192;
  for (const std::int32_t side : {width, height}) {
    if (side >= 0 && side <= kLargest) continue;
    return usage("a picture is 1 to " + std::to_string(kLargest) +
                 " pixels wide and high, or 0 for the camera's own size; found " +
                 std::to_string(side));
  }
  if ((width > 0) == (height > 0)) return {};
  return usage("a picture's size is both width and height, or neither");
}

std::vector<Camera> cameras_of(const plan::Plan& plan, const plan::TaskRecord& task,
                               const stage::ImageSize& size) {
  std::vector<Camera> cameras;
  for (const plan::ViewRecord& view : plan.views(task)) {
    const plan::CameraRecord& camera = plan.cameras()[view.camera];
    cameras.push_back({std::string(plan.text(view.name)),
                       size.width > 0 ? size.width : static_cast<int>(camera.width),
                       size.height > 0 ? size.height : static_cast<int>(camera.height)});
  }
  return cameras;
}

World::World(std::shared_ptr<const SharedPlan> plan, std::unique_ptr<stage::Stage> stage,
             stage::ImageSize size)
    : plan_(std::move(plan)), stage_(std::move(stage)), actions_(stage_->robot()) {
  const plan::TaskRecord& task = plan_->plan().tasks()[stage_->task()];
  horizon_ = static_cast<int>(task.horizon);
  for (const plan::BodyRecord& body : plan_->plan().bodies(task)) {
    object_count_ += body.kind == static_cast<std::uint32_t>(plan::BodyKind::kObject) ? 1 : 0;
  }
  joint_names_ = stage_->joint_names();
  cameras_ = cameras_of(plan_->plan(), task, size);
  success_ = stage_->judge().find_metric("success");
}

Result<std::unique_ptr<World>> World::create(std::shared_ptr<const SharedPlan> plan,
                                             std::uint32_t task,
                                             std::shared_ptr<const stage::SharedAssets> assets,
                                             const stage::StageOptions& options) {
  PROBE_ASSIGN(auto stage, stage::Stage::create(plan->plan(), task, std::move(assets), options));
  return std::unique_ptr<World>(new World(std::move(plan), std::move(stage), options.image));
}

std::string World::place() const {
  std::string place = task_place(*plan_, task());
  if (phase_ != Phase::kEmpty) place += " episode " + std::to_string(episode_);
  return place;
}

Status World::reset(std::int32_t episode) {
  PROBE_TRY(plan_->check_episode(task(), episode));
  phase_ = Phase::kBroken;
  ++turn_;
  episode_ = episode;
  proprioception_.reset();
  const auto placed = [&](Failure failure) {
    failure.where = place() + (failure.where.empty() ? "" : ", " + failure.where);
    return failure;
  };
  if (auto reset = stage_->reset(static_cast<std::uint32_t>(episode)); !reset)
    return placed(reset.failure());
  if (auto so = vm::check_claims(plan_->plan(), task(), stage_->body_starts(), stage_->sample());
      !so)
    return placed(so.failure());
  phase_ = Phase::kInEpisode;
  return {};
}

Status World::check_episode() const {
  if (phase_ == Phase::kInEpisode) return {};
  return usage(phase_ == Phase::kEmpty
                   ? "no episode has begun: reset first"
                   : "the episode has failed and cannot go on: reset begins another one",
               place());
}

Status World::check_step() const {
  PROBE_TRY(check_episode());
  if (!terminated() && stage_->steps() < horizon_) return {};
  return usage("the episode is over after " + std::to_string(stage_->steps()) +
                   " control steps: reset begins another one",
               place());
}

Status World::step(const policy::Action& action) {
  PROBE_TRY(check_step());
  proprioception_.reset();
  auto stepped = stage_->step(action);
  if (stepped) return {};
  phase_ = Phase::kBroken;
  Failure failure = stepped.failure();
  failure.where = place() + (failure.where.empty() ? "" : ", " + failure.where);
  return failure;
}

Result<policy::Observation> World::observe() {
  PROBE_TRY(check_episode());
  return stage_->observe();
}

Result<std::vector<std::byte>> World::save() const {
  PROBE_TRY(check_episode());
  return stage_->save().to_bytes();
}

Status World::restore(std::span<const std::byte> bytes) {
  PROBE_ASSIGN(const stage::StageState state, stage::StageState::from_bytes(bytes));
  phase_ = Phase::kBroken;
  ++turn_;
  proprioception_.reset();
  PROBE_TRY(stage_->restore(state));
  episode_ = static_cast<std::int32_t>(state.start);
  phase_ = Phase::kInEpisode;
  return {};
}

std::span<const double> World::objects() {
  objects_.clear();
  for (const Pose& pose : stage_->objects()) {
    const auto numbers = numbers_of(pose);
    objects_.insert(objects_.end(), numbers.begin(), numbers.end());
  }
  return objects_;
}

void World::write_tool(double (&out)[7]) {
  std::ranges::copy(numbers_of(proprioception().tcp_in_base), out);
}

const policy::Proprioception& World::proprioception() {
  if (!proprioception_) proprioception_ = stage_->proprioception();
  return *proprioception_;
}

}  // namespace probe::api
