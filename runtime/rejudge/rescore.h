// One stored trace under a plan's metrics: the judge runs over the recorded measurements. No
// physics, no policy, no pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/store/trace.h"
#include "runtime/vm/judge.h"

namespace probe::rejudge {

struct Rescored {
  // After each judged step, by metric of the plan's task.
  std::vector<std::vector<double>> steps;
  // After the last one; of no meaning when invalid.
  std::vector<store::MetricValue> metrics;
  std::optional<std::string> invalid;  // as recorded, or because a metric was not finite
};

// Judges the first `horizon` steps of the trace as `task` of `plan`. Fails (kUsage) when what
// was measured is not what the task judges: other bodies, another control rate, another
// instruction, or fewer steps than the horizon without having been invalid.
Result<Rescored> rescore(const plan::Plan& plan, std::uint32_t task, const store::Trace& trace);

// The same refusals, without judging.
Status check_measures(const plan::Plan& plan, std::uint32_t task, const store::Trace& trace);

}  // namespace probe::rejudge
