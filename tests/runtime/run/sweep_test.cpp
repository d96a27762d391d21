// Checkpoints compared on the original tasks, and the whole suite with the best.
#include "runtime/run/sweep.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "compiler/emit/compile.h"
#include "runtime/base/file.h"
#include "runtime/store/store.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/servers/python_server.h"

namespace probe::run {
using namespace probe::store;
using namespace probe::servers;
namespace {

namespace fs = std::filesystem;

// One original task of the suite and one variant of it.
plan::Plan two_tasks(const TemporaryFolder& folder) {
  const std::string path = folder / "two.probe";
  std::ofstream(path) << "use \"" VLAPROBE_SOURCE_DIR
                         "/suite/intact.probe\"\n"
                         "suite two trained on bridge_v2 {\n"
                         "  tasks { carrot_on_plate, carrot_on_plate_lang_action }; seeds 42\n}\n";
  const std::string files[] = {path};
  auto compiled = build(files, {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                                .suite = "two",
                                .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
  REQUIRE_FALSE(compiled->plan.empty());
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  return std::move(*plan);
}

SweepOptions options_for(const std::string& out) {
  SweepOptions options;
  options.run.policy = "noisy:{}";
  options.run.out = out;
  options.run.assets = VLAPROBE_SOURCE_DIR "/assets";
  options.run.episodes = {0, 1};
  options.run.jobs = 2;
  options.checkpoints = {"0.2", "0.0", "0"};
  return options;
}

TEST_CASE("checkpoints at one server that ignores what it is told to load are refused") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks(folder);
  SweepOptions options = options_for(folder / "sweep");
  options.run.policy = "intact://127.0.0.1:1?profile=octo_bridge&model={}";
  options.checkpoints = {"/a", "/b"};
  const auto swept = sweep(plan, options);
  REQUIRE_FALSE(swept.ok());
  CHECK(swept.failure().code == Fault::kUsage);
  CHECK(swept.failure().message.find("`/a` and `/b` would be one model") != std::string::npos);
  CHECK_FALSE(fs::exists(folder / "sweep"));
}

TEST_CASE("the best checkpoint on the original tasks runs the whole suite; of equals the first") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks(folder);
  SweepOptions options = options_for(folder / "sweep");
  std::vector<std::string> told;
  options.tell = [&](const std::string& sentence) { told.push_back(sentence); };
  const auto swept = sweep(plan, options);
  REQUIRE_MESSAGE(swept.ok(), to_text(swept.failure()));
  REQUIRE(swept->scores.size() == 3);
  CHECK(swept->scores[0].success < 1);
  CHECK(swept->scores[1].success == 1);
  CHECK(swept->scores[2].success == 1);
  CHECK(swept->best == 1);
  CHECK(swept->scores[1].tasks == 1);
  CHECK(swept->scores[1].episodes == 2);
  CHECK(swept->whole.total == 4);
  CHECK(swept->whole.skipped == 2);
  CHECK(read_results(folder / "sweep/0.0")->size() == 4);
  CHECK(read_results(folder / "sweep/0")->size() == 2);
  CHECK(read_run_record(folder / "sweep/0.2")->identity.policy == "noisy:0.2");
  CHECK(told.back() == "best: 0.0; now the whole suite");
  const auto json = Json::parse(read_file(folder / "sweep/sweep.json").value());
  CHECK(json["best"] == "0.0");
  CHECK(json["checkpoints"].size() == 3);
  CHECK(json["checkpoints"][2]["folder"] == "0");

  // A run beside the checkpoints' is none of the sweep's; a search's folder is a search's alone.
  std::ofstream(folder / "sweep/results.sqlite") << "";
  const auto again = sweep(plan, options);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK(again->best == 1);
  CHECK(again->whole.done == 0);
}

TEST_CASE("no sweep is made in the folder of a search") {
  TemporaryFolder folder;
  const plan::Plan plan = two_tasks(folder);
  fs::create_directories(folder / "found");
  std::ofstream(folder / "found/search.json") << "{}";
  const auto refused = sweep(plan, options_for(folder / "found"));
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message == "holds a search; take another folder for a sweep");
}

TEST_CASE("INT-ACT checkpoints are switched on their server, each into its own folder") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 6);
  const test::PythonServer server("openpi_digest_server.py");
  REQUIRE_FALSE(server.port().empty());
  SweepOptions options = options_for(folder / "sweep");
  options.run.policy = "intact://127.0.0.1:" + server.port() + "?worlds=many&model={}";
  options.checkpoints = {"/ckpt/a", "/ckpt/b"};
  const auto swept = sweep(plan, options);
  REQUIRE_MESSAGE(swept.ok(), to_text(swept.failure()));
  const auto a = read_results(swept->scores[0].dir), b = read_results(swept->scores[1].dir);
  REQUIRE_MESSAGE(a.ok(), to_text(a.failure()));
  REQUIRE_MESSAGE(b.ok(), to_text(b.failure()));
  REQUIRE(a->size() == b->size());
  CHECK(a->at(0).policy.ends_with("&model=/ckpt/a"));
  CHECK(a->at(0).sent_image_sha256 == b->at(0).sent_image_sha256);
  CHECK(a->at(0).trace_sha256 != b->at(0).trace_sha256);
  CHECK(swept->best == 0);
  CHECK(swept->whole.call.queries.queries == 0);  // all was there
}

