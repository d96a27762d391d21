#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

// A chest somewhere, with more statements, in the room of one more task.
std::unique_ptr<test::Analysis> at(const std::string& place, const std::string& more = "",
                                   const std::string& in_task = "") {
  return analyze_with_suite(std::string(test::kChest) + "fixture box like chest { at " + place +
                            "; " + more + " }\nscene hall like bench { fixture box }\n" +
                            "task t like red_on_tray { scene hall; " + in_task + " }");
}

}  // namespace

TEST_CASE("what stands in a fixture at the start is an error, with depth, place and how many") {
  const auto a = at("(10cm, 10cm, 85cm)");
  REQUIRE_MESSAGE(a->codes() == "P1302", a->said());
  const Diagnostic& said = a->diagnostics.items().front();
  CHECK(said.severity == Severity::kError);
  CHECK(said.message.find("stands in `box") != std::string::npos);
  CHECK(said.message.find(" starts") != std::string::npos);
}

TEST_CASE("what a drawer would meet on its way is a warning that can be allowed") {
  // The drawer opens along y, to 25 cm before its chest's middle: objects stand at -10 cm.
  const auto a = at("(10cm, -32cm, 85cm) yaw 90deg");
  REQUIRE_MESSAGE(a->codes() == "P1302", a->said());
  const Diagnostic& said = a->diagnostics.items().front();
  CHECK(said.severity == Severity::kWarning);
  CHECK_MESSAGE(said.message.find("is in the way of `box.drawer` in `t`: they overlap by") !=
                    std::string::npos,
                said.message);
  CHECK(said.message.find("when `box.slide` stands at ") != std::string::npos);
  CHECK(at("(10cm, -45cm, 85cm) yaw 90deg")->codes().empty());
}

TEST_CASE("where a joint starts decides between standing in a part and standing in its way") {
  const auto open = at("(10cm, -32cm, 85cm) yaw 90deg", "", "start box.slide 20cm");
  REQUIRE(open->codes() == "P1302");
  CHECK(open->diagnostics.items().front().severity == Severity::kError);
}

TEST_CASE("a part that would run into the surface is an error wherever its joint starts") {
  const auto a = at("(0cm, 30cm, 84.5cm)");
  REQUIRE_MESSAGE(a->codes() == "P1302", a->said());
  CHECK(a->diagnostics.items().front().message ==
        "`box.drawer` runs 0.5cm into the surface of `hall` when `box.slide` stands at 0cm");
}
