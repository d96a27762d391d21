// examples/learn: demonstrations, a policy that learnt from them for some seconds, served and evaluated.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "doctest/doctest.h"

namespace {

namespace fs = std::filesystem;

TEST_CASE("what learnt from exported demonstrations is served, and does to pictures what it did when it was evaluated") {
  std::string folder = (fs::temp_directory_path() / "vlaprobe-learn-XXXXXX").string();
  REQUIRE(mkdtemp(folder.data()) != nullptr);
  const std::string command = "/usr/bin/python3 " VLAPROBE_SOURCE_DIR
                              "/tests/examples/learn.py " VLAPROBE_BINARY_DIR "/vlaprobe " +
                              folder + " 2>&1";
  FILE* const pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string said;
  for (std::array<char, 256> part = {}; fgets(part.data(), part.size(), pipe) != nullptr;)
    said += part.data();
  const int status = pclose(pipe);
  fs::remove_all(folder);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) {
    MESSAGE("SKIPPED: " << said << "; python3-torch and python3-h5py are not both installed, so nothing learnt");
    return;
  }
  CHECK_MESSAGE(status == 0, said);
  CHECK(said == "rotation\ntold\nlabelled\nvalid\nsame\n");
}

}  // namespace
