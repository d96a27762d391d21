// P1202 and P1510 of clauses: what is spared, lifted, covered, moved to a side, or not there at
// all.
#include <doctest/doctest.h>

#include "tests/compiler/check/told_of.h"

using namespace probe;
using namespace probe::test;

namespace {
const std::string kSays = "error[P1202]: `t` says ";
}  // namespace

TEST_CASE("what is left out by name is not what success asks for") {
  const std::string both = "(over(source, target) and over(helper, target))";
  for (const std::string words :
       {"put the cube but not the orange on the tray",
        "put the cube on the tray but not the orange", "put the cube, not the orange, on the tray",
        "put the cube instead of the orange on the tray",
        "put the cube rather than the orange on the tray"}) {
    CAPTURE(words);
    CHECK(told_of_two(both, words).find("success wants `orange` to be there as well") !=
          std::string::npos);
  }
  const std::string three = "green_cube, yellow_cube, red_cube";
  for (const std::string words : {"put all cubes except the red cube on the tray",
                                  "put all cubes but the red cube on the tray",
                                  "put every cube except the red cube on the tray"}) {
    CAPTURE(words);
    CHECK(told_of_three(words, three).find("success wants `red_cube` to be there as well") !=
          std::string::npos);
  }
}

TEST_CASE("all but the blue one") {
  const std::string text =
      analyze_with_suite(
          std::string(kPlaces) +
          "object blue_cube like red { color blue; paint blue; name \"blue cube\" }\n"
          "metrics m { success = at end (all g in goods: over(g, target)) }\n"
          "task t like base { layout heap; goods green_cube, yellow_cube, blue_cube; "
          "target tray; metrics m; say \"put all cubes but the blue one on the "
          "tray\" }\n")
          ->said();
  CHECK_MESSAGE(text.find("success wants `blue_cube` to be there as well") != std::string::npos,
                text);
}

TEST_CASE("neither of two, none of several") {
  const std::string both = "(over(source, target) and over(helper, target))";
  CHECK(told_of_two(both, "put neither the cube nor the orange on the tray") ==
        kSays +
            "\"put neither the cube nor the orange on the tray\" and success wants `cube` to be "
            "there");
  CHECK(told_of_three("put none of the cubes on the tray", "green_cube, yellow_cube")
            .find("success wants `green_cube` to be there") != std::string::npos);
}

TEST_CASE("numbers of things that are there") {
  const std::string three = "green_cube, yellow_cube, red_cube";
  CHECK(told_of_three("put the four cubes on the tray", three) ==
        kSays + "\"put the four cubes on the tray\" and 3 things are called so");
  CHECK(told_of_three("put the pair of cubes on the tray", three) ==
        kSays + "\"put the pair of cubes on the tray\" and success asks `over` of 3");
  CHECK(told_of_three("put at least one cube on the tray", three) ==
        kSays + "\"put at least one cube on the tray\" and success asks `over` of all 3");
  CHECK(first_line_of(analyze_with_suite(
                          std::string(kPlaces) +
                          "metrics m { success = at end any g in goods: over(g, target) }\n"
                          "task t like base { layout heap; goods green_cube, yellow_cube, "
                          "red_cube; target tray; metrics m; say \"put the cubes on the tray\" "
                          "}\n")
                          ->said()) ==
        kSays + "\"put the cubes on the tray\" and succeeds with one of 3 (`any`, not `all`)");
}

TEST_CASE("what covers another lies on it") {
  CHECK(told_of_one("over(source, target)", "cover the cube with the tray") ==
        kSays +
            "\"cover the cube with the tray\" and success wants `cube` to be higher than `tray`");
  CHECK(told_of_one("over(target, source)", "cover the cube with the tray") == "");
}

TEST_CASE("what is put on two is not what both lie on") {
  CHECK(told_of_two("(over(source, target) and over(helper, target))",
                    "put the tray on the cube and the orange") ==
        kSays +
            "\"put the tray on the cube and the orange\" and success wants `cube` to be higher "
            "than `tray`");
}

TEST_CASE("between is said of the one that is between") {
  const std::string text =
      analyze_with_suite(
          std::string(kPlaces) +
          "relation amid(a: object, b: object, c: object, by: length = 2cm) "
          "\"between\" = distance_xy(a, b) + distance_xy(a, c) < distance_xy(b, c) + "
          "by\n"
          "metrics m { success = at end amid(source, target, helper) }\n"
          "task t like base { layout row; source cube; helper orange; target tray; "
          "metrics m; say \"put the tray between the cube and the orange\" }\n")
          ->said();
  CHECK(text.find("success asks `amid` of `cube`") != std::string::npos);
}

TEST_CASE(
    "parts that are opened one after the other, by a predicate that has a number of its own") {
  const std::string goal = "(wide(chest.drawer) and wide(chest.door))";
  const std::string more =
      "predicate wide(p: part, by: number = 1) = travel(p) >= 0.8 * range(p) * by\n";
  const auto told = [&](const std::string& words) {
    return first_line_of(
        analyze_with_suite(std::string(kChest) + kPlaces + more + "metrics m { success = at end " +
                           goal +
                           " }\nlayout one { place source at (0cm, -20cm); place target at (20cm, "
                           "-20cm); orient by rest; drop 10cm settle 0.5s }\n"
                           "task t like base { scene room; layout one; source cube; target tray; "
                           "metrics m; say \"" +
                           words + "\" }\n")
            ->said());
  };
  CHECK(told("open the drawer, then the door").find("wants no order of") != std::string::npos);
  CHECK(told("open the drawer").find("and not `chest.door`") != std::string::npos);
  CHECK(told("open the drawer and the door") == "");
}

