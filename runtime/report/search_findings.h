// What a search's folder has found, as plain data: search.json read and checked, and what its
// rounds left out. Everything that shows or compares searches takes this.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/stats/intervals.h"

namespace probe::report {

// Of a boundary: one way along one axis. Values are in `unit`.
struct Tolerance {
  std::string axis, side, status, unit, sentence;
  bool up = true;
  double own = 0, end = 0, last_fair = 0;
  // Where success has fallen to half, and an interval of 95 %; `near` is the end towards `own`. Of
  // the statuses `found` and `undecided` alone.
  std::optional<double> at, near, far;
  int trials = 0, left_out = 0;
  stats::Count own_success;

  bool is_found() const { return status == "found"; }
  std::string text_of(double value) const;  // "x 0.31"
  std::string interval() const;             // "0.116 to 0.125", the smaller number first
  std::string in_words() const;             // "falls to half at 0.121", "stays above half to 0.9"
};

struct WorstCase {
  std::string name, text, sentence;
  double distance = 0, at_least = 0, p = 1;
  stats::Count failures;  // of fresh trials
  bool confirmed = false;
};

struct TriedSet {
  std::string text, verdict;
  stats::Count failures;
};

// Shares are those of an axis in parts: of the axis itself they are lower bounds.
struct AxisShare {
  std::string axis, side;
  bool matters = false;
  double p = 1, first = 0;
  stats::Interval first_interval, total_interval;
  stats::Count there, elsewhere;
};

struct PairShare {
  std::string a, b, side_a, side_b;
  bool named = false, tested = false, synergy = false;
  double p = 1;
  stats::Count both, only_a, only_b, neither;
};

// Points of all rounds that the compiler refused, wholly or in some starts, by the first word of
// what it said.
struct LeftOutReason {
  std::string code, example;
  int points = 0, in_part = 0;
};

struct SearchFindings {
  std::string folder, file, method, space, task, text_sha256, policy, policy_content;
  std::uint64_t seed = 0;
  double error = 0;
  bool proved = true, done = false;
  int trials = 0, episodes = 0, left_out = 0;
  std::optional<int> expert_starts, expert_unsolved, expert_not_attempted;
  std::vector<std::string> lines;  // as the search said it

  std::vector<Tolerance> sides;  // boundary
  stats::Count own_failures;     // worst
  std::vector<WorstCase> cases;
  std::string case_text, sentence;  // minimal
  std::vector<TriedSet> tried;
  stats::Count failures;  // axes
  std::vector<AxisShare> axes;
  std::vector<PairShare> pairs;

  std::vector<LeftOutReason> reasons;
  std::vector<std::string> notes;  // rounds that could not be read
  Json json;                       // the file
};

// Whether the folder is a search's: it has a search.json.

// Fails (kStore, where = the file) on what is no search's, naming the key that is missing or of
// another kind.
Result<SearchFindings> read_findings(const std::string& folder);

}  // namespace probe::report
