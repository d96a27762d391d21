#include "runtime/stage/goal.h"

#include "runtime/plan/roles.h"
#include "runtime/vm/made_up.h"

namespace probe::stage {
namespace {

constexpr double kAside = 0.2;    // m: far from the target
constexpr double kLifted = 0.12;  // m above where it stood

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

}  // namespace

Result<policy::Goal> goal_of(const plan::Plan& plan, std::uint32_t task) {
  using policy::Goal;
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), plan.tasks()[task]);
  if (!roles.has_source()) return Goal::kOther;
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (!success) return Goal::kOther;
  if (roles.has_target()) {
    PROBE_ASSIGN(const bool lies, lies_on_target(plan, task, *success));
    if (lies) return Goal::kOnTarget;
  } else {
    PROBE_ASSIGN(const bool lifted, holds_of(plan, task, *success, {0, 0, kLifted}));
    if (lifted) return Goal::kLifted;
  }
  PROBE_ASSIGN(const bool held, holds_of(plan, task, *success, {0, kAside, 0}));
  if (held) return Goal::kAway;
  return Goal::kOther;
}

}  // namespace probe::stage
