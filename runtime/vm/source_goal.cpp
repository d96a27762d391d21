#include "runtime/vm/source_goal.h"

#include <vector>

#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "runtime/vm/derived_solution.h"
#include "runtime/vm/made_up.h"

namespace probe::vm {
namespace {

constexpr double kHeldAside = 0.2;    // m: far from the target
constexpr double kHeldLifted = 0.12;  // m above where it stood

Result<bool> holds_held(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                        std::uint32_t start, const Vec3& by) {
  for (const Spread spread : kSpreads) {
    MadeUpWorld world = make_up_world(plan, task, start, spread);
    const bool is_aside = by.head<2>().norm() > 0;
    world.put(world.source, spread == Spread::kNear && is_aside
                                ? world.free_side()
                                : world.sample.bodies[world.source].position + world.mirrored(by));
    world.hold_source();
    PROBE_ASSIGN(const bool holds, judge_world(plan, task, success, std::move(world)));
    if (!holds) return false;
  }
  return true;
}

Result<bool> lies_on_target(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                            std::uint32_t start) {
  for (const Spread spread : kSpreads) {
    MadeUpWorld world = make_up_world(plan, task, start, spread);
    const double above = world.starts[world.source].half.z() + world.starts[world.target].half.z();
    world.put(world.source, world.sample.bodies[world.target].position + Vec3(0, 0, above));
    world.press_down(world.source, world.target);
    world.press_down(world.target, world.surface);
    PROBE_ASSIGN(const bool holds, judge_world(plan, task, success, std::move(world)));
    if (!holds) return false;
  }
  return true;
}

// Whether success is so as this start begins, and not as another kind of start does.
Result<bool> is_done_here(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                          std::uint32_t start) {
  const std::vector<std::uint32_t> kinds = kinds_of_starts(plan, task);
  if (kinds.size() < 2) return false;
  PROBE_ASSIGN(const bool holds,
               judge_world(plan, task, success, make_up_world(plan, task, start)));
  if (!holds) return false;
  for (const std::uint32_t other : kinds) {
    PROBE_ASSIGN(const bool holds_there,
                 judge_world(plan, task, success, make_up_world(plan, task, other)));
    if (!holds_there) return true;
  }
  return false;
}

}  // namespace

Result<SourceGoal> source_goal(const plan::Plan& plan, std::uint32_t task, std::uint32_t start) {
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), plan.tasks()[task]);
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (!success) return SourceGoal::kOther;
  PROBE_ASSIGN(const bool is_done, is_done_here(plan, task, *success, start));
  if (is_done) return SourceGoal::kNothing;
  if (!roles.has_source()) return SourceGoal::kOther;
  if (roles.has_target()) {
    PROBE_ASSIGN(const bool lies, lies_on_target(plan, task, *success, start));
    if (lies) return SourceGoal::kOnTarget;
  } else {
    PROBE_ASSIGN(const bool lifted, holds_held(plan, task, *success, start, {0, 0, kHeldLifted}));
    if (lifted) return SourceGoal::kLifted;
  }
  PROBE_ASSIGN(const bool held, holds_held(plan, task, *success, start, {0, kHeldAside, 0}));
  return held ? SourceGoal::kAway : SourceGoal::kOther;
}

Result<bool> has_skills(const plan::Plan& plan, std::uint32_t task) {
  if (!plan::skills_of(plan.tables(), task).empty()) return true;
  for (const std::uint32_t start : kinds_of_starts(plan, task)) {
    PROBE_ASSIGN(const SourceGoal goal, source_goal(plan, task, start));
    if (goal != SourceGoal::kOther) continue;
    PROBE_ASSIGN(const auto derived, derive_solution(plan, task, start));
    if (derived.empty()) return false;
  }
  return true;
}

}  // namespace probe::vm
