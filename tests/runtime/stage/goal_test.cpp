// The goal of a task, asked of its judge alone.
#include "runtime/stage/goal.h"

#include <doctest/doctest.h>

#include "tests/parity/published.h"

using namespace probe;

TEST_CASE("of the published tasks one asks for the source to be away from the target") {
  const plan::Plan& plan = test::suite_plan();
  std::size_t away = 0;
  for (std::uint32_t task = 0; task < plan.tasks().size(); ++task) {
    const auto goal = stage::goal_of(plan, task);
    REQUIRE(goal.ok());
    if (*goal != policy::Goal::kAway) continue;
    ++away;
    CHECK(plan.text(plan.tasks()[task].name) == "carrot_on_plate_lang_neg_action");
  }
  CHECK(away == 1);
}
