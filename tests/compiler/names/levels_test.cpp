// Names that stand for further names: a stated limit in every order, and one message a mistake.
#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

// `first` for name 0 to count - 1, each through the next; the last one is `end`.
std::string chain(std::size_t count, const std::string& head, const std::string& tail,
                  const std::string& end, bool backward) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = backward ? count - 1 - i : i;
    const std::string means = at + 1 == count ? end : "z" + std::to_string(at + 1) + tail;
    text += head + " z" + std::to_string(at) + tail + " = " + means + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("a chain of sets or predicates has a stated depth, in either order") {
  for (const bool backward : {false, true}) {
    CAPTURE(backward);
    const auto sets = analyze_with_suite(chain(900, "set", "", "{ red_on_tray }", backward));
    CHECK(sets->codes().find("P0103") == std::string::npos);
    const auto calls = analyze_with_suite(chain(900, "predicate", "()", "time > 1s", backward));
    CHECK(calls->codes().find("P0103") == std::string::npos);
    const auto many = analyze_with_suite(chain(20000, "predicate", "()", "time > 1s", backward));
    CHECK(many->codes().find("P0103") != std::string::npos);
  }
  const auto many = analyze_with_suite(chain(20000, "set", "", "{ red_on_tray }", false));
  CHECK(many->codes().find("P0103") != std::string::npos);
  CHECK(many->codes().find("P0211") == std::string::npos);
}

TEST_CASE("what is wrong with a set that a suite lists is said once") {
  const auto circle = analyze_with_suite("set zz = zz\nsuite t { tasks zz; seeds 1 }");
  CHECK_MESSAGE(circle->codes() == "P0207", circle->said());
  const auto sample =
      analyze_with_suite("set few = sample 99 of tasks seed 1\nsuite t { tasks few; seeds 1 }");
  CHECK_MESSAGE(sample->codes() == "P0304", sample->said());
  const auto empty = analyze_with_suite(
      "set none = { red_on_tray } - { red_on_tray }\nsuite t { tasks none | tasks; seeds 1 }");
  CHECK_MESSAGE(empty->codes() == "P0211", empty->said());
}
