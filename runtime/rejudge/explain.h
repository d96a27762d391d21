// `vlaprobe why`: each metric of a stored episode with its value, the step that decided it, and the
// source lines of its predicate with what was measured then.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/store/trace.h"

namespace probe::rejudge {

// One comparison or one memory ("for 5 steps") inside a predicate.
struct Condition {
  std::string file;      // empty when the plan has no sources
  std::size_t line = 0;  // one-based
  std::string text;      // as written; the instruction's name without sources
  std::string bodies;    // whose measurements it compares: "carrot, surface"
  std::string measured;  // "3.1cm <= 2cm"
  bool truth = false;
  bool is_number = false;  // no condition but the value of a metric: `truth` says nothing
  bool decides = true;     // the predicate is what it is because of this one, perhaps with others
  int alike = 0;           // further ones of the same text and truth that are not listed
};

struct MetricWhy {
  std::string name;
  bool is_bool = true;
  double value = 0;
  std::string shown;    // the value with its unit: "true", "91.2cm", "14"
  std::string readout;  // "at end", "once", ...
  int step = 0;         // that decides, one-based; 0 when there was none
  std::string when;     // "at step 60", "since step 14", "never, nearest at step 41"
  std::string file;     // of the metric's line, as above
  std::size_t line = 0;
  std::string text;
  std::string statement;  // of that line, the metric's own part: "highest = max height(o)"
  std::vector<Condition> conditions;
};

// Judges the trace again as `task` of `plan`, step by step. Fails where rescore() does, and when
// `metric` is not empty and not one of the task's (kUsage).
Result<std::vector<MetricWhy>> explain(const plan::Plan& plan, std::uint32_t task,
                                       const store::Trace& trace, const std::string& metric = {});

// What the instruction says of places, at the settled start.
struct ClaimWhy {
  std::string text, object;          // the words and what they mean
  std::vector<std::string> denoted;  // what they denote there
  bool holds = false;                // `object` alone
};

struct EpisodeWhy {
  std::string task;
  int episode = 0, seed = 0, steps = 0;
  std::optional<std::string> invalid;
  std::optional<std::string> remark;  // of the policy
  std::vector<ClaimWhy> claims;
  std::vector<MetricWhy> metrics;
};

// The same of a stored episode, under the plan of its folder. Without `seed`: the lowest.
Result<EpisodeWhy> why(const std::string& dir, const std::string& task, int episode,
                       std::optional<int> seed, const std::string& metric = {});

}  // namespace probe::rejudge
