// Runs that stop by what they find, on the real world: how many episodes, the same ones after a stop,
// what is refused, and how such a folder becomes an ordinary one.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <set>

#include "runtime/adaptive/sampled.h"
#include "runtime/policy/scripted.h"
#include "runtime/run/adaptive_jobs.h"
#include "runtime/run/policies.h"
#include "runtime/run/run.h"
#include "runtime/store/chosen.h"
#include "runtime/store/merge.h"
#include "runtime/store/store.h"
#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
using namespace probe::store;
namespace {

namespace fs = std::filesystem;

RunOptions until(RunOptions options, const std::string& rule) {
  options.until = *adaptive::parse_rule(rule);
  return options;
}

RunOptions dropping(RunOptions options) {
  options.drops_until = true;
  return options;
}

std::set<EpisodeKey> keys_of(const std::string& dir) {
  std::set<EpisodeKey> keys;
  const auto rows = read_results(dir);
  REQUIRE(rows.ok());
  for (const ResultRow& row : *rows) keys.insert(store::key_of(row));
  return keys;
}

std::string refusal(const plan::Plan& plan, const RunOptions& options) {
  const auto refused = run::run(plan, options);
  REQUIRE_FALSE(refused.ok());
  return refused.failure().message;
}

// Two tasks of a few steps, which a policy that stands still never does.
plan::Plan two_tasks(const std::string& seeds = "42") {
  return plan_of_text(
      "use \"suite/intact.probe\"\n"
      "task one like carrot_on_plate { horizon 5 steps }\n"
      "task two like spoon_on_towel { horizon 5 steps }\n"
      "suite mine trained on bridge_v2 { tasks { one, two }; seeds " + seeds + " }\n");
}

TEST_CASE("each task stops where its rate is known, in one call, in several and in shards") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks();
  const RunSummary summary =
      must_run(plan, until(options_for(folder / "run", "null"), "width 10%"));
  CHECK(summary.total == 48);
  CHECK(summary.done == 2 * 19);  // of 24 that never succeed
  REQUIRE(summary.until.size() >= 3);
  CHECK(summary.until[0].find("38 of 48 episodes count") != std::string::npos);
  CHECK(summary.until[1].find("one: 19 of 24 episodes, 0 of 19 succeed, 0 to 8 %") !=
        std::string::npos);
  CHECK(read_chosen(folder / "run") == 38);
  const RunSummary again =
      must_run(plan, until(options_for(folder / "run", "null"), "width 10%"));
  CHECK(again.done == 0);
  CHECK(again.until == summary.until);

  // Stopped after a few, and by two worlds: the same episodes.
  RunOptions parts = until(options_for(folder / "parts", "null"), "width 10%");
  std::atomic<int> asked = 0;
  parts.stopped = [&] { return ++asked > 11; };
  CHECK_FALSE(run::run(plan, parts).ok());
  parts.stopped = {};
  parts.jobs = 2;
  must_run(plan, parts);
  CHECK(keys_of(folder / "parts") == keys_of(folder / "run"));

  std::vector<std::string> shards;
  for (int shard = 1; shard <= 3; ++shard) {
    RunOptions options = until(options_for(folder / std::to_string(shard), "null"), "width 10%");
    options.shard = shard;
    options.shards = 3;
    must_run(plan, options);
    shards.push_back(options.out);
  }
  const auto merged = merge({shards, folder / "merged"});
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
  CHECK(keys_of(folder / "merged") == keys_of(folder / "run"));
  CHECK(read_order(folder / "merged")->size() == 48);
  CHECK(adaptive::read_adaptive(folder / "merged").value()->drawing == stats::Drawing::kInTurn);
  // It goes on like a run that had no shards.
  CHECK(must_run(plan, until(options_for(folder / "merged", "null"), "width 10%")).done == 0);
  CHECK(must_run(plan, dropping(options_for(folder / "merged", "null"))).done == 10);
  CHECK(read_run_record(folder / "merged")->identity.until.empty());
  // A shard of nothing drops its rule like the others, and goes with them.
  for (int shard = 1; shard <= 3; ++shard) {
    RunOptions options = dropping(options_for(folder / std::to_string(shard), "null"));
    options.shard = shard;
    options.shards = 3;
    must_run(plan, options);
    CHECK(read_run_record(options.out)->identity.until.empty());
  }
  const auto all = merge({shards, folder / "all"});
  REQUIRE_MESSAGE(all.ok(), to_text(all.failure()));
  CHECK(keys_of(folder / "all").size() == 48);
  must_run(plan, options_for(folder / "whole", "null"));
  const auto mixed = merge({{folder / "run", folder / "whole"}, folder / "mixed"});
  REQUIRE_FALSE(mixed.ok());
  CHECK(mixed.failure().message.find("stops by `--until`") != std::string::npos);
}

