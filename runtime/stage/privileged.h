// The view of policies that see everything, filled from the plan's assets once and from each
// sample.
#pragma once

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/task_bodies.h"
#include "runtime/vm/sample.h"

namespace probe::stage {

// What does not change in an episode. Fails (kAsset) on an object or fixture without a
// collision mesh, and with the failures of goal_of().
Result<policy::Privileged> make_privileged(const plan::Plan& plan, std::uint32_t task,
                                           const SharedAssets& assets, const TaskBodies& bodies);

// Where objects and links of fixtures are, and which of `fingers` touch objects.
void update_privileged(const vm::StepSample& sample, const TaskBodies& bodies, std::size_t fingers,
                       policy::Privileged* view);

}  // namespace probe::stage
