#include "runtime/stage/goal.h"

#include <vector>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/roles.h"
#include "runtime/vm/made_up.h"

namespace probe::stage {
namespace {

constexpr double kAside = 0.2;    // m: far from the target
constexpr double kLifted = 0.12;  // m above where it stood
constexpr double kTurned = 1.5;   // rad: how far a joint without end is turned either way

Result<bool> holds_of(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                      const Vec3& by) {
  vm::MadeUpWorld world = vm::make_up_world(plan, task);
  world.put(world.source, world.sample.bodies[world.source].position + by);
  world.hold_source();
  return vm::judge_world(plan, task, success, std::move(world));
}

Result<bool> lies_on_target(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  vm::MadeUpWorld world = vm::make_up_world(plan, task);
  const double above = world.starts[world.source].half.z() + world.starts[world.target].half.z();
  world.put(world.source, world.sample.bodies[world.target].position + Vec3(0, 0, above));
  world.press_down(world.source, world.target);
  world.press_down(world.target, world.surface);
  return vm::judge_world(plan, task, success, std::move(world));
}

// Whether a joint of a fixture at one of its ends, or all of them there, makes the success that is
// none while nothing has moved: what is asked for then is not carried.
Result<bool> asks_for_joints(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const vm::MadeUpWorld still = vm::make_up_world(plan, task);
  const auto joints = plan::joints_of(plan.tables(), plan.scenes()[record.scene]);
  if (joints.empty() || plan.episodes(record).empty()) return false;
  PROBE_ASSIGN(const bool at_once, vm::judge_world(plan, task, success, still));
  if (at_once) return false;
  const std::size_t first = still.sample.joints.size() - joints.size();  // the robot's stand before
  for (const bool up : {false, true}) {
    vm::MadeUpWorld all = still;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const plan::FixtureJointRecord& joint = *joints[k];
      double end = up ? joint.upper : joint.lower;
      if (plan::is_endless(joint))
        end = still.sample.joints[first + k].position + (up ? kTurned : -kTurned);
      vm::MadeUpWorld one = still;
      one.sample.joints[first + k].position = all.sample.joints[first + k].position = end;
      PROBE_ASSIGN(const bool alone, vm::judge_world(plan, task, success, std::move(one)));
      if (alone) return true;
    }
    PROBE_ASSIGN(const bool together, vm::judge_world(plan, task, success, std::move(all)));
    if (together) return true;
  }
  return false;
}

}  // namespace

Result<policy::Goal> goal_of(const plan::Plan& plan, std::uint32_t task) {
  using policy::Goal;
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), plan.tasks()[task]);
  if (!roles.has_source()) return Goal::kOther;
  // What asks for a source, a target and nothing else is taken for the usual task in case of doubt.
  const bool is_usual = roles.has_both() && roles.others.empty();
  const Goal else_goal = is_usual ? Goal::kOnTarget : Goal::kOther;
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (!success) return else_goal;
  if (roles.has_target()) {
    PROBE_ASSIGN(const bool lies, lies_on_target(plan, task, *success));
    if (lies) return Goal::kOnTarget;
  } else {
    PROBE_ASSIGN(const bool lifted, holds_of(plan, task, *success, {0, 0, kLifted}));
    if (lifted) return Goal::kLifted;
  }
  PROBE_ASSIGN(const bool held, holds_of(plan, task, *success, {0, kAside, 0}));
  if (held) return Goal::kAway;
  PROBE_ASSIGN(const bool by_joints, asks_for_joints(plan, task, *success));
  return by_joints ? Goal::kOther : else_goal;
}

}  // namespace probe::stage
