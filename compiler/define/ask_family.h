// One family of questions asked of one task: the words, the options, the right answer and what
// proves it; or why it is not asked.
#pragma once

#include "compiler/define/family_of_task.h"

namespace probe::sema {

// Adds to Model::asked. Nothing when at least one question came of it.
MayOmit ask_family(const FamilyOfTask& asked);

}  // namespace probe::sema
