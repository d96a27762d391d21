#include "runtime/run/policy_name.h"

#include "runtime/base/row_name.h"
#include "runtime/base/utf8.h"
#include "runtime/run/policies.h"

namespace probe::run {

Status check_policy_name(const std::string& name, const std::string& policy) {
  if (name.empty() || name == policy) return {};
  PROBE_TRY(check_row_name(name));
  const auto choice = choose_policy(fold_case(compatible_form(name)));
  // A server may be called by an address: one that has moved keeps the rows' name.
  if (!choice || choice->server) return {};
  return name_taken(name, "policy", policy);
}

}  // namespace probe::run
