// What instructions say of places, judged where things have come to rest: a phrase is proved where
// they are put down, and what falls over or slides starts elsewhere.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/vm/sample.h"

namespace probe::vm {

struct ClaimVerdict {
  std::string_view text;               // the words; of the plan
  std::uint32_t body = 0;              // task-local: the object that they mean
  std::vector<std::uint32_t> denoted;  // those that they denote, ascending
  bool holds = false;                  // `body` alone
};

// Of every claim of the task, in the order of its words. `starts` and `settled` as a judge is told
// them before the first step. Fails (kJudge) as a judge does.
Result<std::vector<ClaimVerdict>> judge_claims(const plan::Plan& plan, std::uint32_t task,
                                               std::span<const BodyStart> starts,
                                               const StepSample& settled);

// Fails with the first claim that does not hold (kWorld), and says what is so instead, where.
Status check_claims(const plan::Plan& plan, std::uint32_t task, std::span<const BodyStart> starts,
                    const StepSample& settled);

}  // namespace probe::vm
