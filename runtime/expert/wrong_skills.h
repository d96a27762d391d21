// A solution done with the wrong things: what tells a judge that looks from one that does not.
#pragma once

#include <vector>

#include "runtime/policy/policy.h"

namespace probe::expert {

// The solution with its first object exchanged for the one of `role` (as Privileged::object_of()
// counts). Where the task's wrong things are parts, with each part exchanged for one of these, by
// preference one that moves the same way: the middle drawer for the top one; a solution about
// objects alone becomes the opening of the wrong part. Where it is about parts alone and the task
// names no wrong one, each is exchanged for the next that moves the same way. Empty where there is
// nothing to exchange.
std::vector<policy::Skill> wrong_skills(const policy::Privileged& view, int role);

}  // namespace probe::expert
