#include "runtime/run/policy_name.h"

#include "runtime/run/policies.h"

namespace probe::run {

Status check_policy_name(const std::string& name, const std::string& policy) {
  if (name.empty() || name == policy) return {};
  const auto choice = choose_policy(name);
  // A server may be called by an address: one that has moved keeps the rows' name.
  if (!choice || choice->server) return {};
  const std::string asked = policy.empty() ? "the caller's policy" : "`" + policy + "`";
  return Failure{Fault::kUsage,
                 "`" + name + "` is a policy of the program's own, whose rows could not be told " +
                     "from those of " + asked + ": give it another name",
                 "--name"};
}

}  // namespace probe::run
