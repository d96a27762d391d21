// Diagnostics for people: the code and message, the source as written, carets and dashes, helps.
#pragma once

#include <string>

#include "compiler/diag/diagnostic.h"

namespace probe {

struct TextStyle {
  bool colour = false;  // ANSI escapes; the caller decides (terminal, NO_COLOR)
};

// Ends with a newline. Tabs, wide and control characters of the source are shown so that carets
// stay aligned and the terminal is safe; very long lines are cut around the place that matters.
std::string render_text(const Diagnostic& diagnostic, const SourceSet& sources,
                        TextStyle style = {});
// All of them in source order with an empty line between.
std::string render_text(const Diagnostics& diagnostics, const SourceSet& sources,
                        TextStyle style = {});

}  // namespace probe
