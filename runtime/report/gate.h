// May this policy take the place of that one? A verdict for other programs: worse only where the
// data show a drop beyond what is allowed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/report/benchmark.h"

namespace probe::report {

struct GateOptions {
  std::string metric = "success";
  double allow = 0;               // the drop that is allowed, a share (0 to 1) of the episodes
  double error = 0.05;            // the chance of calling an allowed drop one too many
  bool categories = false;        // each of the categories is held to it, too
  std::vector<std::string> sets = {};  // of the plan that are the categories
};

enum class Verdict : std::uint8_t { kWorse, kNotWorse, kUndecided };
std::string_view to_text(Verdict verdict);  // "worse", "not worse", "undecided"

// What is held to the limit: all tasks, or a category.
struct GateRow {
  std::string name;
  std::int64_t starts = 0, episodes = 0;  // that both have a verdict of
  std::int64_t now = 0, before = 0;       // in how many the metric was true
  double drop = 0;                        // how much worse it is now, a share of the episodes
  double low = -1, high = 1;              // bounds of the drop, 1 - error sure
  double p = 1;                           // of a drop that is allowed; adjusted after Holm
  Verdict verdict = Verdict::kUndecided;
};

struct Gate {
  GateOptions options;
  std::string now, before;          // policies
  bool lower_is_better = false;     // of the metric: a drop is then a rise
  std::vector<GateRow> rows;        // all tasks first
  std::vector<std::string> notes;   // partial runs, rows that were left out
  std::size_t unborne = 0;          // rows that their traces do not bear
  bool is_worse() const;            // of all tasks, or of a category that is held to it
  bool is_decided() const;          // no row that is held to it is undecided
};

// Policy 0 of the benchmark against policy 1. A start, with its seeds, is one outcome: its part of
// episodes now less before. Worse where the evidence by betting (stats/betting.h) against "the drop
// is allowed" is at least 1 / error, not worse where that against "the drop is more than is allowed"
// is. Fails (kUsage) when the metric is not there or neither more nor less of it is better, when the
// two share no valid episode, and when in their invalid ones a drop beyond the limit may hide.
Result<Gate> gate(const Benchmark& benchmark, const GateOptions& options);

// Two folders. Rows that their traces do not bear are in no number, and a note names them. Fails
// (kUsage) on one folder twice and on a model's answers as well, and as load() does.
Result<Gate> gate_folders(const std::string& now, const std::string& before,
                          const GateOptions& options);

std::string to_text(const Gate& gate);
std::string to_markdown(const Gate& gate);
std::string to_junit(const Gate& gate);
Json to_json(const Gate& gate);

}  // namespace probe::report
