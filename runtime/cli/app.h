// The program: parses the line, runs one verb, says how it ended.
#pragma once

#include "runtime/cli/draw.h"

namespace probe::cli {

// In the environment of what the small program becomes, so that it does not become itself again.
inline constexpr const char* kHandedOver = "VLAPROBE_HANDED_OVER";

// The verbs of a program, added in the order in which --help lists them.
using AddVerbs = void (*)(Verb program, int& exit);

// Those that need no simulator.
void add_text_verbs(Verb program, int& exit, PhraseDrawing draw_phrases);

// The exit code. Where `is_whole` is false, anything but a verb that was added is kHandOver.
int run_program(int argc, char** argv, AddVerbs add_verbs, bool is_whole);

}  // namespace probe::cli
