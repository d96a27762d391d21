#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

// What is underlined when `declaration` follows the suite; empty when nothing is wrong.
std::string refused(const std::string& declaration) {
  const auto a = analyze_with_suite(declaration);
  if (a->codes().empty()) return {};
  CHECK_MESSAGE(a->codes().substr(0, 5) == "P0304", a->said());
  return a->underlined();
}

}  // namespace

TEST_CASE("objects settle for more than no time and at most a minute") {
  CHECK(refused("layout l like pairs { drop 10cm settle 1s }") == "");
  CHECK(refused("layout l like pairs { drop 10cm settle 0s }") == "0s");
  CHECK(refused("layout l like pairs { drop 10cm settle 4294967.296s }") == "4294967.296s");
}

TEST_CASE("cells in the same place are an error where the spread stands") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells spots = grid 3 x 1 at (0cm, 0cm) spread (0cm, 0cm) }");
  CHECK(a->codes() == "P0304");
  CHECK(a->underlined() == "(0cm, 0cm)");
  CHECK(analyze_with_suite(
            "layout l like pairs { cells spots = grid 3 x 1 at (0cm, 0cm) spread (9cm, 0cm) }")
            ->codes() == "");
}

TEST_CASE("a layout lets objects come to rest, metrics say what success is") {
  const auto codes = [](const std::string& text) { return analyze_with_suite(text)->codes(); };
  const std::string places = "place source at (0cm, 0cm); place target at (20cm, 0cm)";
  const std::string turns = "; orient source yaw 0deg; orient target yaw 0deg";
  const std::string task = "variant v of red_on_tray { layout l }";
  CHECK(codes("layout l { " + places + turns + " }\n" + task) == "P0206");
  CHECK(codes("layout l { " + places + turns + "; drop 10cm }\n" + task) == "P0206");
  CHECK(codes("layout l { " + places + turns + "; drop 10cm settle 1s }\n" + task) == "");
  const std::string judged =
      "task t like red_on_tray { metrics m }\nvariant u of t { source blue }";
  CHECK(codes("metrics m { moved = at end moved_xy(source) > 1cm }\n" + judged) == "P0206");
  CHECK(codes("metrics m { success = max moved_xy(source) }\n" + judged) == "P0601");
  CHECK(codes("metrics m { moved = at end moved_xy(source) > 1cm }\n"
              "task t like red_on_tray { say \"push {the source}\"; metrics m; set success = once "
              "moved_xy(source) > 1cm }") == "");
}
