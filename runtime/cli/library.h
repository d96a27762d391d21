// Where the program lies, and where `use "std/..."` finds the standard library.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::cli {

// In the environment of what the small program becomes, so that it does not become itself again.
inline constexpr const char* kHandedOver = "VLAPROBE_HANDED_OVER";

// Empty when the system does not say.
std::filesystem::path folder_of_program();

// The folders that hold `std/`: `chosen` if not empty, else the environment's VLAPROBE_STD, else
// `dsl` beside the program's folder, else that of the source tree it was built from; empty when
// there is none. Fails (kUsage) when a place that somebody named has no `std/`.
Result<std::vector<std::string>> find_library_folders(std::string_view chosen = {});

}  // namespace probe::cli
