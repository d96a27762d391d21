// Whole runs on the real world, camera and judge: sameness, resume, replay, pictures, and what goes
// wrong.
#include "runtime/run/run.h"
#include "runtime/show/contact_sheet.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "runtime/run/replay.h"
#include "runtime/run/selection.h"
#include "runtime/scene/image.h"
#include "runtime/store/merge.h"
#include "runtime/store/store.h"
#include "runtime/store/trace.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/show/inspect_video.h"

namespace probe::run {
using namespace probe::store;
using namespace probe::show;
using namespace probe::show;
namespace {

namespace fs = std::filesystem;

SheetOptions sheet_of(const RunOptions& options) {
  SheetOptions sheet;
  sheet.cell_width = 160;
  sheet.assets = options.assets;
  return sheet;
}

TEST_CASE("one job or two, in one go or in shards, with or without videos: the same traces") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 3);
  RunOptions one = options_for(folder / "one");
  const RunSummary summary = must_run(plan, one);
  CHECK(summary.total == 4);  // two starts, two seeds: this policy draws
  CHECK(summary.done == 4);
  const auto expected = hashes(folder / "one");
  REQUIRE(expected.size() == 4);
  CHECK(std::set<std::string>(expected.begin(), expected.end()).size() == 4);

  RunOptions two = options_for(folder / "two");
  two.jobs = 2;
  two.video = VideoChoice::kAll;
  must_run(plan, two);
  CHECK(hashes(folder / "two") == expected);
  const auto video = inspect_video(folder / "two/videos/carrot_on_plate/0-42.mp4");
  REQUIRE_MESSAGE(video.ok(), to_text(video.failure()));
  CHECK(video->frames == 4);

  RunOptions part = options_for(folder / "part");
  part.tasks = "widowx_carrot*";
  part.shards = 2;
  int done = 0;
  for (const int shard : {2, 1}) {
    part.shard = shard;
    done += must_run(plan, part).done;
  }
  CHECK(done == 4);
  CHECK(hashes(folder / "part") == expected);

  // Again: nothing is left to do.
  const RunSummary again = must_run(plan, one);
  CHECK(again.done == 0);
  CHECK(again.skipped == 4);
}

TEST_CASE("a stored episode repeats bit for bit, and a changed one is told") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 4);
  RunOptions options = options_for(folder / "run");
  options.seeds = {7};
  must_run(plan, options);
  ReplayOptions replaying;
  replaying.verify = true;
  replaying.assets = options.assets;
  replaying.video = folder / "a.mp4";
  replaying.png = folder / "last.png";
  replaying.png_step = 4;
  const auto report = replay(folder / "run", "carrot_on_plate", 0, std::nullopt, replaying);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK_MESSAGE(report->identical, report->difference);
  CHECK(report->steps == 4);
  CHECK(report->seed == 7);
  CHECK(report->fingerprint_differences.empty());
  CHECK(inspect_video(folder / "a.mp4")->frames == 5);
  CHECK(scene::load_image(folder / "last.png")->width == 640);

  CHECK(replay(folder / "run", "carrot_on_plate", 0, 8, replaying)
            .failure()
            .message.find("no seed 8") != std::string::npos);
  ReplayOptions quiet;
  quiet.assets = options.assets;
  CHECK(replay(folder / "run", "widowx_carrot_on_plate", 0, 7, quiet).ok());
  CHECK(replay(folder / "nothing", "carrot_on_plate", 0, 7, quiet).failure().code == Fault::kStore);
  // A damaged trace is refused before anything is repeated.
  const std::string trace_file = read_results(folder / "run")->at(0).trace;
  fs::copy_file(trace_file, folder / "whole.trace");
  fs::resize_file(trace_file, fs::file_size(trace_file) / 2);
  const auto cut = replay(folder / "run", "carrot_on_plate", 0, 7, quiet);
  REQUIRE_FALSE(cut.ok());
  CHECK(cut.failure().where == trace_file);
  CHECK(cut.failure().message.starts_with("truncated"));
  fs::copy_file(folder / "whole.trace", trace_file, fs::copy_options::overwrite_existing);
  CHECK(replay(folder / "run", "carrot", 0, 7, replaying).failure().code == Fault::kUsage);
  CHECK(replay(folder / "run", "carrot_on_plate", 3, 7, replaying).failure().code == Fault::kUsage);

  // The policy replay:DIR does the same things, under its own name.
  RunOptions copy = options_for(folder / "copy", "replay:" + (folder / "run"));
  copy.seeds = {7};
  must_run(plan, copy);
  const auto a = read_trace(read_results(folder / "run")->at(0).trace);
  const auto b = read_trace(read_results(folder / "copy")->at(0).trace);
  CHECK(a->steps.back().state_hash == b->steps.back().state_hash);

  CHECK(write_contact_sheet(folder / "run", folder / "sheet.png", sheet_of(options)).ok());
  CHECK(scene::load_image(folder / "sheet.png")->width > 320);
}

