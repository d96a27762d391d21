// The goal of a task, asked of its judge alone.
#include "runtime/stage/goal.h"

#include <doctest/doctest.h>

#include "compiler/emit/compile.h"
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

TEST_CASE("what asks for a drawer to be open asks for nothing that a thing on a plate would be") {
  const std::string root = VLAPROBE_SOURCE_DIR;
  const std::vector<std::string> files = {root + "/examples/drawer.probe"};
  auto built = build(
      files,
      {.asset_root = root + "/assets", .suite = "", .library_folders = {root + "/dsl", root}});
  REQUIRE(built.ok());
  REQUIRE(built->ok);
  const auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE(plan.ok());
  for (const char* name : {"open_drawer", "drawer_ajar"}) {
    const auto task = plan->find_task(name);
    REQUIRE(task);
    const auto goal = stage::goal_of(*plan, *task);
    REQUIRE(goal.ok());
    CHECK(*goal == policy::Goal::kOther);
  }
}

TEST_CASE("every published task asks for what one source is moved for") {
  const plan::Plan& plan = test::suite_plan();
  for (std::uint32_t task = 0; task < plan.tasks().size(); ++task) {
    CAPTURE(std::string(plan.text(plan.tasks()[task].name)));
    const auto goal = stage::goal_of(plan, task);
    REQUIRE(goal.ok());
    CHECK(*goal != policy::Goal::kOther);
  }
}
