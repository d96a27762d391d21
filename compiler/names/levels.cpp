// The limit of names that stand for further names.
#include "compiler/names/context.h"

namespace probe::sema {

void report_levels(Diagnostics& diagnostics, const Span& name) {
  diagnostics.report(Code::P0103, name,
                     "found more than " + std::to_string(kMaxLevels) +
                         " levels in one another, through the names used here");
}

}  // namespace probe::sema
