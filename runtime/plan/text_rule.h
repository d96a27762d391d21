// What every text of a plan is, said once for the compiler and for the verifier.
#pragma once

#include <string_view>

namespace probe::plan {

// Null when `text` is UTF-8 in normal form C without control characters, else what it is instead:
// "holds a control character".
const char* find_text_defect(std::string_view text);

// Whether a path of an asset leads straight to a file below the root: without `.`, `..`, `\` and
// empty parts, so that one file has one path in every plan.
bool is_asset_path(std::string_view path);

}  // namespace probe::plan
