#include "runtime/vm/source_goal.h"

#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "runtime/vm/derived_solution.h"
#include "runtime/vm/made_up.h"

namespace probe::vm {
namespace {

constexpr double kHeldAside = 0.2;    // m: far from the target
constexpr double kHeldLifted = 0.12;  // m above where it stood

Result<bool> holds_held(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                        const Vec3& by) {
  MadeUpWorld world = make_up_world(plan, task);
  world.put(world.source, world.sample.bodies[world.source].position + by);
  world.hold_source();
  return judge_world(plan, task, success, std::move(world));
}

Result<bool> lies_on_target(const plan::Plan& plan, std::uint32_t task, std::uint32_t success) {
  MadeUpWorld world = make_up_world(plan, task);
  const double above = world.starts[world.source].half.z() + world.starts[world.target].half.z();
  world.put(world.source, world.sample.bodies[world.target].position + Vec3(0, 0, above));
  world.press_down(world.source, world.target);
  world.press_down(world.target, world.surface);
  return judge_world(plan, task, success, std::move(world));
}

}  // namespace

Result<SourceGoal> source_goal(const plan::Plan& plan, std::uint32_t task) {
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), plan.tasks()[task]);
  if (!roles.has_source()) return SourceGoal::kOther;
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (!success) return SourceGoal::kOther;
  if (roles.has_target()) {
    PROBE_ASSIGN(const bool lies, lies_on_target(plan, task, *success));
    if (lies) return SourceGoal::kOnTarget;
  } else {
    PROBE_ASSIGN(const bool lifted, holds_held(plan, task, *success, {0, 0, kHeldLifted}));
    if (lifted) return SourceGoal::kLifted;
  }
  PROBE_ASSIGN(const bool held, holds_held(plan, task, *success, {0, kHeldAside, 0}));
  return held ? SourceGoal::kAway : SourceGoal::kOther;
}

Result<bool> has_skills(const plan::Plan& plan, std::uint32_t task) {
  if (!plan::skills_of(plan.tables(), task).empty()) return true;
  PROBE_ASSIGN(const SourceGoal goal, source_goal(plan, task));
  if (goal != SourceGoal::kOther) return true;
  PROBE_ASSIGN(const auto derived, derive_solution(plan, task));
  return !derived.empty();
}

}  // namespace probe::vm
