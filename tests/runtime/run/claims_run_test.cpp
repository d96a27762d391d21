// An instruction that says where things are, judged once more where they have come to rest: a spoon
// that is put down on its end is left of the cube, falls over and lies right of it.
#include <doctest/doctest.h>

#include <string>

#include "runtime/plan/claims.h"
#include "runtime/rejudge/explain.h"
#include "runtime/rejudge/rejudge.h"
#include "runtime/run/replay.h"
#include "runtime/store/proof.h"
#include "tests/runtime/run/claims_plan.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

RunOptions one_start(const std::string& out) {
  RunOptions options = options_for(out, "null");
  options.episodes = {0, 0};
  return options;
}

TEST_CASE("the words of a task are in the plan as claims of the bodies that they may denote") {
  const plan::Plan& plan = claims_plan();
  const auto claims = plan::claims_of(plan.tables(), plan.find_task("falls").value());
  REQUIRE(claims.size() == 1);
  CHECK(plan.text(claims[0].text) == "spoon left of the green cube");
  CHECK(claims[0].body == 0);
  CHECK(plan.claims().size() == 2);
  CHECK(plan.claims()[0].program == plan.claims()[1].program);
}

TEST_CASE("an episode whose words are not so in the settled start is invalid and says what is so") {
  TemporaryFolder folder;
  const RunSummary summary = must_run(claims_plan(), one_start(folder / "run"));
  CHECK(summary.done == 2);
  CHECK(summary.invalid == 1);
  const auto proven = store::read_proven_results(folder / "run");
  REQUIRE(proven.ok());
  CHECK(proven->refused.empty());
  REQUIRE(proven->rows.size() == 2);
  for (const ResultRow& row : proven->rows) {
    if (row.task == "stays") CHECK_MESSAGE(!row.invalid, row.invalid.value_or(""));
    if (row.task != "falls") continue;
    REQUIRE(row.invalid);
    CHECK(row.steps == 0);
    CHECK_MESSAGE(row.invalid->starts_with(
                      "start: \"spoon left of the green cube\" does not hold in the settled start: "
                      "it denotes nothing: `standing` at ("),
                  *row.invalid);
  }

  ReplayOptions replaying;
  replaying.verify = true;
  replaying.assets = one_start("").assets;
  const auto again = replay(folder / "run", "falls", 0, std::nullopt, replaying);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK_MESSAGE(again->identical, again->difference);

  const auto why = rejudge::why(folder / "run", "falls", 0, std::nullopt, "");
  REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
  REQUIRE(why->claims.size() == 1);
  CHECK(why->claims[0].object == "standing");
  CHECK(why->claims[0].denoted.empty());
  CHECK(!why->claims[0].holds);

  const auto judged = rejudge::rejudge(folder / "run", claims_plan());
  REQUIRE_MESSAGE(judged.ok(), to_text(judged.failure()));
  CHECK(judged->valid == 1);
  CHECK(judged->invalid == 1);
}

}  // namespace
}  // namespace probe::run
