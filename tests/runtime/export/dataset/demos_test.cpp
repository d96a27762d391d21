// What is shown to learners: the expert's successes, pushed off its way.
#include <algorithm>

#include "runtime/base/json.h"
#include "runtime/policy/scripted.h"
#include "runtime/run/policies.h"
#include "runtime/store/store.h"
#include "tests/runtime/export/dataset/exported_run.h"

namespace probe::dataset {
namespace {

TEST_CASE("where only successes are kept they are the episodes that succeed anyway") {
  run::TablePlan table(std::string(VLAPROBE_SOURCE_DIR) + "/assets");
  const plan::Plan plan = table.make(2, 30);
  const run::TemporaryFolder folder;
  run::RunOptions options = run::options_for(folder / "all", "pushed:0.03");
  options.seeds = {0, 1, 2};
  run::must_run(plan, options);
  options.out = folder / "kept";
  options.only_success = true;
  const run::RunSummary summary = run::must_run(plan, options);
  const auto all = store::read_results(folder / "all"), kept = store::read_results(folder / "kept");
  REQUIRE(all.ok());
  REQUIRE(kept.ok());
  std::vector<std::string> wanted, found;
  for (const store::ResultRow& row : *all) {
    REQUIRE(!row.invalid);
    const bool is_success = std::ranges::any_of(row.metrics, [](const store::MetricValue& metric) {
      return metric.name == "success" && metric.value != 0;
    });
    if (is_success) wanted.push_back(row.trace_sha256);
  }
  for (const store::ResultRow& row : *kept) found.push_back(row.trace_sha256);
  CHECK(found == wanted);
  MESSAGE(wanted.size(), " of ", all->size(), " episodes succeeded");
  CHECK(summary.not_kept == static_cast<int>(all->size() - wanted.size()));
  CHECK(summary.done == static_cast<int>(all->size()));
  // Nothing of the others is left, and the same call finds those that are there.
  std::size_t traces = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "kept/traces"))
    traces += entry.is_regular_file() ? 1 : 0;
  CHECK(traces == wanted.size());
  const run::RunSummary again = run::must_run(plan, options);
  CHECK(again.skipped == static_cast<int>(wanted.size()));
  CHECK(again.not_kept == summary.not_kept);

  // A folder of successes says so, and is no place for the others.
  CHECK(store::read_run_record(folder / "kept").value().identity.only_success);
  CHECK(!store::read_run_record(folder / "all").value().identity.only_success);
  for (const store::ResultRow& row : *kept) CHECK(row.only_success);
  for (const store::ResultRow& row : *all) CHECK(!row.only_success);
  const auto refused = [&](const char* name, bool only_success) {
    run::RunOptions into = options;
    into.out = folder / name;
    into.only_success = only_success;
    for (const run::IfChanged if_changed : {run::IfChanged::kRefuse, run::IfChanged::kContinue}) {
      into.if_changed = if_changed;
      const auto done = run::run(plan, into);
      REQUIRE(!done.ok());
      CHECK(done.failure().code == Fault::kStore);
      CHECK(done.failure().message.find("successes alone") != std::string::npos);
    }
  };
  refused("kept", false);
  refused("all", true);
  // What repeats them is as selected as they are.
  run::RunOptions repeated = run::options_for(folder / "repeated", "replay:" + (folder / "kept"));
  run::must_run(plan, repeated);
  CHECK(store::read_run_record(folder / "repeated").value().identity.only_success);
}

TEST_CASE("a pushed policy is itself in most steps, the same ones for the same draws") {
  const auto actions = [](std::uint64_t draw_seed) {
    const auto policy = policy::make_pushed(policy::make_null(), 0.01);
    policy::EpisodeStart start;
    start.draw_seed = draw_seed;
    REQUIRE(policy->begin(start).ok());
    std::vector<policy::Action> all;
    for (int i = 0; i < 800; ++i) {
      policy::Observation seen;
      seen.step = i;
      const auto action = policy->act(seen);
      REQUIRE(action.ok());
      all.push_back(*action);
    }
    return all;
  };
  const auto some = actions(7);
  const auto pushed =
      std::ranges::count_if(some, [](const policy::Action& action) { return action[0] != 0; });
  CHECK(pushed > 70);
  CHECK(pushed < 130);
  CHECK(some == actions(7));
  CHECK(some != actions(8));
  CHECK(run::choose_policy("pushed:0.01")->traits.draws);
  CHECK(!run::choose_policy("pushed:0")->traits.draws);
  CHECK(run::make_policy("pushed:far").failure().message.find("SIGMA of `pushed:SIGMA`") == 0);
}

TEST_CASE("a dataset says in which steps the expert was pushed") {
  run::TablePlan table(std::string(VLAPROBE_SOURCE_DIR) + "/assets");
  const plan::Plan plan = table.make(2, 30);
  const run::TemporaryFolder folder;
  for (const char* policy : {"expert", "pushed:0.02"}) {
    run::RunOptions options = run::options_for(folder / policy, policy);
    options.seeds = {0, 1, 2};
    options.name = std::string(policy) == "expert" ? "" : "somebody";  // whatever rows call it
    run::must_run(plan, options);
  }
  // Until the first push the two do the same in the same places; there they part.
  const auto straight = traces_of(folder / "expert"), pushed = traces_of(folder / "pushed:0.02");
  must_export(folder / "pushed:0.02", folder / "set", Format::kRobomimic, dataset_options());
  must_export(folder / "expert", folder / "plain", Format::kRobomimic, dataset_options());
  std::ifstream lines(folder / "set/vlaprobe/demonstrations.jsonl");
  std::string line;
  std::size_t count = 0;
  for (; std::getline(lines, line); ++count) {
    const Json json = Json::parse(line);
    REQUIRE(json.contains("pushed"));
    const auto steps = json["pushed"].get<std::vector<int>>();
    const store::Trace& trace = pushed[count].trace;
    CHECK(json["trace_sha256"] == to_hex(trace.hash));
    const store::Trace* beside = nullptr;  // of the same start
    for (const store::StoredTrace& other : straight) {
      if (other.trace.header.episode == trace.header.episode) beside = &other.trace;
    }
    REQUIRE(beside != nullptr);
    int parted = 0;
    while (static_cast<std::size_t>(parted) < trace.steps.size() &&
           trace.steps[static_cast<std::size_t>(parted)].action ==
               beside->steps[static_cast<std::size_t>(parted)].action)
      ++parted;
    REQUIRE(!steps.empty());
    CHECK(steps.front() == parted);
    CHECK(std::ranges::is_sorted(steps));
    CHECK(steps.back() < static_cast<int>(trace.steps.size()));
  }
  CHECK(count == 6);
  CHECK(text_of(folder / "plain/vlaprobe/demonstrations.jsonl").find("pushed") ==
        std::string::npos);
}

}  // namespace
}  // namespace probe::dataset
