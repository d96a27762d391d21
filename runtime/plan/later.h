// Sentences that the instruction of a task becomes in the course of an episode. The first is the
// task's own; which is in force follows from the steps alone (runtime/vm/told.h).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plan/tables.h"

namespace probe::plan {

// Behind the first, in their order; none of most tasks.
std::span<const LaterRecord> later_of(const Tables& tables, std::uint32_t task);

// All that a policy may be told in turn, the task's instruction first.
std::vector<std::string_view> sentences_of(const Tables& tables, std::uint32_t task);

// The same in one line, as people read it: "open the drawer; then: put the can into it".
std::string whole_instruction(const Tables& tables, std::uint32_t task);
std::string whole_instruction(std::string_view first, std::span<const std::string> later);

}  // namespace probe::plan
