// What tests of policy servers' clients share: a small picture to ask with, a policy by its URL,
// and the file in which a server writes down what it was sent.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "runtime/policy/policy.h"
#include "runtime/run/policies.h"
#include "tests/servers/python_server.h"

namespace probe::servers {
using namespace probe::run;
using namespace probe::policy;

struct AskingPicture {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(8 * 6 * 3, 7);
  Observation observation(int step = 0) {
    Observation seen;
    seen.image = {8, 6, bytes};
    seen.prompt = "put carrot on plate";
    seen.step = step;
    return seen;
  }
};

inline std::unique_ptr<Policy> policy_at(const std::string& protocol,
                                         const test::PythonServer& server,
                                         const std::string& options = "") {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's packages of .ci/packages.txt are installed");
  auto policy =
      make_policy(protocol + "://127.0.0.1:" + server.port() + "?timeout.wait_s=0.05" + options);
  REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
  return std::move(policy).value();
}

inline EpisodeStart asking_start() {
  EpisodeStart start;
  start.task = "carrot_on_plate";
  start.prompt = "put carrot on plate";
  start.index = 3;
  start.seed = 42;
  return start;
}

inline Action must_act(Policy& policy, const Observation& seen) {
  const auto action = policy.act(seen);
  REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
  return *action;
}

inline void must_begin(Policy& policy) {
  const auto begun = policy.begin(asking_start());
  REQUIRE_MESSAGE(begun.ok(), to_text(begun.failure()));
}

// Lines that a server with `record=` writes; gone with this object.
class ServerRecord {
 public:
  ServerRecord() {
    static int made = 0;
    path_ = (std::filesystem::temp_directory_path() /
             ("vlaprobe_asked_" + std::to_string(getpid()) + "_" + std::to_string(++made)))
                .string();
    std::filesystem::remove(path_);
  }
  ~ServerRecord() { std::filesystem::remove(path_); }
  std::string option() const { return "record=" + path_; }
  std::vector<std::string> lines() const {
    std::ifstream file(path_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }

 private:
  std::string path_;
};

}  // namespace probe::servers
