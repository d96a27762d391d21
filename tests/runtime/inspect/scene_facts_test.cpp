#include "runtime/inspect/scene_facts.h"

#include "tests/runtime/inspect/small_plan.h"
#include "tests/runtime/run/plan_of_text.h"

using namespace probe;
using namespace probe::inspect;

namespace {

std::string fact(const std::vector<SceneFact>& facts, std::string_view name) {
  for (const SceneFact& one : facts)
    if (name == one.name) return one.text;
  return "not told";
}

std::vector<SceneFact> facts_of(const plan::Plan& plan, std::string_view task) {
  return scene_facts(plan, plan.tasks()[plan.find_task(task).value()].scene);
}

std::vector<SceneFact> in_place(const plan::Plan& plan, std::string_view task) {
  return facts_in_place(plan, plan.tasks()[plan.find_task(task).value()].scene);
}

// The table with its robot moved and turned, and slippery.
const char* const kInPlace = R"(
@allow(confounded, "a test")
variants of base {
  aside  { scene { robot at (14.7cm, 3cm, 87cm) yaw 190deg } }
  slick  { scene { physics 250Hz friction 0.1 } }
}
suite more { tasks { base, aside, slick }; seeds 1 }
)";

}  // namespace

TEST_CASE("facts of a scene are told in the units of the text") {
  const auto facts = facts_of(test::small_plan(), "base");
  REQUIRE(facts.size() == 8);
  CHECK(fact(facts, "base") == "at (14.7, 2.8, 87) cm, yaw 180 deg");
  CHECK(fact(facts, "posture").starts_with("-0.0184078, 0.0398835, 0.222427"));
  CHECK(fact(facts, "area") == "(-34, -20) cm .. (4, 20) cm");
  CHECK(fact(facts, "physics") == "500 Hz, friction 1");
  CHECK(fact(facts, "air").ends_with(" Pa s"));
  CHECK(fact(facts, "stands") == "none");
  CHECK(fact(facts, "backdrop") == "scenes/table/visual.glb");
  CHECK(fact(facts, "photo") == "none");
}

TEST_CASE("of a scene whose name others have, what differs is told, and nothing of one alone") {
  CHECK(in_place(test::small_plan(), "base").empty());
  const plan::Plan plan = test::compile_small(kInPlace);
  const auto base = in_place(plan, "base");
  REQUIRE(base.size() == 2);
  CHECK(fact(base, "base") == "at (14.7, 2.8, 87) cm, yaw 180 deg");
  CHECK(fact(base, "physics") == "500 Hz, friction 1");
  CHECK(fact(in_place(plan, "aside"), "base") == "at (14.7, 3, 87) cm, yaw -170 deg");
  CHECK(fact(in_place(plan, "slick"), "physics") == "250 Hz, friction 0.1");
}

TEST_CASE("what stands in a scene is told with its place") {
  const std::string suites = VLAPROBE_SOURCE_DIR "/suite/";
  const plan::Plan google = run::plan_of_file(suites + "google.probe", "google");
  const auto facts = facts_of(google, "open_top");
  CHECK(fact(facts, "stands").starts_with("station at ("));
  CHECK(fact(facts, "base").ends_with("yaw 180 deg"));
}