TEST_CASE("objects settle on the table and the null policy leaves them there") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 5);
  const RunSummary summary = must_run(plan, options_for(folder / "run", "null"));
  CHECK(summary.total == 2);  // draws nothing: once a start
  REQUIRE(summary.notes.size() == 1);
  CHECK(summary.notes[0].find("seed 42") != std::string::npos);
  const auto rows = read_results(folder / "run");
  for (const ResultRow& row : *rows) {
    CHECK(row.steps == 5);
    const auto trace = read_trace(row.trace);
    REQUIRE(trace.ok());
    const auto& start = trace->start->sample;
    const auto& end = trace->steps.back().sample;
    CHECK(start.bodies[0].position.z() > 0.87 + 0.01);
    CHECK(start.bodies[0].position.z() < 0.87 + 0.03);
    CHECK(start.bodies[1].position.z() < 0.87 + 0.02);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK((end.bodies[i].position - start.bodies[i].position).norm() < 1e-5);
    }
    CHECK(trace->steps.back().sample.grip == doctest::Approx(0).epsilon(0.01));
    CHECK(trace->header.prompt == "put carrot on plate");
    CHECK(to_hex(trace->steps[0].prompt_hash) == row.prompt_sha256);
    CHECK(to_hex(trace->steps[0].image_hash) == row.image_sha256);
    // Contacts of both objects with the table, ascending.
    REQUIRE(end.contacts.size() >= 2);
    CHECK(end.contacts[0].a == 0);
    CHECK(end.contacts[0].b == 2);
    CHECK(end.contacts[0].push.z() < 0);  // the carrot presses the table down
  }
}

TEST_CASE("a policy that fails makes the episode invalid, and it is tried again") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 3);
  // The run to replay is one step shorter.
  must_run(table_plan(1, 2), options_for(folder / "short", "null"));
  const RunOptions options = options_for(folder / "run", "replay:" + (folder / "short"));
  const RunSummary summary = must_run(plan, options);
  CHECK(summary.invalid == summary.total);
  const auto rows = read_results(folder / "run");
  REQUIRE(rows->at(0).invalid.has_value());
  CHECK(rows->at(0).invalid->starts_with("policy: "));
  CHECK(rows->at(0).steps == 2);
  CHECK(read_trace(rows->at(0).trace).ok());
  const RunSummary again = must_run(plan, options);
  CHECK(again.skipped == 0);
  CHECK(again.notes.at(0).starts_with("carrot_on_plate episode 0 seed 42 was run again: policy: "));
  CHECK(read_results(folder / "run")->size() == rows->size());
}

