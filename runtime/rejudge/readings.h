// One run read under several scoring rules: the suites of a plan, each a rule. Every trace is read
// once.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/rejudge/changes.h"
#include "runtime/store/not_attempted.h"

namespace probe::rejudge {

struct TaskReading {
  std::string task;  // the stored name
  std::vector<MetricChange> metrics;
};

struct Reading {
  std::string suite;
  int valid = 0, invalid = 0;
  store::NotAttempted not_attempted;  // among neither
  std::vector<MetricChange> metrics;
  std::vector<TaskReading> tasks;     // in the stored order
  std::vector<std::string> left_out;  // stored tasks that the suite does not judge
};

// The suites of `plan` that match one of the globs, in the plan's order; those that judge none of
// the stored tasks are passed over. Fails (kUsage) when no suite matches or judges anything,
// and where rejudge() does.
Result<std::vector<Reading>> read_under(const std::string& dir, const plan::Plan& plan,
                                        std::span<const std::string> suites,
                                        const std::string& tasks = "*");

}  // namespace probe::rejudge
