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
  CHECK(told_of_one("over(source, target)", "put the cube on the tray, lifting it carefully") ==
        "");
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
  CHECK(
      told_of_one("(distance_xy(source, target) < 5cm and height(source) > height(target) + 10cm)",
                  "lift the cube off the tray", kLying) == "");
}

TEST_CASE("all drawers are those of the scene that a task is in") {
  const std::string text =
      analyze_with_suite(
          std::string(kChest) + kPlaces +
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

TEST_CASE("on the left of a thing is beside it or on it") {
  CHECK(told_of_one("(over(source, target) and view_x(source) < view_x(target))",
                    "put the cube on the left of the tray") == "");
  CHECK(told_of_one("view_x(source) < view_x(target) - 2cm",
                    "put the cube on the left of the tray") == "");
}

TEST_CASE("what is put on a hook or a peg need not be higher") {
  const std::string hangs =
      "(distance_xy(source, target) < 5cm and height(source) < height(target))";
  CHECK(told_of_one(hangs, "put the cube on the tray") == "");
  CHECK(told_of_one(hangs, "hang the cube on the tray") == "");
}

TEST_CASE("what is kept as it is may be the matter of another metric") {
  const std::string words = "put {the source} on {the target} and keep the drawer closed";
  CHECK(told_of_chest("over(source, target)\n opened_it = once travel(chest.slide) > 2cm", words) ==
        "");
  CHECK(told_of_chest("(over(source, target) and shut(chest.drawer))", words) == "");
  CHECK(told_of_chest("over(source, target)", words) ==
        "error[P1202]: `t` says \"keep the drawer closed\" and no metric measures anything of "
        "`chest.drawer`");
  CHECK(told_of_chest("(over(source, target) and far_open(chest.drawer))", words) ==
        "error[P1202]: `t` says \"keep the drawer closed\" and success is that `chest.drawer` has "
        "moved at least so far");
}

TEST_CASE("what is spared, counted or said to be left out is as it is said") {
  CHECK(told_of_two("(over(source, target) and not over(helper, target))",
                    "put the cube but not the orange on the tray") == "");
  CHECK(told_of_two("(not over(source, target) and not over(helper, target))",
                    "put neither the cube nor the orange on the tray") == "");
  const std::string three = "green_cube, yellow_cube, red_cube";
  CHECK(told_of_three("put the three cubes on the tray", three) == "");
  CHECK(told_of_three("put the pair of cubes on the tray", "green_cube, red_cube") == "");
  CHECK(told_of_one("any g in {source, target}: displaced(g)", "push the cube or the tray") == "");
  const std::string alone = "(over(source, target) and undisturbed(helper))";
  CHECK(told_of_two(alone, "put the cube rather than the orange on the tray") == "");
  CHECK(told_of_two(alone, "put the cube, but not the orange, on the tray") == "");
  CHECK(told_of_two(alone, "put the cube on the tray but do not move the orange") == "");
}

TEST_CASE("what is lifted, pushed or moved aside is so in success") {
  CHECK(told_of_one("lifted(source)", "lift the cube") == "");
  CHECK(told_of_one("lifted(source)", "hold the cube up") == "");
  CHECK(told_of_one("lifted(source)", "pick up the cube") == "");
  CHECK(told_of_one("once lifted(source)", "lift the cube and put it back down") == "");
  CHECK(told_of_one("displaced(source)", "push the cube") == "");
  CHECK(told_of_one("view_x(source) < view_x(start(source)) - 3cm", "move the cube to the left") ==
        "");
  CHECK(told_of_one("(over(source, target) and displaced(towel))",
                    "push the towel aside and put the cube on the tray") == "");
  CHECK(told_of_one("(over(source, target) and undisturbed(towel))", "put the cube on the tray") ==
        "");
  CHECK(told_of_one("(over(source, target) and (displaced(towel) or lifted(source)))",
                    "put the cube on the tray") == "");
  CHECK(told_of_one("x(source) > 10cm", "put the cube on the tray") == "");
}

TEST_CASE("what is meant by a word alone may be any thing") {
  for (const std::string words :
       {"push everything away", "move it", "push them away", "move one of them",
        "put the cube on the tray and push everything away", "push these away"}) {
    CAPTURE(words);
    const bool has_cube = words.starts_with("put");
    CHECK(told_of_one(has_cube ? "(over(source, target) and displaced(towel))" : "displaced(towel)",
                      words) == "");
  }
}

TEST_CASE("a side that is denied, corrected or says which thing is none to go to") {
  const std::string right = "view_x(source) > view_x(start(source)) + 5cm";
  for (const std::string words :
       {"move the cube to the right, not to the left",
        "don't move it to the left, move it to the right", "do not move the cube to the left",
        "take the cube, the one to the left, and move it to the right",
        "take the one to the left and move it", "move the cube to the right instead of to the left",
        "take the cube to the left and move it away"}) {
    CAPTURE(words);
    CHECK(told_of_one(right, words).find("farther to the right") == std::string::npos);
  }
}

TEST_CASE("what is pulled up, out or off is higher than it began") {
  for (const std::string words : {"pull the cube up", "pull up the cube", "pull the cube off the tray",
                                  "pull the cube out", "slide the cube up"}) {
    CAPTURE(words);
    CHECK(told_of_one("lifted(source)", words, kLying) == "");
  }
}

TEST_CASE("a later sentence speaks of what an earlier one did") {
  const auto told = [](const std::string& goal, const std::string& first, const std::string& then) {
    return told_of_one(goal, first, kApart,
                       "; then say \"" + then + "\" when height(source) > 95cm");
  };
  CHECK(told("not over(source, target)", "put {the source} on {the target}",
             "take {the source} off {the target}") == "");
  CHECK(told("over(source, target)", "put {the source} on {the target}", "press {the source}") ==
        "");
  CHECK(told("lifted(source)", "lift {the source}", "turn {the source}") == "");
  CHECK(told("view_x(source) > view_x(start(source)) + 5cm", "move {the source} to the left",
             "move {the source} to the right") == "");
}

TEST_CASE("everything but one thing is not that thing") {
  const std::string goal = "(over(helper, target) and not over(source, target))";
  for (const std::string words :
       {"put everything but the cube on the tray", "put everything except the cube on the tray",
        "put everything on the tray but the cube", "put all but the cube on the tray",
        "put everything but the cube and the towel on the tray"}) {
    CAPTURE(words);
    CHECK(told_of_two(goal, words) == "");
  }
  CHECK(told_of_two("(over(source, target) and over(helper, target))", "put everything but the cube on the tray") ==
        "error[P1202]: `t` says \"put everything but the cube on the tray\" and success wants "
        "`cube` to be there as well");
}

TEST_CASE("a thing may be of a kind that its name does not say") {
  CHECK(first_line_of(
            analyze_with_suite(
                std::string(kPlaces) +
                "object coke like red { name \"coke\" }\n"
                "object fanta like blue { name \"fanta can\" }\n"
                "metrics m { success = at end (over(source, target) and over(helper, target)) }\n"
                "task t like base { layout row; source coke; helper fanta; target tray; metrics m; "
                "say \"put both cans on the tray\" }\n")
                ->said()) == "");
}
