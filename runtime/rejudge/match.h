// Which task and episode of a plan stands for a stored episode, and why none does. Knows nothing of
// traces' content.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/store/results.h"

namespace probe::rejudge {

struct Match {
  std::uint32_t task = 0;     // of the judging plan
  std::uint32_t episode = 0;  // within that task
};

// The one of `candidates` (indices of plan.tasks()) that is called `name`; else the one that is
// compared with the task of that name and differs from it in nothing but what it judges (axis
// `goal`, or no axis): so a suite of variants reads the rollouts of their baselines. Nothing if
// there is none; fails (kUsage) if there are several.
Result<std::optional<std::uint32_t>> find_judge(const plan::Plan& plan,
                                                std::span<const std::uint32_t> candidates,
                                                const std::string& name);

// The task's episode that begins as the stored one did: the one of the same index, which must have
// an equal start id. Fails (kUsage) saying which part of the start differs, as far as
// `recorded`, the plan that the row was made with, tells.
Result<Match> match_start(const plan::Plan& plan, std::uint32_t task, const store::ResultRow& row,
                          const plan::Plan& recorded);

}  // namespace probe::rejudge
