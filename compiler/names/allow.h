// From what the passes found to what is said: @allow silences, and the same said of many tasks at
// one place is said once.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// P0208 for a word that nothing can be allowed by, P0304 for a reason that a plan cannot hold.
void check_allows(const std::vector<const syntax::File*>& files, Diagnostics& diagnostics);

// What is said of one task holds for so many more.
void note_more(Diagnostic& said, std::size_t tasks);

// Moves the diagnostics of `context` to `out`. `roots`: the files in which an idle @allow is worth
// a word. `lacks_names`: some declarations could not be read, so their names are not known.
void say(const Context& context, std::span<const FileId> roots, bool lacks_names, Diagnostics& out);

}  // namespace probe::sema
