// A campaign as its test calls it.
#pragma once

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace probe::test {

// Whether it ended with 0, and what it said. `words` are of a shell.
inline std::pair<bool, std::string> campaign(const std::string& name, const std::string& words) {
  const std::string said = name + ".txt";
  const int status = std::system((words + " >" + said + " 2>&1").c_str());
  std::ifstream in(said);
  std::stringstream text;
  text << in.rdbuf();
  return {status == 0, text.str()};
}

}  // namespace probe::test
