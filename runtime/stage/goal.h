// What success asks for, found by asking the judge about made-up worlds: for policies that see
// everything. No word of the instruction is read.
#pragma once

#include <cstdint>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"

namespace probe::stage {

// kAway where a source that lies on the target, let go, is no success and one held far from it is;
// kOnTarget for all else.
Result<policy::Goal> goal_of(const plan::Plan& plan, std::uint32_t task);

}  // namespace probe::stage
