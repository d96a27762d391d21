// A program of Node's that looks at a page in Chromium, and what it said.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace probe::test {

struct NodeOutcome {
  int status = -1;  // 0: all is as it should be
  std::string words;
};

// `arguments` as a shell reads them; ended after `seconds`.
inline NodeOutcome run_node(const std::string& program, const std::string& arguments,
                            int seconds = 180) {
  const std::string command = "timeout " + std::to_string(seconds) + " node '" +
                              VLAPROBE_SOURCE_DIR "/" + program + "' " + arguments + " 2>&1";
  NodeOutcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.words.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

// Whether the sources of a page have the types that they claim; else what is wrong.
inline std::string check_types(const std::string& page) {
  const std::string packages = VLAPROBE_BINARY_DIR "/report_page/node_modules";
  const std::string command = "cd '" + packages + "' && node typescript/bin/tsc -p '" +
                              VLAPROBE_SOURCE_DIR "/" + page + "/tsconfig.json' --baseUrl '" +
                              packages + "' 2>&1";
  std::string words;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "node is not there";
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    words.append(buffer.data(), n);
  return pclose(pipe) == 0 ? "" : "types are wrong: " + words;
}

}  // namespace probe::test
