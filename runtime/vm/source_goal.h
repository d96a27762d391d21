// What success asks of the source alone, and whether anything is found that makes it: the judge is
// asked about made-up worlds, no word of the instruction is read.
#pragma once

#include <cstdint>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::vm {

enum class SourceGoal : std::uint8_t {
  kOther,     // none of these
  kOnTarget,  // it lies on the target, let go
  kAway,      // that is no success, and it is one when it is held far from there
  kLifted,    // without a target: it is held above its start
  kNothing,   // joints of fixtures begin in this start so that it is success, and in others not
};
Result<SourceGoal> source_goal(const plan::Plan& plan, std::uint32_t task, std::uint32_t start = 0);

// Whether there is anything for a policy of skills to try: the text says a solution, one can be
// derived in each kind of start, or the source goes somewhere.
Result<bool> has_skills(const plan::Plan& plan, std::uint32_t task);

}  // namespace probe::vm
