// P1202 of clauses: how many, which of several, in which turn, how often.
#include <doctest/doctest.h>

#include "tests/compiler/check/told_of.h"

using namespace probe::test;

namespace {

// A chest whose drawer, door and second drawer move.
std::string told_of_drawers(const std::string& goal, const std::string& words) {
  const std::string text =
      analyze_with_suite(
          std::string(kPlaces) +
          R"(
fixture desk {
  urdf "chest/chest.urdf"; at (0cm, 30cm, 85cm) yaw 90deg
  joint slide friction 2N damping 5Ns/m
  joint hinge friction 1Nm
  part top link drawer name "top drawer"
  part low link door name "low drawer"
}
fixture safe like desk { at (0cm, 60cm, 85cm) yaw 90deg
  part top link drawer name "far drawer"; part low link door name "safe door" }
scene study like bench { fixture desk, safe }
layout one { place source at (0cm, -20cm); orient by rest; drop 10cm settle 0.5s }
)" "metrics m { success = at end " +
          goal +
          " }\ntask t like base { scene study; layout one; source cube; target none; metrics m; say \"" +
          words + "\" }\n")
          ->said();
  return text.substr(0, text.find('\n'));
}

const std::string kBegins = "error[P1202]: `t` says ";

}  // namespace

TEST_CASE("all drawers are all, one of them is any, and two that are named are both") {
  const std::string top = "far_open(desk.top)", low = "far_open(desk.low)", far = "far_open(safe.top)";
  CHECK(told_of_drawers(top, "open the top and the low drawer") ==
        kBegins + "`desk.low`, which its success does not measure");
  CHECK(told_of_drawers("(" + top + " and " + low + ")", "open the top and the low drawer") == "");
  CHECK(told_of_drawers("(" + top + " or " + low + ")", "open the top drawer and the low drawer") ==
        kBegins + "\"open the top drawer and the low drawer\" and succeeds with one of 2 (`or`, not `and`)");
  CHECK(told_of_drawers("(any p in {desk.top, desk.low}: far_open(p))", "open the top drawer and the low drawer") ==
        kBegins + "\"open the top drawer and the low drawer\" and succeeds with one of 2 (`any`, not `all`)");
  CHECK(told_of_drawers("(" + top + " and " + low + ")", "open the top drawer or the low drawer") ==
        kBegins + "\"open the top drawer or the low drawer\" and success asks `far_open` of both");
  CHECK(told_of_drawers("(" + top + " or " + low + ")", "open the top drawer or the low drawer") == "");
  for (const std::string words : {"open all drawers", "open every drawer", "open the drawers"}) {
    CAPTURE(words);
    CHECK(told_of_drawers(top, words).find("success asks `far_open` of `desk.top` and not of") !=
          std::string::npos);
    CHECK(told_of_drawers("(" + top + " and " + low + " and " + far + ")", words) == "");
    CHECK(told_of_drawers("(all p in {desk.top, desk.low, safe.top}: far_open(p))", words) == "");
  }
  CHECK(told_of_drawers(top, "open a drawer") ==
        kBegins + "\"open a drawer\" and success asks `far_open` of `desk.top` alone, of 3");
  CHECK(told_of_drawers("(any p in {desk.top, desk.low, safe.top}: far_open(p))", "open one of the drawers") == "");
  CHECK(told_of_drawers("(all p in {desk.top, desk.low, safe.top}: far_open(p))", "open one of the drawers") ==
        kBegins + "\"open one of the drawers\" and success asks `far_open` of all 3");
  CHECK(told_of_drawers("(" + top + " and " + low + ")", "open two drawers") ==
        kBegins + "\"open two drawers\" and success asks `far_open` of `desk.top` and `desk.low`, of 3");
  CHECK(told_of_drawers("(" + top + " and " + low + ")", "open the top drawer") ==
        kBegins + "`desk.top` and not `desk.low`, of which success asks `far_open` as well");
  CHECK(told_of_drawers("(" + top + " and " + low + ")", "open the top drawer, then the low drawer") != "");
  // What is left out of all, and words that nobody knows.
  CHECK(told_of_drawers("(" + top + " and " + low + ")", "open all drawers except the far drawer") == "");
  CHECK(told_of_drawers(top, "open the top drawer halfway") == "");
}

