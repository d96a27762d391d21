// The verifier's rules as data, made from rules.def.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe::plan {

enum class Rule : std::uint8_t {
#define PROBE_RULE(name, id, statement) k##name,
#include "runtime/plan/rules.def"
#undef PROBE_RULE
};

struct RuleInfo {
  Rule rule;
  std::string_view id;
  std::string_view statement;
};

// All rules in the order of rules.def, which is that of Rule.
std::span<const RuleInfo> all_rules();

// How every refusal of the verifier reads: "message [rule-id]", kPlan.
Failure plan_failure(Rule rule, std::string message, std::string where);

}  // namespace probe::plan
