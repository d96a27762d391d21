// What a policy server's failures and changed inputs do to a run.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>

#include "compiler/emit/compile.h"
#include "runtime/policy/query_meter.h"
#include "runtime/policy/scripted.h"
#include "runtime/run/run.h"
#include "runtime/run/selection.h"
#include "runtime/store/store.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
using namespace probe::store;
namespace {

namespace fs = std::filesystem;

// Stays still and fails in the episodes whose number of begin() calls, over all worlds, `fails`
// holds for: as a server does that is restarted now and then.
class Unsteady final : public policy::Policy {
 public:
  Unsteady(std::atomic<int>& begun, std::function<bool(int)> fails, policy::QueryMeter* meter,
           Fault fault)
      : begun_(begun), fails_(std::move(fails)), meter_(meter), fault_(fault) {}
  Status begin(const policy::EpisodeStart&) override {
    failing_ = fails_(begun_++);
    return {};
  }
  Result<policy::Action> act(const policy::Observation& observation) override {
    const policy::QueryMeter::InFlight flight(meter_);
    if (failing_ && observation.step == 1) return Failure{fault_, "closed in mid-message", "h:1"};
    return policy::Action{0, 0, 0, 0, 0, 0, 1};
  }

 private:
  std::atomic<int>& begun_;
  std::function<bool(int)> fails_;
  policy::QueryMeter* meter_;
  Fault fault_;
  bool failing_ = false;
};

struct Server {
  std::atomic<int> begun = 0;
  Fault fault = Fault::kPolicy;

  RunOptions options(const std::string& out, std::function<bool(int)> fails,
                     const std::string& content = "profile a sha256 1") {
    RunOptions options;
    options.policy = "served";
    options.out = out;
    options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
    options.own_policy = OwnPolicy{
        {.content = content},
        [this,
         fails](const run::PolicyContext& context) -> Result<std::unique_ptr<policy::Policy>> {
          return std::unique_ptr<policy::Policy>(
              std::make_unique<Unsteady>(begun, fails, context.queries, fault));
        }};
    return options;
  }
};

bool never(int) { return false; }
bool always(int) { return true; }

TEST_CASE("an episode that the server spoils is tried again at once, with the same trace") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(3, 3);
  Server steady, unsteady;
  const RunSummary calm = must_run(plan, steady.options(folder / "calm", never));
  CHECK(calm.call.retried == 0);
  CHECK(calm.call.queries.queries == 9);
  CHECK(calm.call.observations == 9);
  const RunSummary rough = must_run(
      plan, unsteady.options(folder / "rough", [](int begun) { return begun == 0 || begun == 2; }));
  CHECK(rough.invalid == 0);
  CHECK(rough.done == 3);
  CHECK(rough.call.retried == 2);
  CHECK(rough.call.observations == 11);
  CHECK(hashes(folder / "rough") == hashes(folder / "calm"));
  CHECK(read_run_calls(folder / "rough")->at(0).retried == 2);
}

TEST_CASE("a server that is gone ends the run with words that help, and the run continues later") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(6, 3);
  Server server;
  const auto gone = [](int begun) { return begun >= 2; };
  RunOptions options = server.options(folder / "run", gone);
  options.retries = 1;
  options.give_up_after = 3;
  const auto stopped = run::run(plan, options);
  REQUIRE_FALSE(stopped.ok());
  CHECK(stopped.failure().code == Fault::kPolicy);
  CHECK(stopped.failure().where == "served");
  CHECK(stopped.failure().message ==
        "the policy failed in 3 episodes in a row, the last time so: policy: h:1: closed in "
        "mid-message\n  2 of 6 episodes are stored in " +
            (folder / "run") + "; when the server answers again, the same command continues");
  CHECK(server.begun == 2 + 3 * 2);
  const auto rows = read_results(folder / "run");
  CHECK(rows->size() == 5);
  CHECK(rows->at(4).invalid == "policy: h:1: closed in mid-message");
  CHECK(read_run_calls(folder / "run")->at(0).ended);

  Server back;
  const RunSummary again = must_run(plan, back.options(folder / "run", never));
  CHECK(again.skipped == 2);
  CHECK(again.done == 4);
  CHECK(hashes(folder / "run").size() == 6);
}

