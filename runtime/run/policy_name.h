// What rows may call a policy.
#pragma once

#include <string>

#include "runtime/base/result.h"

namespace probe::run {

// Whether `name`, which rows call the policy `policy` (empty: one of the caller's), is how another
// policy of this process is written: rows of the two could not be told apart. Fails (kUsage) there.
Status check_policy_name(const std::string& name, const std::string& policy);

}  // namespace probe::run
