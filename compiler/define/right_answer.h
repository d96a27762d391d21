// What is right, and the options that it stands among, by the kind of answer that a family has.
#pragma once

#include "compiler/define/question_pool.h"
#include "compiler/define/question_text.h"

namespace probe::sema {

// Sets `question`'s options, `truth`, `right`, `a`, `b` and `recorded`; or says why the task has no
// such question. `bound`: what the family's `for` binds.
MayOmit find_right_answer(const FamilyOfTask& asked, const Referents& referents,
                          const QuestionText& text, const PoolReader& pools, ObjectId bound,
                          AskedQuestion& question);

}  // namespace probe::sema
