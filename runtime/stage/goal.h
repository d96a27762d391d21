// What success asks for, found by asking the judge about made-up worlds: for policies that see
// everything. No word of the instruction is read.
#pragma once

#include <cstdint>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"

namespace probe::stage {

// kAway where a source that lies on the target, let go, is no success and one held far from it is;
// without a target kLifted or kAway where one held above its start or far from it is. For all else
// kOnTarget where the task has a source, a target and no other role, or kOther;
// kOther too where skills make a success that is no usual one: joints of fixtures at their ends.
Result<policy::Goal> goal_of(const plan::Plan& plan, std::uint32_t task);

}  // namespace probe::stage
