// The manual page, from what the help says.
#pragma once

#include <string>

#include "runtime/cli/arguments.h"

namespace probe::cli {

// vlaprobe(1) in man's macros, every verb with its options.
std::string manual_page(const VerbText& program, const std::string& version);

// The verbs as a table of Markdown: what documents have.
std::string verb_table(const VerbText& program);

}  // namespace probe::cli
