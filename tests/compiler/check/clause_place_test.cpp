// P1202 of clauses: how one thing lies to another, where it comes from, and no place at all.
#include <doctest/doctest.h>

#include "tests/compiler/check/told_of.h"

using namespace probe::test;

namespace {
const std::string kBegins = "error[P1202]: `t` says ";
const std::string kOn = "over(source, target)";
}  // namespace

TEST_CASE("what is to lie upon another is not put next to it, near it or in front of it") {
  for (const std::string words : {"put the cube next to the tray", "place the cube near the tray",
                                  "drop the cube beside the tray"}) {
    CAPTURE(words);
    CHECK(told_of_one(kOn, words) ==
          kBegins + "\"" + words + "\" and success wants `cube` to be higher than `tray`");
  }
  CHECK(told_of_one("distance_xy(source, target) < 20cm", "put the cube next to the tray") == "");
  // Which tray.
  CHECK(told_of_one(kOn, "put the cube on the tray next to the towel") == "");
  CHECK(told_of_one(kOn, "pick up the cube next to the towel and put it on the tray") == "");
}

TEST_CASE("on is not said of what success has a relation's own words for") {
  const std::string near =
      "relation aside(a: object, b: object) \"next to\", \"near\" = distance_xy(a, b) < 20cm\n";
  const auto told = [&](const std::string& words) {
    const std::string text =
        analyze_with_suite(kPlaces + near +
                           "metrics m { success = at end aside(source, target) }\n"
                           "layout one { place source at (0cm, -30cm); place target at (0cm, 0cm); "
                           "orient by rest; drop 10cm settle 0.5s }\n"
                           "task t like base { layout one; source cube; target tray; metrics m; "
                           "say \"" +
                           words + "\" }\n")
            ->said();
    return text.substr(0, text.find('\n'));
  };
  CHECK(told("put the cube on the tray") ==
        kBegins +
            "\"put the cube on the tray\" and success asks `aside`, which is said by \"next to\"");
  CHECK(told("put the cube near the tray") == "");
}

TEST_CASE("what is taken off a thing is not to be there") {
  const std::string there = "\" and success wants `cube` to be there";
  for (const std::string words :
       {"take the cube off the tray", "move the cube away from the tray",
        "remove the cube from the tray", "avoid putting the cube on the tray"}) {
    CAPTURE(words);
    CHECK(told_of_one(kOn, words, kLying).find("success wants `cube` to be there") !=
          std::string::npos);
    CHECK(told_of_one("not " + kOn, words, kLying) == "");
  }
  CHECK(told_of_one(kOn, "take the cube from the tray and put it back on the tray", kLying) == "");
  CHECK(told_of_one("over(source, towel)", "take the cube from the tray and put it on the towel",
                    kLying) == "");
  CHECK(told_of_one(kOn, "put the cube on the tray, then pick it up again") ==
        kBegins + "\"pick it up again\" and success wants `cube` to lie there at the end");
}

TEST_CASE("a place that is not said, or is the table, is none that success may want") {
  CHECK(told_of_one(kOn, "pick up the cube") ==
        kBegins +
            "\"pick up the cube\" and no place, and success asks `over` of `cube` and `tray`");
  CHECK(told_of_one(kOn, "put the cube on the table") ==
        kBegins + "\"put the cube on the table\" and success asks `over` of `cube` and `tray`");
  CHECK(told_of_one("height(source) > 5cm", "pick up the cube") == "");
  CHECK(told_of_one(kOn, "pick up the cube and put it on the tray") == "");
  CHECK(told_of_one(kOn, "pick up the cube from the table and put it on the tray") == "");
  // Words that nobody knows may say it.
  CHECK(told_of_one(kOn, "pick up the cube and tray it") == "");
}

TEST_CASE("what is said to be somewhere goes there") {
  const std::string turned = "\" and success wants `cube` to be higher than `tray`";
  for (const std::string words :
       {"I want the tray on the cube", "the tray belongs on the cube",
        "the tray should be lying on the cube", "the tray on top of the cube"}) {
    CAPTURE(words);
    CHECK(told_of_one(kOn, words).find("success wants `cube` to be higher than `tray`") !=
          std::string::npos);
  }
  for (const std::string words : {"I want the cube on the tray", "the cube belongs on the tray",
                                  "the cube should be on the tray", "the cube on the tray",
                                  "I want you to put the cube on the tray"}) {
    CAPTURE(words);
    CHECK(told_of_one(kOn, words) == "");
  }
}

TEST_CASE("what a drawer is left as is what success wants of it") {
  const std::string in = "held_in(source, chest.inside)";
  const std::string words = "put {the source} in the drawer and leave it open";
  CHECK(told_of_chest("(" + in + " and shut(chest.drawer))", words) ==
        kBegins + "\"leave it open\" and success is that `chest.drawer` has moved at most so far");
  CHECK(told_of_chest("(" + in + " and far_open(chest.drawer))", words) == "");
  CHECK(told_of_chest(in, words) == "");
  CHECK(told_of_chest("far_open(chest.drawer)", "push in the drawer") ==
        kBegins +
            "\"push in the drawer\" and success is that `chest.drawer` has moved at least so far");
  CHECK(told_of_chest("far_open(chest.drawer)", "pull out the drawer") == "");
}

TEST_CASE("what must not be touched is measured by some metric") {
  const std::string none = "no metric measures anything of `towel`";
  for (const std::string words : {"put the cube on the tray but do not move the towel",
                                  "put the cube on the tray and leave the towel alone",
                                  "without disturbing the towel, put the cube on the tray",
                                  "put the cube on the tray, keep away from the towel"}) {
    CAPTURE(words);
    CHECK(told_of_one(kOn, words).find(none) != std::string::npos);
    CHECK(told_of_one(kOn + "\nbumped = once moved_xy(towel) > 1cm", words) == "");
    CHECK(told_of_one(kOn + "\nbumped = once any x in objects: moved_xy(x) > 1cm", words) == "");
  }
  CHECK(told_of_one(kOn, "put the cube on the tray and leave") == "");
}
