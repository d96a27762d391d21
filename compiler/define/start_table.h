// `starts "file.csv"`: the starts of a layout as a table, a row for each object of each start.
#pragma once

#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// The rows of `stmt`'s file by start. Every mistake of the file is reported at its line; then, and
// where the file could not be read, nothing is given back.
std::vector<std::vector<GivenPlace>> read_start_table(Context& context,
                                                      const syntax::StartsStmt& stmt);

}  // namespace probe::sema
