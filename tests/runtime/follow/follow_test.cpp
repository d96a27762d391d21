// A run seen while it grows.
#include "runtime/follow/follow.h"

#include <doctest/doctest.h>

#include "runtime/run/run.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::follow {
using namespace probe::run;
namespace {

Seen looked(Following& following, double now) {
  auto seen = following.look(now);
  REQUIRE_MESSAGE(seen.ok(), to_text(seen.failure()));
  return *seen;
}

TEST_CASE("a folder that is not there yet has no rows, and a run of it is seen while it grows") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  Following following(dir);
  CHECK(looked(following, 0).rows == 0);
  const plan::Plan plan = table_plan(4, 6);
  RunOptions options = options_for(dir);
  options.episodes = {0, 0};
  REQUIRE(run::run(plan, options).ok());
  Seen seen = looked(following, 10);
  const auto one = seen.rows;
  CHECK(one > 0);
  CHECK(seen.chosen == one);
  CHECK(seen.is_done());
  CHECK(seen.per_s == static_cast<double>(one) / 10);
  CHECK(to_lines(seen)[0].find(", done") != std::string::npos);
  options.episodes.reset();
  REQUIRE(run::run(plan, options).ok());
  seen = looked(following, 20);
  CHECK(seen.rows > one);
  CHECK(seen.rates[0].second.n == seen.rows);
  // `null` never succeeds: each failure is told with the command that explains it.
  REQUIRE(!seen.newest.empty());
  const auto lines = to_lines(seen);
  CHECK(lines.back().find("vlaprobe why " + dir) != std::string::npos);
  CHECK(to_json(seen)["episodes"] == seen.rows);
  CHECK(to_json(seen)["newest_failures"].size() == seen.newest.size());
}

TEST_CASE("shards count together, and those that have not begun are scaled up") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(4, 6);
  RunOptions options = options_for(folder / "run/shards/1-of-2");
  options.shard = 1;
  options.shards = 2;
  REQUIRE(run::run(plan, options).ok());
  Following following(folder / "run");
  Seen seen = looked(following, 0);
  CHECK(seen.shards == 2);
  CHECK(seen.begun == 1);
  CHECK(seen.is_about);
  CHECK(!seen.is_done());
  CHECK(seen.chosen == 2 * seen.rows);
  CHECK(to_lines(seen)[0].find("1 of 2 shards begun") != std::string::npos);
  options.out = folder / "run/shards/2-of-2";
  options.shard = 2;
  REQUIRE(run::run(plan, options).ok());
  seen = looked(following, 5);
  CHECK(seen.is_done());
}

TEST_CASE("time is said in words") {
  CHECK(duration_text(40) == "40 s");
  CHECK(duration_text(720) == "12 min");
  CHECK(duration_text(11100) == "3 h 05 min");
}

}  // namespace
}  // namespace probe::follow
