// A run on a real Slurm of this machine, with a task that is killed and requeued.
#include "runtime/cluster/slurm.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

#include "runtime/base/file.h"
#include "runtime/cluster/program.h"
#include "runtime/store/store.h"
#include "tests/runtime/cluster/cluster.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/servers/python_server.h"

namespace probe::cluster {
namespace {

namespace fs = std::filesystem;

SlurmOptions options_for(const std::string& out) {
  SlurmOptions options;
  options.run.policy = "random";
  options.run.out = out;
  options.script.program = VLAPROBE_BINARY_DIR "/vlaprobe";
  options.script.tasks = 4;
  options.submit = true;
  options.poll_s = 0.2;
  return options;
}

std::vector<store::ResultRow> rows_of(const std::string& dir) {
  const auto rows = store::read_results(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  std::vector<store::ResultRow> all = *rows;
  for (store::ResultRow& row : all) row.trace = "";
  return all;
}

// Those of one process that asks one server of its own.
std::vector<store::ResultRow> rows_of_one_server(const plan::Plan& plan, const SlurmOptions& options,
                                                 const std::string& out) {
  const test::PythonServer server("openpi_digest_server.py");
  run::RunOptions single = options.run;
  single.policy = "openpi://127.0.0.1:" + server.port();
  single.name = options.run.policy;
  single.out = out;
  const auto summary = run::run(plan, single);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  return rows_of(out);
}

// How often a task was started, by its log.
int starts_in(const std::string& log) {
  const auto text = read_file(log);
  int starts = 0;
  if (!text) return starts;
  for (std::size_t at = 0; (at = text->find(": job ", at)) != std::string::npos; ++at) ++starts;
  return starts;
}

bool waited_for(const std::function<bool()>& true_at_last) {
  for (int i = 0; i < 600; ++i) {
    if (true_at_last()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST_CASE("what every task would refuse is refused before a script is written") {
  const run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(1, 3);
  const auto refusal = [&](auto&& change) {
    SlurmOptions options = options_for(folder / "x");
    options.submit = false;
    change(options.run);
    const auto refused = run_on_slurm(plan, options);
    CHECK_FALSE(fs::exists(folder / "x"));
    return refused.ok() ? std::string() : refused.failure().message;
  };
  CHECK(refusal([](run::RunOptions& run) {
          run.live.emplace();
          run.jobs = 4;
        }).find("the worlds of a live run would wait for one another's answers") == 0);
  CHECK(refusal([](run::RunOptions& run) {
          run.live.emplace();
          run.policy = "openpi://127.0.0.1:{port}?batch=8";
        }) == "questions of a live run do not wait for others: ask without `batch`");
  CHECK(refusal([](run::RunOptions& run) {
          run.policy = "intact://127.0.0.1:{port}?model=/m";
          run.jobs = 2;
        }).find("has `worlds = one`") != std::string::npos);
}

TEST_CASE("four array tasks, one killed and requeued, merged: the rows of a single run") {
  run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(16, 40);
  const Cluster cluster(folder / "cluster");
  if (!cluster.ready()) {
    MESSAGE("skipped: ", cluster.said());
    return;
  }
  REQUIRE(fs::exists(options_for("").script.program));
  const std::string out = folder / "it's a run";
  const std::string second = out + "/" + shard_folder(2, 4);
  // While the job runs: the second task is killed in the middle of its shard and queued again.
  std::atomic<int> rows_when_killed = -1;
  std::thread killer([&] {
    const auto some_rows = [&] {
      const auto rows = store::read_results(second);
      if (rows.ok()) rows_when_killed = static_cast<int>(rows->size());
      return rows_when_killed > 0;
    };
    if (!waited_for(some_rows)) return;
    const std::string job = read_file(out + "/slurm/job").value();
    CHECK(run_program({"scontrol", "requeue", job + "_2"})->status == 0);
    // A node takes a job again only in a later second than the one it was killed in; by itself
    // Slurm lets a requeued task wait for two minutes.
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));
    CHECK(waited_for([&] {
      const auto hurried =
          run_program({"scontrol", "update", "JobId=" + job + "_2", "StartTime=now"});
      return hurried.ok() && starts_in(out + "/slurm/log/2.txt") == 2;
    }));
  });
  std::vector<std::string> told;
  SlurmOptions options = options_for(out);
  options.tell = [&](const std::string& sentence) { told.push_back(sentence); };
  const auto report = run_on_slurm(plan, options);
  killer.join();
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  for (const std::string& note : report->notes) MESSAGE(note);
  CHECK(report->total == 32);
  CHECK(report->stored == 32);
  CHECK(report->merged.added == 32);
  CHECK(told.size() > 1);
  CHECK(told.at(0) == "job " + report->job + " submitted");
  CHECK(starts_in(out + "/slurm/log/2.txt") == 2);
  CHECK(rows_when_killed < 8);

  run::RunOptions single = options.run;
  single.out = folder / "single";
  single.jobs = 2;
  const auto summary = run::run(plan, single);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(rows_of(out) == rows_of(folder / "single"));

  // Again: nothing is submitted.
  const auto again = run_on_slurm(plan, options);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK(again->job.empty());
  CHECK(again->stored == 32);
}

TEST_CASE("each task starts its own server, and the rows are those of a run with one") {
  run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(6, 6);
  const Cluster cluster(folder / "cluster");
  if (!cluster.ready()) {
    MESSAGE("skipped: ", cluster.said());
    return;
  }
  SlurmOptions options = options_for(folder / "run");
  options.run.policy = "openpi://127.0.0.1:{port}";
  options.run.seeds = {1};
  options.script.tasks = 2;
  options.script.server_command =
      "exec /usr/bin/python3 " VLAPROBE_SOURCE_DIR "/tests/servers/openpi_digest_server.py {port}";
  options.script.server_wait_s = 30;
  const auto report = run_on_slurm(plan, options);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  for (const std::string& note : report->notes) MESSAGE(note);
  CHECK(report->stored == 6);

  CHECK(rows_of(folder / "run") == rows_of_one_server(plan, options, folder / "single"));
}

TEST_CASE("one server on a node of its own is asked by shards on others, and started again when it dies") {
  run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(6, 6);
  const Cluster cluster(folder / "cluster", 3, 2);
  if (!cluster.ready()) {
    MESSAGE("skipped: ", cluster.said());
    return;
  }
  SlurmOptions options = options_for(folder / "a run");
  options.run.policy = "openpi://{host}:{port}";
  options.run.seeds = {1};
  options.script.tasks = 3;
  options.script.server_apart = true;
  options.script.server_sbatch = {"--nodelist=node3"};
  options.script.sbatch = {"--exclude=node3"};
  // The first server goes at once.
  const std::string mark = folder / "begun";
  options.script.server_command =
      "[ -e " + mark + " ] || { touch " + mark +
      "; exit 3; }; exec /usr/bin/python3 " VLAPROBE_SOURCE_DIR
      "/tests/servers/openpi_digest_server.py {port}";
  options.script.server_wait_s = 30;
  const auto report = run_on_slurm(plan, options);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  for (const std::string& note : report->notes) MESSAGE(note);
  const auto log = read_file(folder / "a run/slurm/log/job.txt");
  REQUIRE(log.ok());
  CHECK_MESSAGE(log->find("the server ended before it answered") != std::string::npos, *log);
  CHECK_MESSAGE(report->stored == 6, *log);

  CHECK(rows_of(folder / "a run") == rows_of_one_server(plan, options, folder / "single"));
}

TEST_CASE("tasks that a more urgent job preempts go on behind it") {
  run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(12, 40);
  const Cluster cluster(folder / "cluster");
  if (!cluster.ready()) {
    MESSAGE("skipped: ", cluster.said());
    return;
  }
  const std::string out = folder / "run";
  std::atomic<bool> was_preempted = false;
  std::thread urgent([&] {
    const auto some_rows = [&] {
      const auto rows = store::read_results(out + "/" + shard_folder(1, 2));
      return rows.ok() && !rows->empty();
    };
    if (!waited_for(some_rows)) return;
    const auto sent = run_program({"sbatch", "--parsable", "--partition=urgent", "--exclusive",
                                   "--output=/dev/null", "--wrap", "sleep 2"});
    CHECK(sent->status == 0);
    const std::string job = read_file(out + "/slurm/job").value();
    const auto state_of = [&](const char* state) {
      const auto said = run_program({"squeue", "--noheader", "--array", "--jobs", job, "--format=%t"});
      return said.ok() && said->out.find(state) != std::string::npos;
    };
    if (!waited_for([&] { return state_of("PD") || state_of("CG"); })) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));
    was_preempted = waited_for([&] {
      for (const char* task : {"_1", "_2"})
        (void)run_program({"scontrol", "update", "JobId=" + job + task, "StartTime=now"});
      return starts_in(out + "/slurm/log/1.txt") >= 2;
    });
  });
  SlurmOptions options = options_for(out);
  options.script.tasks = 2;
  const auto report = run_on_slurm(plan, options);
  urgent.join();
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  for (const std::string& note : report->notes) MESSAGE(note);
  CHECK(was_preempted);
  CHECK(report->stored == 24);
  run::RunOptions single = options.run;
  single.out = folder / "single";
  single.jobs = 2;
  REQUIRE(run::run(plan, single).ok());
  CHECK(rows_of(out) == rows_of(folder / "single"));
}

TEST_CASE("a node that dies with all that runs on it: its tasks go on elsewhere, the rows are a single run's") {
  const auto done = run_program({"env", "SLURM_MANY_LIMIT=600", "bash",
                                 VLAPROBE_SOURCE_DIR "/tests/slurm_many.sh", "6", "192", "3", "1",
                                 VLAPROBE_BINARY_DIR "/vlaprobe"});
  REQUIRE(done.ok());
  MESSAGE(done->out);
  CHECK_MESSAGE(done->status == 0, done->err);
}

TEST_CASE("nobody waits: a second job joins what the first one made, and its time is measured") {
  run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(8, 20);
  const Cluster cluster(folder / "cluster");
  if (!cluster.ready()) {
    MESSAGE("skipped: ", cluster.said());
    return;
  }
  run::RunOptions trial;
  trial.policy = "random";
  trial.out = folder / "trial";
  trial.seeds = {1};
  REQUIRE(run::run(plan, trial).ok());

  const std::string out = folder / "run";
  SlurmOptions options = options_for(out);
  options.script.tasks = 2;
  options.detach = true;
  options.time_from = trial.out;
  std::vector<std::string> told;
  options.tell = [&](const std::string& sentence) { told.push_back(sentence); };
  const auto sent = run_on_slurm(plan, options);
  REQUIRE_MESSAGE(sent.ok(), to_text(sent.failure()));
  REQUIRE_FALSE(sent->job.empty());
  REQUIRE_FALSE(sent->merge_job.empty());
  CHECK(sent->total == 16);
  REQUIRE(told.size() == 3);
  CHECK_MESSAGE(told[0].starts_with("each task asks for time as measured: "), told[0]);
  CHECK(told[2].starts_with("job " + sent->merge_job + " joins the shards when job " + sent->job +
                            " has ended"));
  CHECK(read_file(sent->script)->find("#SBATCH --time=00:06:00\n") != std::string::npos);
  // Again, while they are under way: nothing more. Or they are over, and nothing is missing.
  told.clear();
  const auto again = run_on_slurm(plan, options);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK((again->stored == 16 || told.back().starts_with("nothing is submitted: job ")));
  CHECK(waited_for([&] {
    const auto left = run_program({"squeue", "--noheader", "--jobs", sent->merge_job});
    return left.ok() && left->out.empty();
  }));
  CHECK(rows_of(out).size() == 16);
  options.detach = false;
  const auto last = run_on_slurm(plan, options);
  REQUIRE_MESSAGE(last.ok(), to_text(last.failure()));
  CHECK(last->job.empty());
  CHECK(last->stored == 16);
  run::RunOptions single = options.run;
  single.out = folder / "single";
  REQUIRE(run::run(plan, single).ok());
  CHECK(rows_of(out) == rows_of(folder / "single"));

  options.time_from = folder / "cluster";
  const auto refused = run_on_slurm(plan, options);
  REQUIRE_FALSE(refused.ok());
  CHECK_MESSAGE(refused.failure().message.find(
                    "holds no call of `run` that ended with an episode") != std::string::npos,
                refused.failure().message);
}

TEST_CASE("a job that cannot work is told with its log, and stays to be continued") {
  run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(2, 2);
  const Cluster cluster(folder / "cluster");
  if (!cluster.ready()) {
    MESSAGE("skipped: ", cluster.said());
    return;
  }
  SlurmOptions options = options_for(folder / "run");
  options.script.tasks = 2;
  options.script.program = "/no/such/vlaprobe";
  const auto report = run_on_slurm(plan, options);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(report->total == 4);
  CHECK(report->stored == 0);
  REQUIRE_FALSE(report->notes.empty());
  CHECK(report->notes[0].find("No such file or directory") != std::string::npos);
  options.script.program = VLAPROBE_BINARY_DIR "/vlaprobe";
  CHECK(run_on_slurm(plan, options)->stored == 4);
  options.script.sbatch = {"--partition=nowhere"};
  options.run.out = folder / "other";
  const auto refused = run_on_slurm(plan, options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kCluster);
  CHECK(refused.failure().message.find("partition") != std::string::npos);
}

TEST_CASE("without --submit the job is written, and needs no Slurm") {
  run::TemporaryFolder folder;
  SlurmOptions options = options_for(folder / "run");
  options.submit = false;
  const auto report = run_on_slurm(run::table_plan(2, 2), options);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(report->total == 4);
  CHECK(fs::exists(report->script));
  CHECK(fs::exists(folder / "run/slurm/suite.plan"));
  const auto other = run_on_slurm(run::table_plan(2, 3), options);
  REQUIRE_FALSE(other.ok());
  CHECK(other.failure().message.starts_with("was begun with another plan (root "));
  options.run.policy = "replay:" + (folder / "run");
  CHECK_FALSE(run_on_slurm(run::table_plan(2, 2), options).ok());
}

}  // namespace
}  // namespace probe::cluster
