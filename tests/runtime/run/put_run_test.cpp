// What a layout puts in and on other things, from the text to the settled start.
#include <doctest/doctest.h>

#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

RunSummary first_start(const plan::Plan& plan, const std::string& out, const std::string& task) {
  RunOptions options = options_for(out, "null");
  options.tasks = task;
  options.episodes = {0, 0};
  return must_run(plan, options);
}

TEST_CASE("what begins in a drawer that is ajar and on a plate lies there when all is at rest") {
  TemporaryFolder folder;
  const plan::Plan plan =
      plan_of_file(std::string(VLAPROBE_SOURCE_DIR) + "/examples/put_away.probe");
  const RunSummary summary = first_start(plan, folder / "run", "take_out");
  CHECK(summary.done == 1);
  CHECK(summary.invalid == 0);
}

TEST_CASE("what does not lie where it was put makes the episode invalid, and that is said") {
  TemporaryFolder folder;
  // In the air before the cabinet.
  const plan::Plan plan = plan_of_text(
      "use \"suite/intact.probe\"\n"
      "fixture cabinet { urdf \"fixtures/cabinet/cabinet.urdf\"; at (-27cm, 30cm, 87cm)\n"
      "  region air of cabinet box (18cm, -33cm, 10cm) .. (28cm, -23cm, 20cm) }\n"
      "scene furnished like table { fixture cabinet }\n"
      "layout hung {\n"
      "  cells spots = grid 2 x 1 at (-22cm, 0cm) spread (4cm, 0cm)\n"
      "  place target in distinct spots; place source in cabinet.air; drop 50cm settle 0.5s }\n"
      "task falls like carrot_on_plate { scene furnished; source green_cube; layout hung }\n"
      "suite mine { tasks { falls }; seeds 1 }\n");
  const RunSummary summary = first_start(plan, folder / "run", "falls");
  CHECK(summary.invalid == 1);
  const auto rows = read_results(folder / "run");
  REQUIRE(rows.ok());
  CHECK(rows->front().invalid.value_or("").find(
            "\"green_cube in cabinet.air\" does not hold in the settled start: it has moved") !=
        std::string::npos);
}

}  // namespace
}  // namespace probe::run
