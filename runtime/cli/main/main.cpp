// The program `vlaprobe`. Verbs that need the compiler alone run here and start in a few
// milliseconds; for everything else it becomes `vlaprobe-full` beside it, whose libraries take ten
// times as long to load.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "runtime/base/own_folder.h"
#include "runtime/cli/app.h"

int main(int argc, char** argv) {
  using namespace probe;
  const int exit = cli::run_program(
      argc, argv,
      [](cli::Verb program, int& status) { cli::add_text_verbs(program, status, nullptr); }, false);
  if (exit != cli::kHandOver) return exit;
  const std::string full = (folder_of_program() / "vlaprobe-full").string();
  // A copy of this program under that name would go on starting itself.
  if (std::getenv(cli::kHandedOver) != nullptr) {
    return cli::report({Fault::kIo, "is the program without the other verbs", full});
  }
  setenv(cli::kHandedOver, "1", 1);
  execv(full.c_str(), argv);
  return cli::report({Fault::kIo, std::string("cannot be started: ") + std::strerror(errno), full});
}
