// A run seen while it grows.
#include "runtime/follow/follow.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "runtime/follow/drawing.h"
#include "runtime/run/run.h"
#include "runtime/store/merge.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_run.h"

namespace probe::follow {
using namespace probe::run;
namespace {

namespace fs = std::filesystem;

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

TEST_CASE("of a run that stops by what it finds counts are told, and no interval of a fixed number") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  RunOptions options = options_for(dir);
  options.until = *adaptive::parse_rule("width 20% of all");
  REQUIRE(run::run(table_plan(24, 2), options).ok());
  Following following(dir);
  const Seen seen = looked(following, 5);
  CHECK(seen.until == "width 20 % of all tasks");
  CHECK(seen.rows < 24);
  CHECK(seen.is_done());
  const Json json = to_json(seen);
  CHECK(json.at("rates")[0].find("low") == nullptr);
  const std::vector<std::string> lines = to_lines(seen);
  CHECK(lines[1].find("until width 20 % of all tasks; `vlaprobe results ") != std::string::npos);
  for (const std::string& line : lines) CHECK(line.find("[") == std::string::npos);
  Seen of_search = seen;
  of_search.until = store::kBySearch;
  const std::string search = to_lines(of_search)[1];
  CHECK(search.find("is of a search, which chose its episodes") != std::string::npos);
  CHECK(search.find("vlaprobe search show ") != std::string::npos);
  CHECK(search.find("vlaprobe results ") == std::string::npos);
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

// A run of the table's plan in two shards below `out`, merged into it.
void make_merged(const std::string& out, const plan::Plan& plan) {
  store::MergeOptions merging{.dirs = {}, .out = out};
  for (const int shard : {1, 2}) {
    merging.dirs.push_back(out + "/shards/" + std::to_string(shard) + "-of-2");
    RunOptions options = options_for(merging.dirs.back());
    options.shard = shard;
    options.shards = 2;
    REQUIRE(run::run(plan, options).ok());
  }
  const auto merged = store::merge(merging);
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
}

TEST_CASE("a shard that was merged and removed counts as what it was") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  make_merged(dir, table_plan(4, 6));
  Following before(dir);
  const Seen whole = looked(before, 0);
  CHECK(whole.is_done());
  CHECK(whole.rows == whole.chosen);
  fs::remove_all(dir + "/shards/1-of-2");
  Following anew(dir);
  for (Following* following : {&before, &anew}) {
    const Seen seen = looked(*following, 5);
    CHECK(seen.rows == whole.rows);
    CHECK(seen.chosen == whole.chosen);
    CHECK(!seen.is_about);
    CHECK(seen.is_done());
    CHECK(seen.rates.size() == whole.rates.size());
    CHECK(seen.rates[0].second.n == whole.rates[0].second.n);
    CHECK(to_lines(seen)[0].find("1 of 2 shards merged and removed") != std::string::npos);
  }
}

TEST_CASE("a failure that came out well when it was run again is none any more") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  REQUIRE(run::run(table_plan(4, 6), options_for(dir)).ok());
  Following following(dir);
  const std::size_t failed = looked(following, 0).newest.size();
  REQUIRE(failed > 1);
  store::change_database(dir, "update episodes set metrics = '[[\"success\",1,1.0]]' where episode = 0");
  const Seen seen = looked(following, 5);
  CHECK(seen.newest.size() < failed);
  for (const Failure& failure : seen.newest) CHECK(failure.key.episode != 0);
}

TEST_CASE("lines are drawn in the place of the last ones, each in one row of the terminal") {
  Drawing drawing;
  CHECK(drawing.next({"one", "two"}, 80, 24) == "\r\033[Kone\n\r\033[Ktwo\n\033[J");
  CHECK(drawing.next({"three"}, 80, 24) == "\033[2A\r\033[Kthree\n\033[J");
  // A line that does not fit would be found in two rows.
  CHECK(drawing.next({"0123456789"}, 8, 24) == "\033[1A\r\033[K012345\u2026\n\033[J");
  CHECK(drawing.next({"a", "b", "c", "d"}, 80, 3) == "\033[1A\r\033[Ka\n\r\033[Kb\n\033[J");
  CHECK(drawing.next({"e"}, 0, 0) == "\033[2A\r\033[Ke\n\033[J");
  // Letters of several bytes are not cut within.
  CHECK(Drawing().next({"\u00e4\u00e4\u00e4\u00e4"}, 4, 9) == "\r\033[K\u00e4\u00e4\u2026\n\033[J");
}

TEST_CASE("time is said in words") {
  CHECK(duration_text(40) == "40 s");
  CHECK(duration_text(720) == "12 min");
  CHECK(duration_text(11100) == "3 h 05 min");
}

}  // namespace
}  // namespace probe::follow
