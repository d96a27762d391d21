#include "runtime/stage/goal.h"

#include "runtime/vm/source_goal.h"

namespace probe::stage {

Result<policy::Goal> goal_of(const plan::Plan& plan, std::uint32_t task, std::uint32_t start) {
  using policy::Goal;
  PROBE_ASSIGN(const vm::SourceGoal goal, vm::source_goal(plan, task, start));
  switch (goal) {
    case vm::SourceGoal::kOnTarget:
      return Goal::kOnTarget;
    case vm::SourceGoal::kAway:
      return Goal::kAway;
    case vm::SourceGoal::kLifted:
      return Goal::kLifted;
    case vm::SourceGoal::kNothing:
      return Goal::kNothing;
    case vm::SourceGoal::kOther:
      break;
  }
  return Goal::kOther;
}

}  // namespace probe::stage
