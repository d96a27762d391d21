// Runs the program as a user would, in a folder of its own that is removed afterwards.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace probe::test {

struct Outcome {
  int exit = -1;
  std::string out, err;
};

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void write_file(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

class Sandbox {
 public:
  Sandbox() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "vlaprobe-test-XXXXXX").string();
    dir_ = mkdtemp(pattern.data());
  }
  ~Sandbox() {
    std::error_code ignored;
    std::filesystem::remove_all(dir_, ignored);
  }
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return dir_ / name; }

  // `arguments` as typed in a shell; $SUITE and $ASSETS are set, and `more` as in "A=1 B=2".
  Outcome vlaprobe(const std::string& arguments, const std::string& more = "") const {
    return run(more + " '" VLAPROBE_BINARY_DIR "/vlaprobe' " + arguments);
  }
  // Another line of a shell.
  Outcome run(const std::string& line) const {
    const std::string command = "cd '" + dir_.string() +
                                "' && SUITE='" VLAPROBE_SOURCE_DIR
                                "/suite/intact.probe' ASSETS='" VLAPROBE_SOURCE_DIR "/assets' && " +
                                line + " >.out 2>.err </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, read_file(dir_ / ".out"),
            read_file(dir_ / ".err")};
  }

 private:
  std::filesystem::path dir_;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace probe::test
