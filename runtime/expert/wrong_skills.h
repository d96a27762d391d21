// A solution done with the wrong things: what tells a judge that looks from one that does not.
#pragma once

#include <vector>

#include "runtime/policy/policy.h"

namespace probe::expert {

// The solution with its first object exchanged for the one of `role` (as Privileged::object_of()
// counts), and, where it is about parts alone, each part for the next that moves the same way: the
// middle drawer for the top one. Empty where there is nothing to exchange.
std::vector<policy::Skill> wrong_skills(const policy::Privileged& view, int role);

}  // namespace probe::expert
