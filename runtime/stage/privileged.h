// The view of policies that see everything, filled from the plan's assets once and from each
// sample.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/task_bodies.h"
#include "runtime/vm/sample.h"

namespace probe::stage {

// What no episode of the task changes. Fails (kAsset) on an object or fixture without a collision
// mesh.
Result<policy::Privileged> make_privileged(const plan::Plan& plan, std::uint32_t task,
                                           const SharedAssets& assets, const TaskBodies& bodies);

// What is to be done from a start: the goal, and the skills that the text says or that are derived
// as joints begin there.
struct ToDo {
  policy::Goal goal = policy::Goal::kOther;
  std::vector<policy::Skill> solution;
};
// Each kind of start is asked about once. Fails as goal_of() and vm::derive_solution().
class ToDos {
 public:
  Result<ToDo> of(const plan::Plan& plan, std::uint32_t task, std::uint32_t start,
                  const TaskBodies& bodies);

 private:
  std::map<std::vector<double>, ToDo> known_;  // by vm::begins_as()
};

// Where objects and links of fixtures are, and which of `fingers` touch objects.
void update_privileged(const vm::StepSample& sample, const TaskBodies& bodies, std::size_t fingers,
                       policy::Privileged* view);

}  // namespace probe::stage
