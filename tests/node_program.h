// A program of Node's that looks at a page in Chromium, and what it said.
#pragma once

#include <string>

#include "tests/shell_program.h"

namespace probe::test {

// `arguments` as a shell reads them; ended after `seconds`.
inline ShellOutcome run_node(const std::string& program, const std::string& arguments,
                             int seconds = 180) {
  return run_shell("timeout " + std::to_string(seconds) + " node '" + VLAPROBE_SOURCE_DIR "/" +
                   program + "' " + arguments);
}

// Whether the sources of a page have the types that they claim; else what is wrong.
inline std::string check_types(const std::string& page) {
  const std::string packages = VLAPROBE_BINARY_DIR "/report_page/node_modules";
  const std::string command = "cd '" + packages + "' && node typescript/bin/tsc -p '" +
                              VLAPROBE_SOURCE_DIR "/" + page + "/tsconfig.json' --baseUrl '" +
                              packages + "'";
  const auto [status, words] = run_shell(command);
  return status == 0 ? "" : "types are wrong: " + words;
}

}  // namespace probe::test