TEST_CASE("a call of two worlds that fails left an episode, so tasks were chosen by more than is stored") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks();
  std::atomic<int> made = 0;
  RunOptions options = until(options_for(folder / "run", "mine"), "width 10%");
  options.jobs = 2;
  options.own_policy = OwnPolicy{
      {}, [&](const PolicyContext& context) -> Result<std::unique_ptr<policy::Policy>> {
        // Asked once before the run, then by each world.
        if (++made == 3) return Failure{Fault::kIo, "no room", "disk"};
        const auto choice = choose_policy("null");
        return make_policy(*choice, context);
      }};
  CHECK(refusal(plan, options).find("no room") != std::string::npos);
  CHECK(adaptive::read_adaptive(folder / "run").value()->drawing == stats::Drawing::kAnyhow);
}

TEST_CASE("two tasks with the same episodes have orders of their own") {
  const plan::Plan plan = plan_of_text(
      "use \"suite/intact.probe\"\n"
      "task one like carrot_on_plate { horizon 5 steps }\n"
      "task two like carrot_on_plate { horizon 5 steps }\n"
      "suite mine trained on bridge_v2 { tasks { one, two }; seeds 42 }\n");
  REQUIRE(plan.episodes(plan.tasks()[0])[0].episode_id == plan.episodes(plan.tasks()[1])[0].episode_id);
  std::vector<EpisodeJob> jobs;
  for (std::uint32_t task = 0; task < 2; ++task)
    for (std::uint32_t index = 0; index < 24; ++index) jobs.push_back({task, index, 42});
  adaptive::Rule rule = *adaptive::parse_rule("width 10%");
  REQUIRE(put_in_order(rule, plan, "", jobs).ok());
  std::vector<std::uint32_t> starts[2];
  for (const EpisodeJob& job : jobs) starts[job.task].push_back(job.index);
  CHECK(starts[0] != starts[1]);
}

TEST_CASE("all tasks together stop in one order, which no shard has") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks();
  RunOptions options = until(options_for(folder / "run", "null"), "width 10% of all");
  const RunSummary summary = must_run(plan, options);
  CHECK(summary.done < 2 * 19);
  CHECK(summary.until.back().find("all tasks, each weighted by its episodes: 0.0 %") !=
        std::string::npos);
  options.out = folder / "shard";
  options.shards = 2;
  CHECK(refusal(plan, options).find("one order of all episodes") != std::string::npos);
  CHECK_FALSE(fs::exists(folder / "shard"));
}

TEST_CASE("rule, tasks and seeds stay as they were, until the rule is dropped and all is run") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks();
  const RunOptions plain = options_for(folder / "run", "null");
  must_run(plan, until(plain, "width 10%"));
  CHECK(refusal(plan, plain).find("`--until none` runs the others") != std::string::npos);
  CHECK(refusal(plan, until(plain, "width 5%")).find("(width 5 % of each task)") !=
        std::string::npos);
  RunOptions fewer = until(plain, "width 10%");
  fewer.tasks = "one";
  CHECK(refusal(plan, fewer).find("was begun over 48 episodes") != std::string::npos);
  RunOptions dropping_some = dropping(plain);
  dropping_some.tasks = "one";
  CHECK(refusal(plan, dropping_some).find("was begun over 48 episodes") != std::string::npos);

  // Cut off before the end it is what it was.
  RunOptions cut = dropping(plain);
  std::atomic<int> asked = 0;
  cut.stopped = [&] { return ++asked > 5; };
  CHECK_FALSE(run::run(plan, cut).ok());
  CHECK_FALSE(read_run_record(folder / "run")->identity.until.empty());
  const RunSummary all = must_run(plan, dropping(plain));
  CHECK(all.until.empty());
  CHECK(read_run_record(folder / "run")->identity.until.empty());
  CHECK(read_order(folder / "run")->empty());
  CHECK(must_run(plan, plain).done == 0);
  CHECK(keys_of(folder / "run").size() == 48);
  // Of an ordinary run nothing is dropped.
  CHECK(must_run(plan, dropping(plain)).done == 0);
  CHECK(refusal(plan, until(plain, "width 10%")).find("runs all its episodes, not one that stops") !=
        std::string::npos);
}

