// Run folders with made-up results of the published suite, without traces or physics.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/plan.h"
#include "runtime/store/store.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::report {

inline plan::Plan plan_of(const std::string& path) {
  auto compiled = build(std::span(&path, 1), {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                                              .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE(compiled.ok());
  REQUIRE(compiled->ok);
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  REQUIRE(plan.ok());
  return std::move(plan).value();
}

inline plan::Plan suite_plan(const std::string& file = "intact.probe") {
  return plan_of(std::string(VLAPROBE_SOURCE_DIR "/suite/") + file);
}

// In memory where that is possible: each row of a run waits for the disk.
struct RunsFolder : run::TemporaryFolder {
  RunsFolder()
      : TemporaryFolder(std::filesystem::exists("/dev/shm")
                            ? "/dev/shm"
                            : std::filesystem::temp_directory_path()) {}
};

// What one episode gave: metrics in the order success, intention, grasp, wrong; or why it is
// invalid.
struct Outcome {
  bool success = false, intention = true, grasp = false, wrong = false;
  std::optional<std::string> invalid = {};
  std::vector<store::MetricValue> more = {};  // behind them
};
using Script = std::function<Outcome(const std::string& task, int episode, int seed)>;

struct FakeRunOptions {
  std::vector<std::string> tasks;  // empty: none
  int first = 0, last = 23;        // starts
  std::vector<int> seeds = {42};
  std::string content = "";  // RunIdentity::policy_content
  bool only_success = false;
  // Of a run that stops by what it finds: only the first places of its order have rows.
  std::string until = "";
  std::vector<store::OrderedEpisode> order = {};
  std::size_t run = 0;
};

// Makes DIR with a row for every task, start and seed.
inline void fake_run(const std::string& dir, const plan::Plan& plan, const std::string& policy,
                     const FakeRunOptions& options, const Script& script) {
  store::RunRecord record;
  record.identity.plan_root = to_hex(plan.root());
  record.identity.policy = policy;
  record.identity.policy_content = options.content;
  record.identity.only_success = options.only_success;
  record.identity.until = options.until;
  record.suite = plan.text(plan.suites()[0].name);
  record.seeds = options.seeds;
  record.fingerprint.entries = {{"cpu", "test"}};
  auto store = store::Store::open(dir, record, plan.bytes());
  REQUIRE_MESSAGE(store.ok(), to_text(store.failure()));
  std::set<store::EpisodeKey> ran;
  for (std::size_t i = 0; i < options.run; ++i) ran.insert(options.order[i].key);
  if (!options.until.empty()) REQUIRE((*store)->freeze_order(options.order).ok());
  for (const std::string& name : options.tasks) {
    const auto task = plan.find_task(name);
    REQUIRE(task);
    const plan::TaskRecord& of_plan = plan.tasks()[*task];
    for (int episode = options.first; episode <= options.last; ++episode) {
      for (const int seed : options.seeds) {
        if (!options.until.empty() && !ran.contains({name, episode, seed})) continue;
        const Outcome outcome = script(name, episode, seed);
        store::ResultRow row;
        row.task = name;
        row.episode = episode;
        row.seed = seed;
        row.policy = policy;
        row.metrics = {{"success", true, outcome.success ? 1.0 : 0.0},
                       {"intention", true, outcome.intention ? 1.0 : 0.0},
                       {"grasp", true, outcome.grasp ? 1.0 : 0.0},
                       {"wrong", true, outcome.wrong ? 1.0 : 0.0}};
        row.metrics.insert(row.metrics.end(), outcome.more.begin(), outcome.more.end());
        row.steps = 60;
        row.invalid = outcome.invalid;
        row.prompt_sha256 = to_hex(sha256(plan.text(of_plan.prompt)));
        row.image_sha256 = "picture";
        std::ofstream((*store)
                          ->temporary_trace({name, episode, seed})
                          .value());  // no report reads it unasked
        REQUIRE((*store)->commit(row, static_cast<int>(*task)).ok());
      }
    }
  }
}

inline Script always(bool success) {
  return [success](const std::string&, int, int) {
    return Outcome{success, true, success, false, {}};
  };
}

}  // namespace probe::report
