#include "runtime/cli/full/notes.h"

#include "runtime/base/say.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {

int exit_of(const report::Benchmark& benchmark) {
  return benchmark.unborne == 0 ? kFine : kOutside;
}

void say_notes(std::span<const report::Note> notes) {
  for (const report::Note& note : notes)
    say("{}: {}\n", note.level == "note" ? "note" : "warning", note.text);
}

}  // namespace probe::cli
