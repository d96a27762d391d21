// What the statements of a task say.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// Fields of the task, in the order of the text; phrases and drawn distractors last, as they depend
// on who has a role. `poisoned` tasks have a statement that was reported; what follows from them is
// not said again.
void read_statements(Context& context, const DeclaredTask& declared, Task& task, bool& poisoned);

}  // namespace probe::sema
