// Claims of a plan: the words of an instruction that say where things are, and the programs by
// which they are judged at the settled start. Which metric is of which body is said here and
// nowhere else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/plan/tables.h"

namespace probe::plan {

// The claims of a task, in the order of its words. `tables` has passed the verifier.
std::span<const ClaimRecord> claims_of(const Tables& tables, std::uint32_t task);

// What the metric is called that says whether the words denote the task's body `body`: "body_3".
std::string claim_metric(std::uint32_t body);
// The body of a metric that is called so.
std::optional<std::uint32_t> claimed_body(std::string_view metric);

}  // namespace probe::plan
