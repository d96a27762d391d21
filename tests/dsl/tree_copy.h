// The .probe files of the tree in a folder of their own, where a test may change them.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"

namespace probe::test {

namespace fs = std::filesystem;

inline std::string read_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline void overwrite(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

class TreeCopy {
 public:
  TreeCopy() {
    std::string pattern = (fs::temp_directory_path() / "probe_tree_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    for (const char* part :
         {"suite", "suite/kitchen", "suite/google", "suite/google/starts", "examples", "dsl/std"}) {
      fs::create_directories(folder_ / part);
      for (const auto& entry : fs::directory_iterator(fs::path(VLAPROBE_SOURCE_DIR) / part)) {
        const fs::path copy = folder_ / part / entry.path().filename();
        const fs::path kind = entry.path().extension();
        if (kind == ".probe" || kind == ".csv")
          fs::copy_file(entry.path(), copy);  // tables of starts
        if (kind == ".probe") files_.push_back(copy);
      }
    }
    std::sort(files_.begin(), files_.end());
  }
  ~TreeCopy() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  TreeCopy(const TreeCopy&) = delete;
  TreeCopy& operator=(const TreeCopy&) = delete;

  const fs::path& folder() const { return folder_; }
  const std::vector<fs::path>& files() const { return files_; }

  CompileOptions options() const {
    return {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
            .suite = "",
            .library_folders = {(folder_ / "dsl").string()}};
  }
  Compilation compile(const fs::path& file) const {
    const std::string name = file.string();
    auto built = build(std::span<const std::string>(&name, 1), options());
    REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
    return std::move(built).value();
  }

 private:
  fs::path folder_;
  std::vector<fs::path> files_;
};

}  // namespace probe::test
