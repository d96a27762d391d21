// Asking as an array job: what the job says, and what its folder lacks. No Slurm is needed: the
// array itself is tests/runtime/cluster's.
#include "runtime/ask/ask_on_slurm.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "runtime/ask/ask.h"
#include "runtime/ask/merge.h"
#include "runtime/base/file.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::ask {
namespace {

using run::TemporaryFolder;

constexpr int kTasks = 3;

AskOptions asking(const std::string& model, const std::string& out) {
  AskOptions options;
  options.model = model;
  options.out = out;
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  return options;
}

cluster::ArrayOptions written_only() {
  cluster::ArrayOptions options;
  options.script.program = "/usr/bin/vlaprobe";
  options.script.tasks = kTasks;
  return options;
}

TEST_CASE("without --submit the job of asking is written, with every word that chooses") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(4);
  AskOptions options = asking("openai://127.0.0.1:{port}?model=qwen", folder / "answers");
  options.choice.questions = {"understanding.source", "understanding.l*"};
  options.choice.arms = {Arm::kPicture, Arm::kBlind};
  options.choice.episodes = {0, 2};
  options.retries = 7;
  cluster::ArrayOptions array = written_only();
  array.script.server_command = "serve --port {port}";
  const auto report = ask_on_slurm(plan, options, array);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  // Three starts, (3 orders of a choice + one of left) in two arms.
  CHECK(report->total == 3 * 4 * 2);
  CHECK(report->job.empty());
  CHECK(std::filesystem::exists(folder / "answers/slurm/suite.plan"));
  const auto script = read_file(report->script);
  REQUIRE(script.ok());
  for (const char* words : {"ask", "--model", "openai://127.0.0.1:", "--questions",
                            "understanding.source,understanding.l*", "--arms", "picture,blind",
                            "--episodes", "0-2", "--retries", "--shard", "serve --port"}) {
    CHECK_MESSAGE(script->find(words) != std::string::npos, words);
  }
  CHECK(script->find("--insecure") == std::string::npos);
}

TEST_CASE("a job into a folder of another model or plan is refused before anything is written") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  REQUIRE(ask::ask(plan, asking("first", folder / "answers")).ok());
  const auto other = ask_on_slurm(plan, asking("random", folder / "answers"), written_only());
  REQUIRE(!other.ok());
  CHECK(other.failure().message.starts_with("holds answers of model `first`, not `random`"));
  const auto grown =
      ask_on_slurm(asking_plan(2), asking("first", folder / "answers"), written_only());
  REQUIRE(!grown.ok());
  CHECK(grown.failure().message.find("another plan") != std::string::npos);
  CHECK(!std::filesystem::exists(folder / "answers/slurm"));
  CHECK(!ask_on_slurm(plan, asking("nobody", folder / "new"), written_only()).ok());
}

TEST_CASE("what a folder lacks is counted by the shard that would ask it") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(6);
  const AskOptions whole = asking("truth", folder / "merged");
  const auto queries = Queries::choose(plan, whole.choice);
  REQUIRE(queries.ok());
  const auto lacking = [&] {
    auto missing = missing_answers(plan, *queries, folder / "merged", kTasks);
    REQUIRE_MESSAGE(missing.ok(), to_text(missing.failure()));
    return *missing;
  };
  const auto all = lacking();
  std::int64_t count = 0;
  for (const auto& [shard, answers] : all) {
    CHECK(shard >= 1);
    CHECK(shard <= kTasks);
    count += answers;
  }
  CHECK(count == queries->count());
  // Each task's shard fills its own part and no other.
  std::vector<std::string> parts;
  for (int shard = 1; shard <= kTasks; ++shard) {
    AskOptions part = asking("truth", folder / ("part" + std::to_string(shard)));
    part.choice.shard = shard;
    part.choice.shards = kTasks;
    const auto asked = ask::ask(plan, part);
    REQUIRE_MESSAGE(asked.ok(), to_text(asked.failure()));
    if (!all.contains(shard)) {
      CHECK(asked->total == 0);
      continue;
    }
    CHECK(asked->total == all.at(shard));
    parts.push_back(part.out);
    REQUIRE(merge({.dirs = parts, .out = folder / "merged"}).ok());
    CHECK(!lacking().contains(shard));
  }
  CHECK(lacking().empty());
}

}  // namespace
}  // namespace probe::ask
