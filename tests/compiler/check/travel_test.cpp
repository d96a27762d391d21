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

TEST_CASE("what would fall onto a fixture is a warning that says how to mean it") {
  // The chest hangs 5 cm above the blocks, which fall from 10 cm.
  const auto a = at("(10cm, 10cm, 93cm)");
  REQUIRE_MESSAGE(a->codes() == "P1302", a->said());
  const Diagnostic& said = a->diagnostics.items().front();
  CHECK(said.severity == Severity::kWarning);
  CHECK_MESSAGE(said.message.find(" falls onto `box") != std::string::npos, said.message);
}

TEST_CASE("two fixtures that stand in one another are an error, that meet on the way a warning") {
  const auto two = [](const char* place) {
    return analyze_with_suite(std::string(test::kChest) + "fixture twin like chest { at " + place +
                              " }\nscene hall like bench { fixture chest, twin }\n");
  };
  const auto inside = two("(4cm, 30cm, 85cm) yaw 90deg");
  REQUIRE_MESSAGE(!inside->diagnostics.items().empty(), inside->said());
  CHECK(inside->diagnostics.items().front().severity == Severity::kError);
  CHECK_MESSAGE(inside->said().find("stand in one another by ") != std::string::npos,
                inside->said());
  // It stands 15 cm before the drawer, which opens by 20 cm.
  const auto before = two("(0cm, 50cm, 85cm) yaw 90deg");
  REQUIRE_MESSAGE(before->codes() == "P1302", before->said());
  CHECK(before->diagnostics.items().front().severity == Severity::kWarning);
  CHECK_MESSAGE(before->said().find("when `chest.slide` stands at ") != std::string::npos,
                before->said());
  CHECK(two("(30cm, 30cm, 85cm) yaw 90deg")->codes().empty());
}
