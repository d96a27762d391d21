// What success asks for, found by asking the judge about made-up worlds: for policies that see
// everything. No word of the instruction is read.
#pragma once

#include <cstdint>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"

namespace probe::stage {

// kAway where a source that lies on the target, let go, is no success and one held far from it is;
// without a target kLifted or kAway where one held above its start or far from it is; kNothing
// where joints begin in this start as they shall end. All else is kOther: it is done by skills
// where they make success, and not attempted where none do.
Result<policy::Goal> goal_of(const plan::Plan& plan, std::uint32_t task, std::uint32_t start = 0);

}  // namespace probe::stage
