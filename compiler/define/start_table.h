// `starts "file.csv"`: the starts of a layout as a table, a row for each object of each start.
#pragma once

#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// By start; a start has both, either of which may be empty.
struct GivenStarts {
  std::vector<std::vector<GivenPlace>> places;
  std::vector<std::vector<GivenJoint>> joints;
};
// The rows of `stmt`'s file by start. Every mistake of the file is reported at its line; then, and
// where the file could not be read, nothing is given back.
GivenStarts read_start_table(Context& context, const syntax::StartsStmt& stmt);

}  // namespace probe::sema
