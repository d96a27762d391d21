// Mistakes about things that move, roles and robots: each is told with its place and what mends it.
// Tables of starts: tests/golden/P0304_quaternion, P1501_table, P1502_lacking. Phrases that are clear in
// some starts only: tests/compiler/check/phrase_test. A robot without fingers: control_test. Drawers in
// the way: tests/compiler/check/travel_test.
#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

std::string said(const std::string& text) {
  return test::analyze_with_suite(std::string(test::kChest) + text)->said();
}
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string fixture_with(const std::string& statement) {
  return "fixture desk like chest { " + statement + " }\n";
}

}  // namespace

TEST_CASE("a joint that the description lacks is told with those that it has") {
  const std::string text = said(fixture_with("joint lid friction 1N"));
  CHECK_MESSAGE(has(text, "error[P0201]: unknown joint `lid`"), text);
  CHECK_MESSAGE(has(text, "there are `slide`, `ring`, `hinge`"), text);
}

TEST_CASE("a joint that is fixed is told so") {
  const std::string text = said(fixture_with("joint glue friction 1N"));
  CHECK_MESSAGE(has(text, "glue"), text);
  CHECK_MESSAGE(has(text, "error["), text);
}

TEST_CASE("a start outside a joint's limits is told with what it may be") {
  const std::string slide = said(fixture_with("joint slide friction 1N start 60cm"));
  CHECK_MESSAGE(has(slide, "joint `slide` starts at 0.6, beyond its limits of 0 and 0.2"), slide);
  CHECK_MESSAGE(has(slide, "it may start at 0cm to 20cm"), slide);
  const std::string hinge = said(fixture_with("joint hinge friction 1Nm start 90deg"));
  CHECK_MESSAGE(has(hinge, "it may start at -1.5rad to 0rad"), hinge);
}

TEST_CASE("a region of nothing is told with the parts that there are") {
  const std::string text =
      said(fixture_with("region shelf of lid2 box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1cm)"));
  CHECK_MESSAGE(has(text, "unknown part of `desk` `lid2`"), text);
  CHECK_MESSAGE(has(text, "`drawer`"), text);
}

TEST_CASE("a role that nothing fills is told with how to fill it") {
  const std::string text = said(
      "role helper\nmetrics m { success = at end height(helper) > height(source) + 1cm }\n"
      "task t like red_on_tray { metrics m }\n");
  CHECK_MESSAGE(has(text, "error[P1102]: nothing fills role `helper` in task `t`"), text);
  CHECK_MESSAGE(has(text, "write `helper OBJECT`"), text);
}

TEST_CASE("what a layout does not place is told with the line that places it") {
  const std::string role = said(
      "role helper\nmetrics m { success = at end height(helper) > height(source) + 1cm }\n"
      "task t like red_on_tray { metrics m; helper blue }\n");
  CHECK_MESSAGE(has(role, "places no `blue` in `t`"), role);
  CHECK_MESSAGE(has(role, "{ place helper at (X, Y) }`"), role);
}

TEST_CASE("a role that words speak of is told with how to fill it, and with how to do without") {
  const std::string text = said("task t like red_on_tray { target none }\n");
  CHECK_MESSAGE(has(text, "task `t` has no `target`"), text);
  CHECK_MESSAGE(has(text, "write `target OBJECT`; a task without one has words, metrics and a layout "
                          "that do not speak of `target`"),
                text);
}
