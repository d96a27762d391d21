#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE(
    "objects that overlap at the start are reported once for the task, with depth and episode") {
  const auto a = analyze_with_suite(
      "layout tight like pairs { cells spots = grid 2 x 2 at (0cm, 0cm) spread (2cm, 2cm) }\n"
      "variant v of red_on_tray { layout tight }");
  CHECK_MESSAGE(a->codes() == "P0501", a->said());
  CHECK(a->diagnostics.items().front().message ==
        "`red` and `tray` overlap by 1cm in 8 of 24 starts of `v`");
  CHECK(a->diagnostics.items().front().primary_label.starts_with("first in start "));
  // A block of 4cm x 2cm and a tray of 6cm square, side by side along the block: 2cm + 3cm apart.
  const Label& label = a->diagnostics.items().front().labels.front();
  CHECK(a->sources.text(label.span) == "(2cm, 2cm)");
  CHECK(label.text == "2.5cm is the least that fits these objects");
  CHECK(analyze_with_suite("layout fits like pairs { cells spots = grid 2 x 2 at (0cm, 0cm) spread "
                           "(2.5cm, 2.5cm) }\nvariant v of red_on_tray { layout fits }")
            ->codes() == "");
}

TEST_CASE("the advised spread keeps the shape of the grid, and there is none for fixed places") {
  const auto a = analyze_with_suite(
      "layout tight like pairs { cells spots = grid 2 x 2 at (0cm, 0cm) spread (2cm, 1cm) }\n"
      "variant v of red_on_tray { layout tight }");
  REQUIRE(a->codes() == "P0501");
  const std::string advice = a->diagnostics.items().front().labels.front().text;
  CHECK(advice == "(5cm, 2.5cm) is the least that fits these objects");
  const auto fixed = analyze_with_suite(
      "layout l { place source at (0cm, 0cm); place target at (1cm, 0cm); drop 1cm settle 1s }\n"
      "variant v of red_on_tray { layout l }");
  REQUIRE(fixed->codes() == "P0501");
  CHECK(fixed->diagnostics.items().front().labels.front().text == "the layout");
}

TEST_CASE("one cause is one error, with the number of tasks that it spoils") {
  const auto a = analyze_with_suite(
      "layout tight like pairs { cells spots = grid 2 x 2 at (0cm, 0cm) spread (2cm, 2cm) }\n"
      "variant u of red_on_tray { layout tight }\nvariant v of u { light night }\n"
      "variant w of u { say take }\n");
  CHECK_MESSAGE(a->codes() == "P0501", a->said());
  CHECK(a->said().find("note: the same holds for 2 more tasks") != std::string::npos);
}

TEST_CASE("other pairs that overlap are counted behind the first") {
  const auto a = analyze_with_suite(
      "layout l { place source at (0cm, 0cm); place target at (1cm, 0cm); place blue at (2cm, "
      "0cm); "
      "drop 1cm settle 1s }\ntask v like red_on_tray { layout l; distractors blue }");
  REQUIRE_MESSAGE(a->codes() == "P0501", a->said());
  CHECK(a->diagnostics.items().front().message.ends_with(" in 1 of 1 start of `v`"));
  CHECK(a->said().find("note: so do 2 other pairs of its objects") != std::string::npos);
}
