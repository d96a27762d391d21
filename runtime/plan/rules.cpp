#include "runtime/plan/rules.h"

#include <array>

namespace probe::plan {
namespace {

constexpr std::array kRules = {
#define PROBE_RULE(name, id, statement) RuleInfo{Rule::k##name, id, statement},
#include "runtime/plan/rules.def"
#undef PROBE_RULE
};

constexpr bool distinct_ids() {
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (kRules[i].id == kRules[j].id) return false;
    }
  }
  return true;
}
static_assert(distinct_ids(), "rules.def gives every rule an id of its own");

}  // namespace

std::span<const RuleInfo> all_rules() { return kRules; }

Failure plan_failure(Rule rule, std::string message, std::string where) {
  const std::string_view id = kRules[static_cast<std::size_t>(rule)].id;
  return {Fault::kPlan, std::move(message) + " [" + std::string(id) + "]", std::move(where)};
}

}  // namespace probe::plan