TEST_CASE("an order of three is one of the first and the last") {
  const std::string three =
      "predicate is_up(o: object) = lifted(o)\n"
      "metrics m { success = at end (is_up(source) and is_up(helper) and is_up(target) and "
      "not once (is_up(helper) and not once is_up(source)) and "
      "not once (is_up(target) and not once is_up(helper))) }\n";
  const std::string text =
      analyze_with_suite(std::string(kPlaces) + three +
                         "task t like base { layout row; source cube; helper orange; target tray; "
                         "metrics m; say \"lift the cube, then the orange, then the tray\" }\n")
          ->said();
  CHECK_MESSAGE(text.find("P1202") == std::string::npos, text);
}

TEST_CASE("what is lifted in success is not forbidden, put down or only touched") {
  CHECK(told_of_one("lifted(source)", "do not lift the cube") ==
        kSays + "\"not lift the cube\" and success wants `cube` to be higher than it began");
  CHECK(told_of_one("lifted(source)", "push the cube without lifting it") ==
        kSays + "\"without lifting it\" and success wants `cube` to be higher than it began");
  CHECK(told_of_one("lifted(source)", "lift the cube and put it back down") ==
        kSays + "\"put it back down\" and success wants `cube` to be higher than it began");
  CHECK(told_of_one("lifted(source)", "touch the cube") ==
        kSays + "\"touch the cube\" and success wants `cube` to be higher than it began");
}

TEST_CASE("what is to be left alone is not moved in success, nor what nobody speaks of") {
  CHECK(told_of_one("displaced(source)", "leave the cube alone") ==
        kSays + "\"leave the cube alone\" and success wants `cube` to be elsewhere than it began");
  CHECK(told_of_one("(over(source, target) and displaced(towel))", "put the cube on the tray")
            .find("wants `towel` to be elsewhere than it began, of which nothing is said") !=
        std::string::npos);
}

TEST_CASE("a thing that moves to the right does not move to the left") {
  CHECK(told_of_one("view_x(source) > view_x(start(source)) + 5cm", "move the cube to the left") ==
        kSays +
            "\"to the left\" and success wants `cube` to be farther to the right than it began");
  CHECK(told_of_one("view_x(source) > view_x(start(source)) + 5cm", "move the cube to the right") ==
        "");
}

TEST_CASE("success that is nowhere is not success at a place") {
  CHECK(told_of_one("lifted(source)", "put the cube on the tray") ==
        kSays + "\"put the cube on the tray\" and success measures `cube` against nothing");
  CHECK(told_of_one("grip > 0.5", "lift the cube") ==
        kSays + "\"lift the cube\" and success asks nothing of `cube`");
  CHECK(told_of_one("over(source, target)", "squeeze the cube") ==
        kSays + "\"squeeze the cube\" and no place, and success asks `over` of `cube` and `tray`");
}

TEST_CASE("a thing that is said to come from where it does not begin") {
  CHECK(told_of_chest("over(source, target)",
                      "take {the source} out of the drawer and put it on {the target}") ==
        kSays + "\"take the cube out of the drawer\" and `cube` does not begin there");
  CHECK(told_of_one("over(source, target)", "move the cube from the towel to the tray") ==
        kSays + "\"move the cube from the towel to the tray\" and `cube` does not begin there");
}

TEST_CASE("a thing of another colour than it has") {
  CHECK(told_of_one("over(source, target)", "put the blue cube on the tray")
            .starts_with("warning[P1510]: `t` calls `cube` \"blue cube\", and its `color` is red"));
  CHECK(told_of_one("over(source, target)", "put the little cube on the tray") == "");
}

TEST_CASE("what is kept off a thing is not to lie on it") {
  CHECK(told_of_one("over(source, target)", "keep the cube off the tray") ==
        kSays + "\"keep the cube off the tray\" and success wants `cube` to be there");
  CHECK(told_of_one("not over(source, target)", "keep the cube off the tray", kLying) == "");
}

TEST_CASE("beside a chest and on it is not in its drawer") {
  for (const std::string words :
       {"put {the source} beside the chest", "put {the source} behind the drawer",
        "put {the source} on top of the chest"}) {
    CAPTURE(words);
    CHECK(told_of_chest("held_in(source, chest.inside)", words)
              .find("success wants `cube` to be in `chest.inside`") != std::string::npos);
  }
  CHECK(told_of_chest("held_in(source, chest.inside)", "put {the source} in the chest") == "");
  CHECK(told_of_chest("held_in(source, chest.inside)", "put {the source} into the drawer") == "");
  CHECK(told_of_chest("held_in(source, chest.top)", "put {the source} on the chest") == "");
}

TEST_CASE("a name of something that is elsewhere is no wrong colour") {
  CHECK(told_of_one("over(source, target)", "put the green cube on the tray")
            .starts_with("error[P0404]"));
}