TEST_CASE("what profile and server do not agree on is not tried again, whatever its words") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  Server server;
  server.fault = Fault::kUsage;
  RunOptions options = server.options(folder / "run", always);
  options.give_up_after = 1;
  const RunSummary summary = must_run(plan, options);
  CHECK(summary.invalid == 2);
  CHECK(summary.call.retried == 0);
  CHECK(server.begun == 2);
  CHECK(read_results(folder / "run")->at(0).invalid == "policy: h:1: closed in mid-message");
}

TEST_CASE("failures that are not in a row do not end a run, and 0 never does") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(6, 2);
  Server every_other, all;
  RunOptions options = every_other.options(folder / "a", [](int begun) { return begun % 2 == 1; });
  options.retries = 0;
  options.give_up_after = 2;
  CHECK(must_run(plan, options).invalid == 3);
  options = all.options(folder / "b", always);
  options.retries = 0;
  options.give_up_after = 0;
  options.jobs = 2;
  CHECK(must_run(plan, options).invalid == 6);
}

TEST_CASE("two policies of this process under one name are not one run") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  RunOptions options = options_for(folder / "run", "null");
  options.name = "mine";
  must_run(plan, options);
  CHECK(must_run(plan, options).skipped == 2);
  options.policy = "random";
  const auto mixed = run::run(plan, options);
  REQUIRE_FALSE(mixed.ok());
  CHECK(mixed.failure().message.starts_with(
      "was begun with another policy (recorded policy null, now policy random); "));
}

TEST_CASE("another plan, profile or build is refused, forked or continued, as the user says") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 2), other = table_plan(1, 3);
  Server server;
  const RunOptions first = server.options(folder / "run", never);
  must_run(plan, first);
  const auto refusal = [&](const plan::Plan& asked, const RunOptions& options) {
    const auto summary = run::run(asked, options);
    REQUIRE_FALSE(summary.ok());
    CHECK(summary.failure().code == Fault::kStore);
    CHECK(summary.failure().where == folder / "run");
    return summary.failure().message;
  };
  RunOptions profile = server.options(folder / "run", never, "profile a sha256 2");
  CHECK(refusal(plan, profile) ==
        "was begun with another profile (recorded profile a sha256 1, now profile a sha256 2); "
        "take another folder, or --if-changed fork, which starts one beside it, or --if-changed "
        "continue, which mixes them in this one");
  CHECK(refusal(other, first).starts_with("holds a run of another plan (root "));

  profile.if_changed = IfChanged::kFork;
  for (int call = 0; call < 2; ++call) {  // the second continues the fork
    const RunSummary forked = must_run(plan, profile);
    CHECK(forked.out == folder / "run-2");
    CHECK(forked.done == 1 - call);
    CHECK(std::any_of(forked.notes.begin(), forked.notes.end(), [&](const std::string& note) {
      return note.starts_with((folder / "run") + " was begun with another profile");
    }));
  }
  RunOptions fork = first;
  fork.out += "/";
  fork.if_changed = IfChanged::kFork;
  CHECK(must_run(other, fork).out == folder / "run-3");
  fork.if_changed = IfChanged::kContinue;
  CHECK(refusal(other, first).find("--if-changed continue") == std::string::npos);

  profile.if_changed = IfChanged::kContinue;
  const RunSummary continued = must_run(plan, profile);
  CHECK(continued.out == folder / "run");
  CHECK(continued.skipped == 1);
  CHECK(must_run(plan, first).skipped == 1);  // the folder is still of the first
}

TEST_CASE("another build is refused until the user wants it") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  Server server;
  RunOptions options = server.options(folder / "run", never);
  const RunRecord begun{{to_hex(plan.root()), "served", "profile a sha256 1"},
                        "smoke",
                        {42},
                        {{{"program", "another"}}}};
  REQUIRE(Store::open(folder / "run", begun, plan.bytes()).ok());
  const auto refused = run::run(plan, options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message.starts_with("was begun by another build or machine (assets: "));
  CHECK(refused.failure().message.find("program: recorded another, here ") != std::string::npos);
  options.if_changed = IfChanged::kContinue;
  CHECK(must_run(plan, options).done == 2);
  CHECK(read_run_record(folder / "run")->fingerprint.entries[0].second == "another");
  CHECK(read_run_calls(folder / "run")->at(0).fingerprint.entries.size() > 1);
}

