// `vlaprobe judge`: the stored episodes of a folder under another plan's metrics.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/rejudge/changes.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/results.h"

namespace probe::rejudge {

struct RejudgeOptions {
  std::string suite;        // whose tasks judge; empty: all tasks of the plan
  std::string tasks = "*";  // glob over the stored task names
  std::string out;          // folder for the new results and traces; empty: none is written
};

struct RejudgeReport {
  std::vector<store::ResultRow> rows;  // as judged now, in the stored order
  std::vector<MetricChange> metrics;   // the stored plan's, then those that are new
  int valid = 0, invalid = 0;
  store::NotAttempted not_attempted;  // among neither
  std::vector<std::string> left_out;  // stored tasks that the plan does not judge
  bool same_plan = false;             // judged under the plan they were made with
};

// Refuses (kUsage) the whole folder if an episode of a judged task began at another start,
// with another instruction or at another rate than the plan says; nothing is written then.
Result<RejudgeReport> rejudge(const std::string& dir, const plan::Plan& plan,
                              const RejudgeOptions& options = {});

}  // namespace probe::rejudge
