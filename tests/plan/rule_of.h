// Which rule of rules.def a refusal names.
#pragma once

#include <string>
#include <string_view>

#include "runtime/plan/rules.h"

namespace probe::plan {

// Null for failures that are no refusal of the verifier.
inline const RuleInfo* rule_of(const Failure& failure) {
  const std::string& text = failure.message;
  const std::size_t open = text.rfind('[');
  if (failure.code != Fault::kPlan || open == std::string::npos || !text.ends_with(']'))
    return nullptr;
  const std::string_view id = std::string_view(text).substr(open + 1, text.size() - open - 2);
  for (const RuleInfo& info : all_rules()) {
    if (info.id == id) return &info;
  }
  return nullptr;
}

}  // namespace probe::plan
