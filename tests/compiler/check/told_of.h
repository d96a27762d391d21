// What is said of an instruction and a success, over a few things on a table or a chest with a
// drawer: the first line, "" where all is well.
#pragma once

#include <string>

#include "tests/compiler/small_suite.h"

namespace probe::test {

// That success holds at once (P0607) is no matter here.
inline std::string first_line_of(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.starts_with("warning[P0607]") ? "" : line;
}

inline const char* const kPlaces = R"(
role helper
role goods: set
object cube like red { name "cube" }
object orange like blue { name "orange" }
object towel like tray { color blue; paint blue; name "towel" }
object green_cube like red { box 4cm x 3cm x 2cm; name "green cube" }
object yellow_cube like red { name "yellow cube" }
object red_cube like red { name "red cube" }
predicate over(a: object, b: object) = all {
  distance_xy(a, b) < 5cm
  height(a) > height(b)
  impulse(a, b) > 1e-6Ns
}
predicate held_in(o: object, r: region) = within(position(o), r)
predicate far_open(p: part) = travel(p) >= 0.8 * range(p)
predicate lifted(o: object, by: length = 3cm) = height(o) - height(start(o)) > by
predicate displaced(o: object, by: length = 3cm) = moved_xy(o) > by
predicate undisturbed(o: object, by: length = 1cm) = moved_xy(o) <= by
predicate shut(p: part) = travel(p) <= 0.1 * range(p)
layout row { place source at (0cm, -20cm); place target at (0cm, 0cm)
place helper at (0cm, 20cm); place towel at (20cm, 0cm); orient by rest; drop 10cm settle 0.5s }
layout heap { cells ends = grid 2 x 2 at (0cm, 0cm) spread (10cm, 20cm)
place goods in distinct ends; place target at (0cm, 0cm); orient by rest; drop 10cm settle 0.5s }
)";

// A cube, a tray and a towel.
inline const char* const kApart =
    "place source at (0cm, -20cm); place target at (0cm, 0cm); place towel at (20cm, 0cm)";
inline const char* const kLying =
    "place target at (0cm, 0cm); place source on target; place towel at (20cm, 0cm)";
inline std::string told_of_one(const std::string& goal, const std::string& words,
                               const std::string& places = kApart,
                               const std::string& behind = "") {
  return first_line_of(
      analyze_with_suite(std::string(kPlaces) + "metrics m { success = at end " + goal +
                         " }\nlayout one { " + places +
                         "; orient by rest; drop 10cm settle 0.5s }\n"
                         "task t like base { layout one; source cube; target tray; metrics m; "
                         "say \"" +
                         words + "\"" + behind + " }\n")
          ->said());
}

// And an orange.
inline std::string told_of_two(const std::string& goal, const std::string& words) {
  return first_line_of(
      analyze_with_suite(std::string(kPlaces) + "metrics m { success = at end " + goal +
                         " }\ntask t like base { layout row; source cube; helper orange; target "
                         "tray; metrics m; say \"" +
                         words + "\" }\n")
          ->said());
}

inline std::string told_of_chest(const std::string& goal, const std::string& words) {
  return first_line_of(
      analyze_with_suite(std::string(kChest) + kPlaces + "metrics m { success = at end " + goal +
                         " }\nlayout one { place source at (0cm, -20cm); place target at (20cm, "
                         "-20cm); orient by rest; drop 10cm settle 0.5s }\n"
                         "task t like base { scene room; layout one; source cube; target tray; "
                         "metrics m; say \"" +
                         words + "\" }\n")
          ->said());
}

inline std::string told_of_three(const std::string& words, const std::string& goods) {
  return first_line_of(
      analyze_with_suite(std::string(kPlaces) +
                         "metrics m { success = at end (all g in goods: over(g, target)) }\n"
                         "task t like base { layout heap; goods " +
                         goods + "; target tray; metrics m; say \"" + words + "\" }\n")
          ->said());
}

}  // namespace probe::test
