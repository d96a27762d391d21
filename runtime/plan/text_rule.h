// What every text of a plan is, said once for the compiler and for the verifier.
#pragma once

#include <string_view>

namespace probe::plan {

// Null when `text` is UTF-8 in normal form C without control characters, else what it is instead:
// "holds a control character".
const char* find_text_defect(std::string_view text);

}  // namespace probe::plan