TEST_CASE("one of the cubes, half of them and a cube are not all") {
  const std::string three = "green_cube, yellow_cube, red_cube";
  const std::string all = "\" and success asks `over` of all 3";
  for (const std::string words :
       {"put one of the cubes on the tray", "put half of the cubes on the tray",
        "put a cube on the tray", "put two of the cubes on the tray"}) {
    CAPTURE(words);
    const std::string said = told_of_three(words, three);
    CHECK(said.substr(0, kBegins.size()) == kBegins);
  }
  CHECK(told_of_three("put half of the cubes on the tray", three) ==
        kBegins + "\"put half of the cubes on the tray" + all);
  CHECK(told_of_three("put all three of the cubes on the tray", three) == "");
  CHECK(told_of_three("put the cubes on the tray", three) == "");
  CHECK(told_of_three("put every cube on the tray", three) == "");
}

TEST_CASE("of two either, or both") {
  const std::string both = "(over(source, target) and over(helper, target))";
  const std::string either = "(over(source, target) or over(helper, target))";
  const std::string words = "put {the source} or {the helper} on {the target}";
  CHECK(told_of_two(both, words) ==
        kBegins + "\"put the cube or the orange on the tray\" and success asks `over` of both");
  CHECK(told_of_two("over(source, target)", words) ==
        kBegins + "\"put the cube or the orange on the tray\" and success asks `over` of `cube` alone, of 2");
  CHECK(told_of_two(either, words) == "");
  CHECK(told_of_two(either, "put one of {the source} and {the helper} on {the target}") == "");
  CHECK(told_of_two(either, "put {the source} and {the helper} on {the target}") ==
        kBegins + "\"put the cube and the orange on the tray\" and succeeds with one of 2 (`or`, not `and`)");
}

TEST_CASE("what is done first or last is so in success") {
  const std::string goal =
      "(over(source, target) and over(helper, target) and once (over(source, target) and not once "
      "over(helper, target)))";
  for (const std::string words :
       {"put {the helper} and {the source} on {the target}, {the source} last",
        "put {the source} and {the helper} on {the target}, beginning with {the helper}",
        "put {the source} and {the helper} on {the target}; start with {the helper}",
        "prior to {the source}, put {the helper} on {the target}",
        "having put {the helper} on {the target}, put {the source} there",
        "do not put {the source} on {the target} until {the helper} is there",
        "put {the source} on {the target} last, {the helper} first"}) {
    CAPTURE(words);
    CHECK(told_of_two(goal, words).find("succeeds when `cube` comes before `orange`") !=
          std::string::npos);
  }
  for (const std::string words :
       {"put {the source} and {the helper} on {the target}, {the helper} last",
        "put {the helper} and {the source} on {the target}, beginning with {the source}",
        "prior to {the helper}, put {the source} on {the target}",
        "having put {the source} on {the target}, put {the helper} there",
        "do not put {the helper} on {the target} until {the source} is there",
        "put {the helper} on {the target} last, {the source} first"}) {
    CAPTURE(words);
    CHECK(told_of_two(goal, words) == "");
  }
}

TEST_CASE("what is the same after once as after twice is not done twice") {
  CHECK(told_of_one("over(source, target)", "put the cube on the tray twice") ==
        kBegins + "\"put the cube on the tray twice\" and success is the same after once as after twice");
  CHECK(told_of_one("once (over(source, target) and once not over(source, target))",
                    "put the cube on the tray twice") == "");
}

TEST_CASE("between says which thing is in the middle") {
  const std::string text =
      std::string(kPlaces) +
      "relation amid(a: object, b: object, c: object) \"between\" = distance_xy(a, b) + distance_xy(a, c) "
      "< 45cm\nmetrics m { success = at end amid(source, target, helper) }\n";
  const auto told = [&](const std::string& words) {
    const std::string said = analyze_with_suite(
                                 text + "task t like base { layout row; source cube; helper orange; "
                                        "target tray; metrics m; say \"" + words + "\" }\n")
                                 ->said();
    return said.substr(0, said.find('\n'));
  };
  CHECK(told("put {the source} between {the target} and {the helper}") == "");
  CHECK(told("put {the helper} between {the target} and {the source}") ==
        kBegins + "\"put the orange between the tray and the cube\" and success asks `amid` of `cube`");
}
