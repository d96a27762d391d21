// The order of tasks, and what a file's name says.
#include "runtime/libero/suites.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

namespace probe::libero {

TEST_CASE("a file's name is the instruction without the scene") {
  CHECK(instruction_of("turn_on_the_stove") == "turn on the stove");
  CHECK(instruction_of("KITCHEN_SCENE10_close_the_top_drawer_of_the_cabinet") ==
        "close the top drawer of the cabinet");
  CHECK(instruction_of("LIVING_ROOM_SCENE2_pick_up_the_milk") == "pick up the milk");
  CHECK(scene_of("LIVING_ROOM_SCENE2_pick_up_the_milk") == "living_room_scene2");
  CHECK(scene_of("turn_on_the_stove").empty());
  CHECK(instruction_of("KITCHEN_SCENE1") == "");
}

TEST_CASE("suites have their tasks in the published order") {
  REQUIRE(suites().size() == 5);
  std::size_t all = 0;
  for (const Suite& suite : suites()) all += suite.tasks;
  CHECK(all == 130);
  for (const Suite& suite : suites()) {
    if (suite.folder == "libero_90") continue;
    CAPTURE(suite.folder);
    const TaskOrder none = order_tasks(suite, {});
    CHECK(none.missing.size() == suite.tasks);
    CHECK(std::set<std::string>(none.missing.begin(), none.missing.end()).size() == suite.tasks);
    // Whatever order a folder is read in.
    std::vector<std::string> there = none.missing;
    std::ranges::sort(there);
    CHECK(order_tasks(suite, there).stems == none.missing);
    there.front() = "ask_for_the_moon";
    const TaskOrder other = order_tasks(suite, there);
    CHECK(other.missing.size() == 1);
    // The others keep their numbers.
    REQUIRE(other.numbers.size() == suite.tasks - 1);
    for (std::size_t i = 0; i < other.stems.size(); ++i)
      CHECK(none.missing[other.numbers[i]] == other.stems[i]);
    CHECK(other.strange == std::vector<std::string>{"ask_for_the_moon"});
  }
}

TEST_CASE("libero_90 has its files in the order of their bytes: scene 10 before scene 1") {
  const auto at = std::ranges::find(suites(), "libero_90", &Suite::folder);
  REQUIRE(at != suites().end());
  CHECK(order_tasks(*at, {"KITCHEN_SCENE1_b", "KITCHEN_SCENE2_a", "KITCHEN_SCENE10_c"}).stems ==
        std::vector<std::string>{"KITCHEN_SCENE10_c", "KITCHEN_SCENE1_b", "KITCHEN_SCENE2_a"});
}

}  // namespace probe::libero
