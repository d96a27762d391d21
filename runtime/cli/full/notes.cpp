#include "runtime/cli/full/notes.h"

#include "runtime/base/say.h"

namespace probe::cli {

void say_notes(std::span<const report::Note> notes) {
  for (const report::Note& note : notes)
    say("{}: {}\n", note.level == "note" ? "note" : "warning", note.text);
}

}  // namespace probe::cli