TEST_CASE("a replayed run has the episodes and seeds of the other, neither more nor fewer") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  RunOptions options = options_for(folder / "a");
  options.seeds = {42};
  options.episodes = {1, 1};
  must_run(plan, options);
  options.seeds = {9};
  options.episodes = {0, 0};
  must_run(plan, options);
  RunOptions copy = options_for(folder / "b", "replay:" + (folder / "a"));
  CHECK(must_run(plan, copy).total == 2);
  const auto rows = read_results(folder / "b");
  REQUIRE(rows->size() == 2);
  CHECK(rows->at(0).seed == 9);
  CHECK(rows->at(1).seed == 42);
  CHECK_FALSE(rows->at(1).invalid);
  copy.seeds = {7};
  CHECK(run::run(plan, copy).failure().message.find("holds none of the chosen") != std::string::npos);
}

TEST_CASE("a damaged trace is run again with a note, and videos that were not made are noted") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  RunOptions options = options_for(folder / "run", "null");
  must_run(plan, options);
  const auto before = hashes(folder / "run");
  fs::resize_file(read_results(folder / "run")->at(1).trace, 300);
  options.video = VideoChoice::kAll;
  const RunSummary again = must_run(plan, options);
  CHECK(again.done == 1);
  CHECK(hashes(folder / "run") == before);
  REQUIRE(again.notes.size() == 3);
  CHECK(again.notes[1].starts_with("carrot_on_plate episode 1 seed 42 was run again: "));
  CHECK(again.notes[2] ==
        "1 episodes that were there have no video; one is made by `vlaprobe replay " +
            (folder / "run") + " carrot_on_plate 0 42 --video FILE.mp4`");

  // The trace of another episode under this one's name.
  const auto rows = read_results(folder / "run");
  fs::copy_file(rows->at(0).trace, rows->at(1).trace, fs::copy_options::overwrite_existing);
  ReplayOptions replaying;
  replaying.assets = options.assets;
  const auto replayed = replay(folder / "run", "carrot_on_plate", 1, 42, replaying);
  CHECK(replayed.failure().where == rows->at(1).trace);
  // A sheet shows the others and says which it lacks.
  const auto sheet = write_contact_sheet(folder / "run", folder / "sheet.png", sheet_of(options));
  REQUIRE_FALSE(sheet.ok());
  CHECK(sheet.failure().code == Fault::kTrace);
  CHECK(sheet.failure().message.find("carrot_on_plate episode 1 seed 42") != std::string::npos);
  CHECK(replay(folder / "run", "carot_on_plate", 0, 42, replaying)
            .failure()
            .message.ends_with("did you mean `carrot_on_plate`?"));
  replaying.video = folder / "absent/x.mp4";
  CHECK(replay(folder / "run", "carrot_on_plate", 0, 42, replaying).failure().code ==
        Fault::kUsage);
  CHECK_FALSE(fs::exists(folder / "absent"));
}

TEST_CASE("who wants a distractor stays still without one, and the run says so") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 3);
  const RunSummary summary = must_run(plan, options_for(folder / "run", "wrong"));
  CHECK(summary.done == 1);
  CHECK(summary.invalid == 0);
  REQUIRE_FALSE(summary.notes.empty());
  CHECK(summary.notes.back() ==
        "policy `wrong` goes for a distractor and stays still in the 1 of 1 tasks that have none");
}

