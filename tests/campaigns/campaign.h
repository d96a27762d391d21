// A campaign as its test calls it.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>
#include <utility>

namespace probe::test {

// Whether it ended with 0, and what it said. `words` are of a shell.
inline std::pair<bool, std::string> campaign(const std::string& words) {
  std::FILE* const pipe = popen((words + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {false, "cannot be started"};
  std::string said;
  char block[4096];
  while (const std::size_t size = std::fread(block, 1, sizeof block, pipe))
    said.append(block, size);
  const int status = pclose(pipe);
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, said};
}

}  // namespace probe::test
