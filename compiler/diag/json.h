// Diagnostics for programs. Keys may be added, never changed.
#pragma once

#include <string>

#include "compiler/diag/diagnostic.h"

namespace probe {

// An array of {code, severity, message, file, line, column, end_line, end_column, labels[], fix,
// label, helps[], notes[]}. Lines and columns count from 1, columns in characters, ends are
// exclusive. A label is {message, file, line, column, end_line, end_column}; fix is null or
// {message, replacements: [{file, begin, end, line, column, end_line, end_column, text}]} with
// begin and end in bytes. `file` is null for a diagnostic about no place.
std::string render_json(const Diagnostics& diagnostics, const SourceSet& sources);

}  // namespace probe
