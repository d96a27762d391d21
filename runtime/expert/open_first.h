// What begins in a closed drawer is taken out of an open one.
#pragma once

#include <vector>

#include "runtime/policy/policy.h"

namespace probe::expert {

// The skills with an opening before them where the first thing that they take lies, as the episode
// begins, within a part that is less than half open and that no skill moves before. Where there are
// no skills, those of the goal: the source put on the target, or picked. As they were where nothing
// is closed about it.
std::vector<policy::Skill> opened_first(const policy::Privileged& view,
                                        std::vector<policy::Skill> skills);

}  // namespace probe::expert
