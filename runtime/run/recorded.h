// Actions out of stored traces, for the policy replay:DIR.
#pragma once

#include "runtime/run/policies.h"

namespace probe::run {

// With which replay:DIR reads the actions of stored episodes.
PolicyContext policy_context();

}  // namespace probe::run
