// The expert in one start of a task, from its reset to the verdict.
#pragma once

#include <doctest/doctest.h>

#include "runtime/expert/expert.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/stage.h"

namespace probe::stage {

// Whether it makes the task's success; `plan` is the stage's.
inline bool solves(Stage& stage, const plan::Plan& plan, std::uint32_t start) {
  const auto expert = expert::make_expert({});
  REQUIRE(expert.ok());
  REQUIRE(stage.reset(start).ok());
  const Status begun = (*expert)->begin(stage.introduction());
  REQUIRE_MESSAGE(begun.ok(), (begun.ok() ? "" : to_text(begun.failure())));
  while (!stage.done()) {
    const auto seen = stage.observe();
    REQUIRE(seen.ok());
    const auto action = (*expert)->act(*seen);
    REQUIRE_MESSAGE(action.ok(), (action.ok() ? "" : to_text(action.failure())));
    const Status stepped = stage.step(*action);
    REQUIRE_MESSAGE(stepped.ok(), (stepped.ok() ? "" : to_text(stepped.failure())));
  }
  const auto success = plan.find_metric(plan.tasks()[stage.task()], "success");
  REQUIRE(success.has_value());
  return stage.judge().truth(*success);
}

}  // namespace probe::stage
