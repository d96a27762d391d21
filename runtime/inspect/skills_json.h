// How a task can be solved, as its text says, for `show` and `diff`.
#pragma once

#include <cstdint>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// solution: ["open cabinet.top_drawer", ..], where the task's text says one.
void add_solution(const plan::Plan& plan, std::uint32_t task, Json& json);

// Whether two tasks of one name say the same.
bool same_solution(const plan::Plan& a, std::uint32_t ours, const plan::Plan& b,
                   std::uint32_t theirs);

}  // namespace probe::inspect
