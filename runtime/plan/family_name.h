// What families of questions are called, by whoever shows or names them: "SET.FAMILY". Header only.
#pragma once

#include <string>
#include <string_view>

#include "runtime/plan/plan.h"

namespace probe::plan {

inline std::string family_name(std::string_view set, std::string_view family) {
  return std::string(set) + "." + std::string(family);
}

// "understanding.source"
inline std::string family_name(const Plan& plan, const FamilyRecord& family) {
  return family_name(plan.text(family.set), plan.text(family.name));
}

// Whether a family is meant by "source", which several sets may have, or by "understanding.source".
inline bool is_called(const Plan& plan, const FamilyRecord& family, std::string_view name) {
  return name == plan.text(family.name) || name == family_name(plan, family);
}

}  // namespace probe::plan
