#include "runtime/stage/goal.h"

#include "runtime/vm/made_up.h"

namespace probe::stage {

Result<policy::Goal> goal_of(const plan::Plan& plan, std::uint32_t task) {
  const auto success = plan.find_metric(plan.tasks()[task], "success");
  if (!success) return policy::Goal::kOnTarget;
  vm::MadeUpWorld on = vm::make_up_world(plan, task);
  const double above = on.starts[0].half.z() + on.starts[1].half.z();
  on.put(0, on.sample.bodies[1].position + Vec3(0, 0, above));
  on.press_down(0, 1);
  on.press_down(1, on.surface);
  PROBE_ASSIGN(const bool lies, vm::judge_world(plan, task, *success, std::move(on)));
  if (lies) return policy::Goal::kOnTarget;
  vm::MadeUpWorld away = vm::make_up_world(plan, task);
  away.put(0, away.sample.bodies[0].position + Vec3(0, 0.2, 0));
  away.hold_source();
  PROBE_ASSIGN(const bool held, vm::judge_world(plan, task, *success, std::move(away)));
  return held ? policy::Goal::kAway : policy::Goal::kOnTarget;
}

}  // namespace probe::stage
