// A program started by a shell, and what it said.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace probe::test {

struct ShellOutcome {
  int status = -1;    // 0: all is as it should be; -1: it did not end by itself
  std::string words;  // on both of its outputs
};

inline ShellOutcome run_shell(const std::string& command) {
  ShellOutcome outcome;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.words.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

}  // namespace probe::test
