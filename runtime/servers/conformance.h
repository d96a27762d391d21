// Does a connected server agree with us: shapes, ranges, rotation, gripper, chunks, sameness, time.
// Asks it a few known observations and says what its answers show, what they cannot show, and which
// fields of the profile would mend what is wrong. Runs no simulator.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/servers.h"

namespace probe::servers {

enum class Verdict {
  kFine,
  kUnclear,  // the answers cannot tell
  kWarning,  // works, and probably not as meant
  kWrong,
};

struct Check {
  std::string name;  // "connection", "answer", "chunk", "translation", "rotation", ...
  Verdict verdict = Verdict::kFine;
  std::string found;             // a sentence
  std::vector<std::string> fix;  // lines of a profile, or nothing
};

struct Conformance {
  std::string server;                // HOST:PORT
  std::string profile;               // its name
  std::vector<std::string> remarks;  // what the server said of itself
  std::vector<Check> checks;
  int queries = 0;
  double connect_s = 0, first_s = 0, median_s = 0, slowest_s = 0;  // of answers; 0: none came

  bool is_wrong() const;
};

// Bounded by the profile's time limits. A server that cannot be reached or fails is a finding, not
// a Failure; that (kUsage) is what make_transport refuses.
Result<Conformance> test_server(const ServerChoice& choice);

// What a list of answers shows; the part of test_server without a wire. `chunks` are the answers to
// different observations at the beginning of an episode with the gripper open, in order.
std::vector<Check> judge_answers(const Profile& profile,
                                 const std::vector<std::vector<RawAction>>& chunks,
                                 const KnownArm& arm = {});

std::string_view to_word(Verdict verdict);
std::string to_text(const Conformance& conformance);
// An object {server, profile, queries, connect_s, first_s, median_s, slowest_s, remarks[],
// checks[{name, verdict, found, fix[]}]}; verdicts are fine, unclear, warning, wrong.
std::string to_json(const Conformance& conformance);

}  // namespace probe::servers