TEST_CASE("shards hold each episode once, and what else is chosen moves none") {
  const plan::Plan plan = table_plan(12, 2);
  RunOptions options;
  options.policy = "random";
  std::vector<EpisodeJob> joined;
  for (int shard = 1; shard <= 3; ++shard) {
    options.shard = shard;
    options.shards = 3;
    const auto all = select_jobs(plan, options, true);
    REQUIRE(all.ok());
    CHECK(all->jobs.size() > 2);
    joined.insert(joined.end(), all->jobs.begin(), all->jobs.end());
    RunOptions few = options;
    few.episodes = {4, 7};
    few.seeds = {42};
    const auto part = select_jobs(plan, few, true);
    for (const EpisodeJob& job : part->jobs) {
      CHECK(std::find(all->jobs.begin(), all->jobs.end(), job) != all->jobs.end());
    }
  }
  options.shard = options.shards = 1;
  const auto single = select_jobs(plan, options, true);
  CHECK(joined.size() == single->jobs.size());
  for (const EpisodeJob& job : single->jobs) {
    CHECK(std::count(joined.begin(), joined.end(), job) == 1);
  }
}

TEST_CASE("of a suite that drew episodes those are run, and no others") {
  const std::string path = VLAPROBE_SOURCE_DIR "/examples/sample.probe";
  auto compiled = build(std::span<const std::string>(&path, 1),
                        {.asset_root = VLAPROBE_SOURCE_DIR "/assets", .suite = "some_starts"});
  REQUIRE(compiled.ok());
  REQUIRE(compiled->ok);
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  REQUIRE(plan.ok());
  RunOptions options;
  options.policy = "expert";
  options.suite = "some_starts";
  const auto all = select_jobs(*plan, options, false);
  REQUIRE(all.ok());
  const plan::SuiteRecord& suite = plan->suites()[*plan->find_suite("some_starts")];
  CHECK(all->jobs.size() == plan->episode_count(suite));
  CHECK(all->jobs.size() < plan->episodes().size());
  std::size_t variants = 0;
  for (const EpisodeJob& job : all->jobs) {
    const std::uint32_t baseline = plan->tasks()[job.task].baseline;
    if (baseline == plan::kNone) continue;
    ++variants;
    // Its comparison has the same start.
    CHECK(std::find(all->jobs.begin(), all->jobs.end(),
                    EpisodeJob{baseline, job.index, job.seed}) != all->jobs.end());
  }
  CHECK(variants == 60);
}

TEST_CASE("a server that moves continues its run, and the rows keep the first name") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  Server server;
  RunOptions options = server.options(folder / "run", never);
  options.policy = "served://one:8000?profile=a";
  options.episodes = {0, 0};
  must_run(plan, options);
  options.policy = "served://two:9000?profile=a";
  options.episodes = std::nullopt;
  const RunSummary moved = must_run(plan, options);
  CHECK(moved.skipped == 1);
  CHECK(moved.notes.back() == "the rows keep the policy's name `served://one:8000?profile=a`");
  const auto rows = read_results(folder / "run");
  REQUIRE(rows->size() == 2);
  for (const ResultRow& row : *rows) {
    CHECK(row.policy == "served://one:8000?profile=a");
  }
  RunOptions other = server.options(folder / "run", never, "profile b sha256 1");
  other.policy = options.policy;
  CHECK_FALSE(run::run(plan, other).ok());
}

TEST_CASE("rows carry the name that the user gives the policy") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 2);
  Server server;
  RunOptions options = server.options(folder / "run", never);
  options.name = "pi0 at 30k";
  must_run(plan, options);
  CHECK(read_results(folder / "run")->at(0).policy == "pi0 at 30k");
  options.policy = "served elsewhere";
  CHECK(must_run(plan, options).skipped == 1);
}

}  // namespace
}  // namespace probe::run
