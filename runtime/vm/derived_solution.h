// A solution where the text says none: what has to be done is found by asking the judge about
// made-up worlds in which it is done. No word of the instruction is read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::vm {

// The skills that make success together, none of which could be left out, in the order in which
// they can be done: a part that something is put into is opened before, and closed after where it
// shall be closed. Of objects put on, in or beside one place, of parts opened, closed and turned;
// of two objects that are put to two places or in one order. Empty where no such bundle makes
// success, and where nothing has to be done. Of one start of the task: what is open in one may be
// closed in another.
Result<std::vector<plan::SkillRecord>> derive_solution(const plan::Plan& plan, std::uint32_t task,
                                                       std::uint32_t start = 0);

// What is amiss with the skills that the task's text says, by the same made-up worlds: they put
// something into what is closed, or `success` is not true when they are done, where other skills
// would make it so. Empty where nothing is amiss, where the text says none, and where it cannot be
// told: of what is pressed, pushed or held at the end. Of the first kind of start in which it is
// so.
Result<std::string> flaw_of_solution(const plan::Plan& plan, std::uint32_t task);

// Skills that are done when what ends an episode (`ends when`) holds, while others, without which
// `success` is not true, are still to be done.
struct EarlyEnd {
  std::uint32_t start = 0;  // the first of the kind of starts in which it is so
  std::vector<plan::SkillRecord> done, left;
};
// By the same made-up worlds: of the skills that the text says, in their order, or of those that
// are derived, whichever is done first. None where an episode can come to success, where nothing
// ends it, where it is over as it begins, and where it cannot be told.
Result<std::optional<EarlyEnd>> early_end(const plan::Plan& plan, std::uint32_t task);

// Whether the task is solved by putting two things somewhere, as its text says or as is derived,
// and success is true whichever of them is put first, in some kind of start.
Result<bool> holds_in_either_order(const plan::Plan& plan, std::uint32_t task);

}  // namespace probe::vm
