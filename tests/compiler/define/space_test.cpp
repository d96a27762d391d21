#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("a space whose points could not name files is refused") {
  const auto said = [](std::size_t letters) {
    const std::string name(letters, 'n');
    const auto a =
        analyze_with_suite("space " + name + " of red_on_tray { light ambient 0 .. 1000 }");
    if (!a->codes().empty()) CHECK_MESSAGE(a->underlined() == name, a->said());
    return a->codes();
  };
  CHECK(said(60) == "");
  CHECK(said(186) == "");  // and `_light.ambient`
  CHECK(said(187) == "P0304");
  CHECK(said(255) == "P0304");
  CHECK(said(256) == "P0304");
}

TEST_CASE("objects of clutter, which are copied under names of their own, count too") {
  const auto said = [](std::size_t letters) {
    const std::string name(letters, 'n');
    return analyze_with_suite("object " + name +
                              " like red {}\nspace s of red_on_tray { clutter 0 .. 4 from (" +
                              name + ") }")
        ->codes();
  };
  CHECK(said(190) == "");  // `s_clutter_` and the object's
  CHECK(said(191) == "P0304");
}
