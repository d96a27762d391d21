// From what the passes found to what is said: @allow silences, and the same said of many tasks at
// one place is said once.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// Moves the diagnostics of `context` to `out`. `roots`: the files in which an idle @allow is worth
// a word. `lacks_names`: some declarations could not be read, so their names are not known.
void say(const Context& context, std::span<const FileId> roots, bool lacks_names, Diagnostics& out);

}  // namespace probe::sema
