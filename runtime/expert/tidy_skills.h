// What a list of skills does not say and whoever does one after another has to see to.
#pragma once

#include <vector>

#include "runtime/policy/policy.h"

namespace probe::expert {

// Things that are put on one object get places of their own on it; what is picked to be put is not
// let go in between.
std::vector<policy::Skill> tidied(const policy::Privileged& view,
                                  std::vector<policy::Skill> skills);

// Whether a put leaves room for what a later one puts on the same object.
bool is_shared(const std::vector<policy::Skill>& skills, std::size_t put);

}  // namespace probe::expert
