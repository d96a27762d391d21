// Where `use "std/..."` finds the standard library.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::compile {

// The folders that hold `std/`: `chosen` if not empty, else the environment's VLAPROBE_STD, else
// `dsl` beside the folder of the program (or of our library, in somebody else's program), else that
// of the source tree it was built from; empty when there is none. Fails (kUsage) when a place that
// somebody named has no `std/`.
Result<std::vector<std::string>> find_library_folders(std::string_view chosen = {});

}  // namespace probe::compile
