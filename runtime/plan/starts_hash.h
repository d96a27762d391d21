// All starts of a task as one hash: what was proved in each of them holds in a plan whose task has
// the same, and in no other.
#pragma once

#include <cstdint>

#include "runtime/base/sha256.h"
#include "runtime/plan/plan.h"

namespace probe::plan {

// Over the start ids of its episodes (ids.h), ascending, each once.
Sha256 starts_hash(const Plan& plan, const TaskRecord& task);

}  // namespace probe::plan
