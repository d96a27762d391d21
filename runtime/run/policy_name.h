// What rows may call a policy.
#pragma once

#include <string>

#include "runtime/base/result.h"

namespace probe::run {

// Fails (kUsage) where `name`, which rows call the policy `policy` (empty: one of the caller's), is
// none (check_row_name) or reads as another policy of this process: rows of the two could not be
// told apart.
Status check_policy_name(const std::string& name, const std::string& policy);

}  // namespace probe::run
