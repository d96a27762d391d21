// The benchmark's own folder, imported for one test.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "runtime/libero/import.h"
#include "tests/runtime/libero/reference.h"

namespace probe::test {

// An import of it in a folder of its own under the temporary one; `name` tells tests apart.
inline std::filesystem::path imported_reference(const std::string& name,
                                                const std::string& poses = {}) {
  const auto to = std::filesystem::temp_directory_path() /
                  ("vlaprobe_libero_" + name + "_" + std::to_string(getpid()));
  std::filesystem::remove_all(to);
  libero::ImportOptions options;
  options.from = reference();
  options.to = to.string();
  options.poses = poses;
  options.own = VLAPROBE_SOURCE_DIR "/assets";
  const auto imported = libero::import_libero(options);
  REQUIRE_MESSAGE(imported.ok(), to_text(imported.failure()));
  return to;
}

}  // namespace probe::test
