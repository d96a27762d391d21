// Clauses of instructions, each held to what success asks.
#include <doctest/doctest.h>

#include "tests/compiler/check/told_of.h"

using namespace probe;
using namespace probe::test;

TEST_CASE("what goes where is what success asks of the two") {
  const std::string goal =
      "(over(source, target) and over(helper, towel) and once (over(source, target) and not once "
      "over(helper, towel)))";
  const std::string wrong =
      "error[P1202]: `t` says \"put the cube on the towel\" and success asks `over` of `cube` and "
      "`tray`";
  for (const std::string words :
       {"first put the cube on the tray, then the orange on the towel",
        "put {the source} on {the target} and then put {the helper} on the towel",
        "put the cube on the tray. After that put the orange on the towel",
        "pick up the cube and put it on the tray, then pick up the orange and put it on the towel",
        "on the tray, put the cube, then put the orange on the towel"}) {
    CAPTURE(words);
    CHECK(told_of_two(goal, words) == "");
  }
  CHECK(told_of_two(goal, "first put the cube on the towel, then the orange on the tray") ==
        "error[P1202]: `t` says \"put the cube on the towel\" and success asks `over` of `cube` "
        "and `tray`");
  CHECK(told_of_two(goal,
                    "put {the source} on the towel and then put {the helper} on {the target}") ==
        wrong);
  CHECK(told_of_two("(over(source, target) and over(helper, towel))",
                    "put the cube on the towel and the orange on the tray") == wrong);
  CHECK(told_of_one("over(source, target)",
                    "put the cube on the towel, not on {avoid the target}") == wrong);
  // It may be either that goes there, and what is not understood says nothing.
  CHECK(told_of_one("over(source, target)", "put the cube beside the towel on the tray") == "");
  CHECK(told_of_one("over(source, target)", "take the cube away from the towel to the tray") == "");
  CHECK(told_of_one("over(source, target)",
                    "put the cube on the fringe of the towel on the tray") == "");
}

TEST_CASE("a clause without a verb may stand behind any sign") {
  for (const std::string sign : {",", ".", ";"}) {
    CAPTURE(sign);
    CHECK(told_of_two("(over(source, target) and over(helper, towel))",
                      "put the cube on the tray" + sign + " the orange on the towel") == "");
    CHECK(
        told_of_two("(over(source, target) and over(helper, towel))",
                    "put the cube on the tray" + sign + " the orange on the tray") ==
        "error[P1202]: `t` says \"the orange on the tray\" and success asks `over` of `orange` and "
        "`towel`");
  }
  CHECK(told_of_one("over(source, target)", "put the cube on it, the tray on the table") == "");
  CHECK(told_of_one("over(source, target)", "put cube, the tray on cube") ==
        "error[P1202]: `t` says \"the tray on cube\" and success wants `cube` to be higher than "
        "`tray`");
}

TEST_CASE("what is put somewhere is something that success speaks of") {
  CHECK(told_of_two("over(source, target)",
                    "put {the source} on {the target} and {the helper} on the towel") ==
        "error[P1202]: `t` says \"the orange on the towel\" and success asks nothing of `orange`");
  CHECK(told_of_chest("far_open(chest.drawer)",
                      "open the drawer, take {the source} and put it on {the target}") ==
        "error[P1202]: `t` says \"put it on the tray\" and success asks nothing of `cube`");
  CHECK(told_of_chest("far_open(chest.drawer)",
                      "open the drawer, take out what is in it and put it on {the target}, "
                      "{the source}") == "");
  CHECK(told_of_chest("(far_open(chest.drawer) and over(source, target))",
                      "open the drawer, take {the source} and put it on {the target}") == "");
}

TEST_CASE("what else must not be touched hides nothing of what goes where") {
  for (const std::string more :
       {"no f in fingers: impulse(f, source) > 1e-6Ns",
        "no x in bodies - {source, target} - links: impulse(source, x) > 1e-6Ns",
        "any x in bodies - objects - links: impulse(target, x) > 1e-6Ns",
        "not any d in distractors: moved_xy(d) > 3cm"}) {
    CAPTURE(more);
    const std::string goal = "(over(source, target) and " + more + ")";
    CHECK(told_of_one(goal, "put the cube on the towel") ==
          "error[P1202]: `t` says \"put the cube on the towel\" and success asks `over` of `cube` "
          "and `tray`");
    CHECK(told_of_one(goal, "put the cube on the tray") == "");
    CHECK(told_of_one(goal, "put the towel on the tray") ==
          "error[P1202]: `t` says \"put the towel on the tray\" and success asks nothing of "
          "`towel`");
  }
  CHECK(told_of_one("(all x in objects - {target}: over(x, target))",
                    "put the towel on the tray") == "");
}

TEST_CASE("what is put on another is not under it in success") {
  const std::string wrong =
      "error[P1202]: `t` says \"put the tray on the cube\" and success wants "
      "`cube` to be higher than `tray`";
  CHECK(told_of_one("over(source, target)", "put the tray on the cube") == wrong);
  CHECK(told_of_one("over(source, target)", "put {the target} on {the source}") == wrong);
  CHECK(told_of_one("over(source, target)", "put the cube under the tray") ==
        "error[P1202]: `t` says \"put the cube under the tray\" and success wants `cube` to be "
        "higher than `tray`");
  CHECK(told_of_one("over(target, source)", "put the cube under the tray") == "");
  CHECK(told_of_one("(distance_xy(source, target) < 5cm and height(source) < height(target) + 9cm)",
                    "put the cube on the tray") == "");
}

