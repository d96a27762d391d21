// P1202 of clauses: ordinary instructions that say what success asks, and are not told otherwise.
#include <doctest/doctest.h>

#include "tests/compiler/check/told_of.h"

using namespace probe::test;

TEST_CASE("the other one is not what was spoken of before") {
  CHECK(told_of_two("over(source, target) and over(helper, target)",
                    "put the cube on the tray and the other one on the tray as well") == "");
  CHECK(told_of_two("over(source, target) and over(helper, target)",
                    "put the cube and the other one on the tray") == "");
}

TEST_CASE("how a thing is taken says nothing of what is done at the end") {
  CHECK(told_of_one("over(source, target)", "put the cube on the tray, lifting it carefully") == "");
  CHECK(told_of_one("over(source, target)", "put the cube on the tray. grasp it gently.") == "");
}

TEST_CASE("what is not to be done before something else may be done after it") {
  const std::string in_order =
      "(over(source, target) and once over(source, target) and over(helper, target) and "
      "not once (over(helper, target) and not once over(source, target)))";
  CHECK(told_of_two(in_order, "do not put the orange on the tray before the cube is there") == "");
}

TEST_CASE("on is said of a relation that is called so") {
  const std::string text =
      analyze_with_suite(std::string(kPlaces) +
                         "relation resting(a: object, b: object) \"on\" = distance_xy(a, b) < 5cm\n"
                         "metrics m { success = at end resting(source, target) }\n"
                         "layout one { place source at (0cm, -30cm); place target at (0cm, 0cm); "
                         "orient by rest; drop 10cm settle 0.5s }\n"
                         "task t like base { layout one; source cube; target tray; metrics m; "
                         "say \"put the cube on the tray\" }\n")
          ->said();
  CHECK(text == "");
}

TEST_CASE("what is lifted off a thing is above it") {
  CHECK(told_of_one("(distance_xy(source, target) < 5cm and height(source) > height(target) + 10cm)",
                    "lift the cube off the tray") == "");
}

TEST_CASE("all drawers are those of the scene that a task is in") {
  const std::string text =
      analyze_with_suite(std::string(kChest) + kPlaces +
                         "fixture other like chest { at (30cm, 30cm, 85cm) }\n"
                         "scene elsewhere like room { fixture other }\n"
                         "metrics m { success = at end (all p in parts: shut(p)) }\n"
                         "layout one { place source at (0cm, -20cm); place target at (20cm, -20cm); "
                         "orient by rest; drop 10cm settle 0.5s }\n"
                         "task t like base { scene room; layout one; source cube; target tray; "
                         "metrics m; say \"close the drawer and the door\" }\n"
                         "task u like t { scene elsewhere }\n")
          ->said();
  CHECK_MESSAGE(text.find("P1202") == std::string::npos, text);
}
