// Sentences that an instruction becomes in the course of the episode, for `show`, `list` and `diff`.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// then: [{say, when}], where the task has any: `when` is the condition as it is written, null in a
// plan without its sources.
void add_later(const plan::Plan& plan, std::uint32_t task, Json& json);

// A line each: "put the can into it" when opened(cabinet.top_drawer).
Json later_text(const Json& later);

// The instruction of a task's JSON with what it becomes: "open the drawer; then: put the can in".
std::string whole_prompt(const Json& task);

// Whether two tasks are told the same at the same times.
bool same_prompt(const plan::Plan& a, std::uint32_t ours, const plan::Plan& b,
                 std::uint32_t theirs);

}  // namespace probe::inspect
