// The essay behind each code: what `vlaprobe explain` prints. Written in dsl/errors/, one Markdown
// file per code, and built in.
#pragma once

#include <string_view>

#include "compiler/diag/diagnostic.h"

namespace probe {

// Empty when nobody has written it, which a test forbids.
std::string_view essay(Code code);

}  // namespace probe