TEST_CASE("what a rule cannot be vouched for with is refused before there is a folder") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks();
  must_run(plan, options_for(folder / "whole", "null"));
  RunOptions options = until(options_for(folder / "run", "null"), "width 10%");
  options.only_success = true;
  CHECK(refusal(plan, options).find("of successes alone there is none") != std::string::npos);
  CHECK(refusal(plan, until(options_for(folder / "run", "replay:" + (folder / "whole")), "width 10%"))
            .find("is no sample of anything") != std::string::npos);
  const auto against = [&](const std::string& dir) {
    return refusal(plan, until(options_for(folder / "run", "null"), "decided-against " + dir));
  };
  CHECK(against(folder / "nothing").find("no run here") != std::string::npos);
  CHECK(against(folder / "run").find("against the run itself") != std::string::npos);
  must_run(two_tasks("7"), options_for(folder / "plan", "null"));
  CHECK(against(folder / "plan").find("another plan") != std::string::npos);
  RunOptions seeds = options_for(folder / "seeds", "null");
  seeds.seeds = {7};
  must_run(plan, seeds);
  CHECK(against(folder / "seeds").find("no valid episode for 48 of the 48 that are chosen") !=
        std::string::npos);
  must_run(plan, until(options_for(folder / "until", "null"), "width 10%"));
  CHECK(against(folder / "until").find("stopped by what it found") != std::string::npos);
  CHECK_FALSE(fs::exists(folder / "run"));
}

TEST_CASE("episodes that are invalid are done again, and else count as either") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(24, 2);
  std::atomic<int> begun = 0;
  bool fails = true;
  class Failing final : public policy::Policy {
   public:
    explicit Failing(bool fails) : fails_(fails) {}
    Status begin(const policy::EpisodeStart&) override { return {}; }
    Result<policy::Action> act(const policy::Observation&) override {
      if (fails_) return Failure{Fault::kPolicy, "gone", "h:1"};
      return policy::Action{0, 0, 0, 0, 0, 0, 1};
    }

   private:
    bool fails_;
  };
  class Sometimes final : public policy::Policy {
   public:
    Sometimes(std::atomic<int>& begun, bool& fails) : begun_(begun), fails_(fails) {}
    Status begin(const policy::EpisodeStart& start) override {
      inner_ = std::make_unique<Failing>(fails_ && begun_++ == 3);
      return inner_->begin(start);
    }
    Result<policy::Action> act(const policy::Observation& o) override { return inner_->act(o); }

   private:
    std::atomic<int>& begun_;
    bool& fails_;
    std::unique_ptr<policy::Policy> inner_;
  };
  RunOptions options = until(options_for(folder / "run", "mine"), "width 10%");
  options.own_policy =
      OwnPolicy{{}, [&](const PolicyContext&) -> Result<std::unique_ptr<policy::Policy>> {
                  return std::unique_ptr<policy::Policy>(std::make_unique<Sometimes>(begun, fails));
                }};
  const RunSummary first = must_run(plan, options);
  CHECK(first.invalid == 1);
  CHECK(first.done > 19);  // it may have been a success
  CHECK(first.until[1].find("1 invalid may have been either") != std::string::npos);
  fails = false;
  const RunSummary second = must_run(plan, options);
  CHECK(std::ranges::any_of(second.notes, [](const std::string& note) {
    return note.find(" is run again if the rule needs it: ") != std::string::npos;
  }));
  CHECK(second.done == 1);
  CHECK(second.until[1].find("invalid") == std::string::npos);
}

TEST_CASE("a run is stopped when it is decided which of two is better") {
  TemporaryFolder folder;
  const plan::Plan plan = plan_of_text(
      "use \"suite/intact.probe\"\n"
      "suite mine trained on bridge_v2 { tasks { carrot_on_plate }; seeds 42 }\n");
  RunOptions old = options_for(folder / "old", "null");
  old.episodes = {0, 11};
  must_run(plan, old);
  const std::string rule = "decided-against " + (folder / "old");
  RunOptions options = until(options_for(folder / "run", "expert"), rule);
  options.episodes = {0, 11};
  const RunSummary summary = must_run(plan, options);
  CHECK(summary.done == 7);  // 1 of 2^7 in the mixture's measure
  CHECK(summary.until.back().find("better than `null` on these starts (7 starts") !=
        std::string::npos);
  CHECK(must_run(plan, options).done == 0);
  RunOptions wrong = until(options_for(folder / "equal", "null"), rule);
  wrong.name = "another null";
  wrong.episodes = {0, 11};
  const RunSummary equal = must_run(plan, wrong);
  CHECK(equal.done == 12);
  CHECK(equal.until.back().find("not decided against `null`") != std::string::npos);
  // What it is compared with has changed since.
  fs::remove_all(folder / "old");
  RunOptions other = options_for(folder / "old", "expert");
  other.episodes = {0, 11};
  must_run(plan, other);
  CHECK(refusal(plan, options).find("not one that stops by `--until` (decided against `expert`") !=
        std::string::npos);
  // The rule can be dropped without it.
  fs::remove_all(folder / "old");
  RunOptions all = dropping(options_for(folder / "run", "expert"));
  all.episodes = {0, 11};
  CHECK(must_run(plan, all).done == 5);
}

}  // namespace
}  // namespace probe::run
