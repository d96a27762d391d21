// Where the benchmark's own files and what was recorded of it lie, if they do.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace probe::test {

inline std::string reference() {
  const char* elsewhere = std::getenv("VLAPROBE_REFERENCE");
  const std::string root =
      elsewhere != nullptr ? elsewhere : VLAPROBE_SOURCE_DIR "/../shared/reference";
  return root + "/libero/";
}

inline bool has_reference() {
  std::error_code error;
  return std::filesystem::is_regular_file(reference() + "libero_tasks.json", error);
}

}  // namespace probe::test
