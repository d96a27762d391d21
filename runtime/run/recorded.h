// Actions out of stored traces, for the policy replay:DIR.
#pragma once

#include "runtime/policy/factory.h"
#include "runtime/run/trace.h"

namespace probe::run {

// The stored row's trace of an episode; without a seed the one with the lowest. Fails (code
// "usage") when the run has no such task, episode or seed, naming what it has.
struct StoredTrace {
  ResultRow row;
  Trace trace;
};
Result<StoredTrace> find_trace(const std::string& dir, const std::string& task, int episode,
                               std::optional<int> seed);

policy::PolicyContext policy_context();

}  // namespace probe::run