TEST_CASE("what an instruction forbids is not what success wants") {
  for (const std::string no : {"do not", "don't", "never", "please do not"}) {
    CAPTURE(no);
    CHECK(told_of_one("over(source, target)", no + " put the cube on the tray") ==
          "error[P1202]: `t` says \"not put the cube on the tray\" and success wants `cube` to be "
          "there");
    CHECK(told_of_one("not over(source, target)", no + " put the cube on the tray") == "");
    CHECK(told_of_one("over(source, target)",
                      no + " put the cube on the towel, put it on the tray") == "");
  }
  CHECK(
      told_of_chest("far_open(chest.drawer)", "do not open the drawer") ==
      "error[P1202]: `t` says \"not open the drawer\" and success is that `chest.drawer` has moved "
      "at least so far");
  CHECK(told_of_chest("shut(chest.drawer)", "do not open the drawer") == "");
}

TEST_CASE("what goes beside something is measured against it") {
  const std::string goal = "view_x(source) < view_x(target) - 2cm";
  CHECK(told_of_one(goal, "put the cube to the left of the towel") ==
        "error[P1202]: `t` says \"put the cube to the left of the towel\" and success measures "
        "`cube` against `tray`");
  CHECK(told_of_one(goal, "put the cube to the left of the tray") == "");
  CHECK(told_of_one(goal, "put the cube to the left of the tray, beside the towel") == "");
}

TEST_CASE("words for two are not judged by three") {
  const std::string three = "green_cube, yellow_cube, red_cube";
  CHECK(told_of_three("put the green and the yellow cube on the tray", three)
            .find("and not `red_cube`, of which success asks `over` as well") != std::string::npos);
  CHECK(told_of_three("put the green, the yellow and the red cube on the tray", three) == "");
  CHECK(told_of_three("put the cubes on the tray", three) == "");
  CHECK(told_of_three("put all three cubes on the tray", three) == "");
  CHECK(told_of_three("put both cubes on the tray", three) ==
        "error[P1202]: `t` says \"put both cubes on the tray\" and success asks `over` of 3");
  CHECK(told_of_three("put the green cube and the other cubes on the tray", three) == "");
}

TEST_CASE("words before a slot of several count as many as there are") {
  const std::string three = "green_cube, yellow_cube, red_cube", two = "green_cube, yellow_cube";
  const std::string of_three =
      "error[P1104]: the words count otherwise: `goods` of `t` is 3 objects";
  CHECK(told_of_three("put both {the goods} on the tray", three) == of_three);
  CHECK(told_of_three("put both of {the goods} on the tray", three) == of_three);
  CHECK(told_of_three("put both {the goods} on the tray", two) == "");
  CHECK(told_of_three("put all three of {the goods} on the tray", three) == "");
  CHECK(told_of_three("put all three {goods} on the tray", two) ==
        "error[P1104]: the words count otherwise: `goods` of `t` is 2 objects");
  CHECK(told_of_three("put two of {the goods} on the tray", three).find("P1104") ==
        std::string::npos);
}

TEST_CASE("what is closed in the end is closed in success") {
  const std::string nothing =
      "error[P1202]: `t` says \"close it\" and success asks nothing of how far `chest.drawer` "
      "has moved";
  const std::string words = "put {the source} into the drawer and close it";
  CHECK(told_of_chest("held_in(source, chest.inside)", words) == nothing);
  CHECK(told_of_chest("(held_in(source, chest.inside) and shut(chest.drawer))", words) == "");
  CHECK(told_of_chest("(held_in(source, chest.inside) and travel(chest.slide) < 1cm)", words) ==
        "");
  CHECK(told_of_chest("(held_in(source, chest.inside) and far_open(chest.drawer))",
                      "open the drawer, put {the source} in it and close it") ==
        "error[P1202]: `t` says \"close it\" and success is that `chest.drawer` has moved at least "
        "so "
        "far");
  // Being open is the way there.
  CHECK(told_of_chest("held_in(source, chest.inside)",
                      "open the drawer and put {the source} in it") == "");
  CHECK(told_of_chest("over(source, target)",
                      "put {the source} on {the target} and open the drawer") ==
        "error[P1202]: `t` says \"open the drawer\" and success asks nothing of how far "
        "`chest.drawer` has moved");
}

TEST_CASE("what goes somewhere is not to be elsewhere") {
  const std::string words = "put {the source} into the drawer";
  CHECK(told_of_chest("(not held_in(source, chest.inside))", words) ==
        "error[P1202]: `t` says \"put the cube into the drawer\" and success wants `cube` not to "
        "be there");
  CHECK(told_of_chest("held_in(source, chest.inside)", words) == "");
  CHECK(told_of_chest("held_in(source, chest.inside)",
                      "open the drawer and put {the source} inside") == "");
  CHECK(told_of_chest("over(source, target)", "open the drawer and put {the source} inside") ==
        "error[P1202]: `t` says \"put the cube inside\" and success asks `over` of `cube` and "
        "`tray`");
  CHECK(told_of_one("(not over(source, target))", "put {the source} on {the target}") ==
        "error[P1202]: `t` says \"put the cube on the tray\" and success wants `cube` not to be "
        "there");
  CHECK(told_of_one("(not over(source, target))", "take {the source} off {the target}", kLying) ==
        "");
  CHECK(told_of_one("distance(source, target) > 10cm", "put {the source} away from {the target}") ==
        "");
  CHECK(told_of_one("(not once not over(source, target))", "put {the source} on {the target}") ==
        "");
}