TEST_CASE("several worlds at a server that keeps one episode's words are refused") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  RunOptions options = options_for(folder / "run").run;
  options.policy = "intact://127.0.0.1:1?profile=octo_bridge&model=/m&timeout.wait_s=0.05";
  const auto refused = run::run(plan, options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().message.find("`worlds = one`") != std::string::npos);
  CHECK_FALSE(fs::exists(folder / "run"));
  options.jobs = 1;
  const auto absent = run::run(plan, options);  // nobody listens there
  REQUIRE_FALSE(absent.ok());
  CHECK(absent.failure().code == Fault::kPolicy);
}

TEST_CASE("checkpoints that answer bit for bit the same are told, and each run has its proof") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  // It loads whatever it is told and is always the same.
  const test::PythonServer server("openpi_server.py", {"intact", "seen=deaf"});
  REQUIRE_FALSE(server.port().empty());
  SweepOptions options = options_for(folder / "sweep");
  options.run.policy = "intact://127.0.0.1:" + server.port() + "?worlds=many&model={}";
  options.run.jobs = 1;
  options.checkpoints = {"/ckpt/a", "/ckpt/b"};
  const auto swept = sweep(plan, options);
  REQUIRE_MESSAGE(swept.ok(), to_text(swept.failure()));
  REQUIRE(swept->alike.size() == 1);
  CHECK(swept->alike[0].starts_with("checkpoints `/ckpt/a` and `/ckpt/b` answer bit for bit"));
  const auto json = Json::parse(read_file(folder / "sweep/sweep.json").value());
  CHECK(json["alike"].size() == 1);
  const auto calls = read_run_calls(swept->scores[0].dir);
  REQUIRE(calls.ok());
  REQUIRE(calls->size() == 1);
  REQUIRE(calls->at(0).reading.has_value());
  CHECK(calls->at(0).reading->answers_sha256 == swept->scores[0].answers_sha256);
  const ReadingSummary summary = summarize_readings(*calls);
  REQUIRE(summary.findings.size() == 1);
  CHECK(summary.findings[0].find("two instructions") != std::string::npos);
  CHECK(summary.good.empty());
}

TEST_CASE("what cannot be swept is told before anything runs") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 2);
  const auto refusal = [&](const SweepOptions& options) {
    const auto swept = sweep(plan, options);
    REQUIRE_FALSE(swept.ok());
    CHECK_FALSE(fs::exists(options.run.out));
    return to_text(swept.failure());
  };
  SweepOptions options = options_for(folder / "sweep");
  options.run.policy = "noisy:0.1";
  CHECK(refusal(options).starts_with("--policy: `noisy:0.1` has no {} for a checkpoint"));
  options = options_for(folder / "sweep");
  options.checkpoints = {"0", "0.1", "0"};
  CHECK(refusal(options) == "--checkpoints: `0` is named twice");
  options.checkpoints = {"0", "heavy"};
  CHECK(refusal(options).find("found `heavy`") != std::string::npos);
  options.checkpoints = {};
  CHECK(refusal(options) == "--checkpoints: no checkpoint is named");
  options = options_for(folder / "sweep");
  options.run.name = "mine";
  CHECK(refusal(options).starts_with("--name: `mine` has no {}"));
}

TEST_CASE(
    "a checkpoint's folder is its text where that is a name, else tells apart what is alike") {
  CHECK(checkpoint_folder("step-20000.pt") == "step-20000.pt");
  const std::string a = checkpoint_folder("/ckpt/a/20000"), b = checkpoint_folder("/ckpt/a_20000");
  CHECK(a.starts_with("ckpt_a_20000-"));
  CHECK(b.starts_with("ckpt_a_20000-"));
  CHECK(a != b);
  CHECK(checkpoint_folder("..").size() == 8);
  CHECK(checkpoint_folder(std::string(500, 'x')).size() == 40 + 9);
}

}  // namespace
}  // namespace probe::run