TEST_CASE("what cannot run is told before anything is written") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 3);
  const auto refused = [&](const RunOptions& options) {
    const auto summary = run::run(plan, options);
    REQUIRE_FALSE(summary.ok());
    CHECK_FALSE(fs::exists(options.out));
    return to_text(summary.failure());
  };
  RunOptions options = options_for(folder / "run", "exprt");
  CHECK(refused(options).find("did you mean `expert`") != std::string::npos);
  options = options_for(folder / "run");
  options.tasks = "spoon*";  // neither with the suite's prefix nor without
  CHECK(refused(options) ==
        "--tasks: no task is called `spoon*`; the tasks are:\n  carrot_on_plate");
  options.tasks = "carot_on_plate";
  CHECK(refused(options) ==
        "--tasks: no task is called `carot_on_plate`, did you mean `carrot_on_plate`?");
  CHECK(refused(options_for(folder / "run", "replay:" + (folder / "nothing")))
            .find("is the folder of a run, but ") != std::string::npos);
  options = options_for(folder / "run", "null");
  // The only episode is in the other one.
  options.out = folder / "empty";
  options.shards = 2;
  options.shard = 3 - shard_of(Sha256{plan.episodes()[0].episode_id}, 42, 2);
  const RunSummary nothing = must_run(plan, options);
  CHECK(nothing.total == 0);
  CHECK(nothing.notes.back() ==
        "shard " + std::to_string(options.shard) + "/2 holds no episode: nothing to do");
  // It is a part of the run all the same: whoever merges all shards finds each of them.
  RunOptions full = options;
  full.out = folder / "full";
  full.shard = 3 - options.shard;
  must_run(plan, full);
  const auto joined = store::merge({.dirs = {options.out, full.out}, .out = folder / "joined"});
  REQUIRE_MESSAGE(joined.ok(), to_text(joined.failure()));
  CHECK(joined->added == 1);
  options = options_for(folder / "run");
  options.suite = "nightly";
  CHECK(refused(options).find("no suite `nightly`; the plan has smoke") != std::string::npos);
  options = options_for(folder / "run");
  options.episodes = {5, 9};
  CHECK(refused(options).find("from 5 to 9") != std::string::npos);
  options = options_for(folder / "run");
  options.shard = 3;
  options.shards = 2;
  CHECK(refused(options).find("3/2") != std::string::npos);
  options = options_for(folder / "run");
  options.assets = folder / "nowhere";
  CHECK(refused(options).find("is not there") != std::string::npos);

  // One byte of one mesh.
  fs::copy(std::string(VLAPROBE_SOURCE_DIR) + "/assets", folder / "assets",
           fs::copy_options::recursive);
  {
    std::fstream file(folder / "assets/objects/carrot/visual.glb",
                      std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(2000);
    file.put('\x55');
  }
  options = options_for(folder / "run");
  options.assets = folder / "assets";
  CHECK(refused(options) ==
        "objects/carrot/visual.glb: its bytes are not the ones the plan was built with");
  fs::remove(folder / "assets/robots/widowx/meshes/wrist_link.glb");
  fs::copy_file(std::string(VLAPROBE_SOURCE_DIR) + "/assets/objects/carrot/visual.glb",
                folder / "assets/objects/carrot/visual.glb", fs::copy_options::overwrite_existing);
  CHECK(refused(options).starts_with(
      "robots/widowx/meshes/wrist_link.glb: this file of the plan is not in "));
}

TEST_CASE("a disk that fills up is told, leaves no partial file, and the run continues later") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 4);
  RunOptions options = options_for(folder / "run");
  options.seeds = {7};
  // Files may grow to the size of the plan and no further: traces of these episodes do not fit.
  const auto limit = static_cast<rlim_t>(plan.bytes().size());
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit size{limit, limit};
    ::setrlimit(RLIMIT_FSIZE, &size);
    const auto summary = run::run(plan, options);
    ::_exit(summary.ok() ? 0 : summary.failure().code == Fault::kStore ? 42 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 42);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "run")) {
    CHECK_MESSAGE(entry.path().extension() != ".tmp", entry.path().string());
  }
  must_run(plan, options);
  CHECK(hashes(folder / "run").size() == 2);
}

TEST_CASE("scripted policies run on the world: reach intends, noise depends on the seed") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 20);
  must_run(plan, options_for(folder / "reach", "reach"));
  const auto reach = read_results(folder / "reach");
  REQUIRE(reach->size() == 1);
  CHECK_MESSAGE(!reach->at(0).invalid, reach->at(0).invalid.value_or(""));
  CHECK(reach->at(0).metrics[1].name == "intention");
  CHECK(reach->at(0).metrics[1].value == 1);
  CHECK(reach->at(0).metrics[0].value == 0);
  must_run(plan, options_for(folder / "noisy", "noisy:0.003"));
  const auto noisy = hashes(folder / "noisy");
  REQUIRE(noisy.size() == 2);
  CHECK(noisy[0] != noisy[1]);
}

}  // namespace
}  // namespace probe::run
