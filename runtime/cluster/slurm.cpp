// Talks to Slurm by its programs sbatch and squeue.
#include "runtime/cluster/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <thread>

#include "runtime/base/file.h"
#include "runtime/base/inside.h"
#include "runtime/base/paths.h"
#include "runtime/base/percent.h"
#include "runtime/cluster/measured_time.h"
#include "runtime/cluster/program.h"
#include "runtime/cluster/run_words.h"
#include "runtime/run/selection.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/store.h"

namespace probe::cluster {
namespace {

namespace fs = std::filesystem;

Failure failed(const std::string& message, const std::string& where) {
  return {Fault::kCluster, message, where};
}

std::string trimmed(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

using store::EpisodeKey;

Result<std::set<EpisodeKey>> chosen_episodes(const plan::Plan& plan,
                                             const run::RunOptions& options) {
  std::string policy = options.policy;  // where its server is does not matter for what it draws
  for (const auto& [place, any] : {std::pair{"{port}", "1"}, std::pair{"{host}", "127.0.0.1"}}) {
    if (const auto at = policy.find(place); at != std::string::npos) policy.replace(at, 6, any);
  }
  run::RunOptions whole = options;
  whole.policy = policy;
  whole.shard = whole.shards = 1;
  // Every task would refuse what one does.
  PROBE_ASSIGN(const run::Actor actor, run::choose_actor(whole));
  if (actor.traits.recorded) {
    return Failure{Fault::kUsage, "a replay needs no cluster; `vlaprobe run` does it", "--policy"};
  }
  PROBE_ASSIGN(const run::Selection selection, run::select_jobs(plan, whole, actor.traits.draws));
  std::set<EpisodeKey> chosen;
  for (const run::EpisodeJob& job : selection.jobs) chosen.insert(run::key_of(plan, job));
  return chosen;
}

Status write_plan(const fs::path& path, const plan::Plan& plan) {
  if (is_there(path.string())) {
    PROBE_ASSIGN(const plan::Plan there, plan::Plan::open(path.string()));
    if (there.root() == plan.root()) return {};
    return Failure{Fault::kStore,
                   "was begun with another plan (root " + to_hex(there.root()).substr(0, 12) +
                       ", this one is " + to_hex(plan.root()).substr(0, 12) +
                       "); take another folder or remove this one",
                   path.parent_path().parent_path().string()};
  }
  return write_file(path.string(), plan.bytes());
}

// "3 RUNNING, 1 PENDING" of a job's tasks, or nothing when it is over.
Result<std::string> ask_queue(const std::string& job) {
  std::string last;
  // A controller that restarts does not answer for a while.
  for (int attempt = 0; attempt < 10; ++attempt) {
    if (attempt > 0) std::this_thread::sleep_for(std::chrono::seconds(attempt));
    PROBE_ASSIGN(const ProgramOutput asked,
                 run_program({"squeue", "--noheader", "--array", "--jobs", job, "--format=%T"}));
    if (asked.status == 0) {
      std::map<std::string, int> states;
      std::istringstream lines(asked.out);
      for (std::string state; lines >> state;) ++states[state];
      std::string text;
      for (const auto& [state, count] : states) {
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + state;
      }
      return text;
    }
    // Slurm forgets jobs some minutes after their end.
    if (asked.err.find("Invalid job id") != std::string::npos) return std::string();
    last = trimmed(asked.err);
  }
  return failed("does not answer any more: " + last + "\n  job " + job +
                    " goes on if it can; the same command waits for it again",
                "squeue");
}

Status wait_for(const std::string& job, const ArrayOptions& options) {
  std::string told;
  for (;;) {
    PROBE_ASSIGN(const std::string states, ask_queue(job));
    if (states.empty()) return {};
    if (states != told && options.tell) options.tell("job " + job + ": " + states);
    told = states;
    std::this_thread::sleep_for(std::chrono::duration<double>(options.poll_s));
  }
}

// `after`: number of a job that must have ended before; empty: of none.
Result<std::string> submit(const fs::path& script, const std::string& after = "") {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  if (!after.empty()) words.push_back("--dependency=afterany:" + after);
  words.push_back(script.string());
  PROBE_ASSIGN(const ProgramOutput sent, run_program(words));
  if (sent.status != 0) return failed("refused the job: " + trimmed(sent.err), script.string());
  const std::string answer = trimmed(sent.out);  // "17" or "17;cluster"
  const std::string job = answer.substr(0, answer.find(';'));
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos) {
    return failed("answered `" + answer + "` instead of a job's number", "sbatch");
  }
  return job;
}

// The same of what lies in `folder`; its number is kept there under `name`, for later calls.
Result<std::string> submit_there(const fs::path& folder, const char* script, const char* name,
                                 const std::string& after = "") {
  PROBE_ASSIGN(std::string job, submit(folder / script, after));
  PROBE_TRY(write_file((folder / name).string(), std::as_bytes(std::span(job))));
  return job;
}

// The job of an earlier call that has not ended; empty: none.
Result<std::string> job_under_way(const fs::path& file) {
  if (!is_there(file.string())) return std::string();
  PROBE_ASSIGN(const std::string text, read_file(file.string()));
  const std::string job = trimmed(text);
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos) return std::string();
  PROBE_ASSIGN(const std::string states, ask_queue(job));
  return states.empty() ? std::string() : job;
}

std::string last_line(const fs::path& file) {
  const auto text = read_file(file.string());
  std::string last;
  std::istringstream lines(text ? *text : std::string());
  for (std::string line; std::getline(lines, line);) {
    if (!trimmed(line).empty()) last = trimmed(line);
  }
  return last;
}

// The shards that exist, joined into `out`.
Status join(const ArrayWork& work, const ArrayOptions& options, const std::string& out,
            bool mixed_builds, SlurmReport& report) {
  store::MergeOptions merging;
  merging.out = out;
  merging.mixed_builds = mixed_builds;
  for (int shard = 1; shard <= options.script.tasks; ++shard) {
    const std::string dir = out + "/" + shard_folder(shard, options.script.tasks);
    PROBE_ASSIGN(const bool is_begun, work.is_begun(dir));
    if (is_begun) merging.dirs.push_back(dir);
  }
  if (merging.dirs.empty()) return {};
  PROBE_ASSIGN(report.merged, work.merge(merging));
  return {};
}

std::int64_t sum_of(const std::map<int, std::int64_t>& counts) {
  std::int64_t sum = 0;
  for (const auto& [shard, count] : counts) sum += count;
  return sum;
}

void note_unfinished(const std::map<int, std::int64_t>& lacking, const ArrayWork& work,
                     const std::string& out, SlurmReport& report) {
  for (const auto& [shard, count] : lacking) {
    const fs::path log = fs::path(out) / "slurm/log" / (std::to_string(shard) + ".txt");
    const std::string said = last_line(log);
    report.notes.push_back(std::to_string(count) + " " + work.things() + " of shard " +
                           std::to_string(shard) + " are missing; " + log.string() +
                           (said.empty() ? " is not there" : " ends with: " + said));
  }
}

// Submits what there is to do and does not wait: the array where a shard lacks something, and what
// joins its shards. Reads shards, and joins none: this may be a login node. `report` has the jobs
// that are under way.
Result<SlurmReport> detach(const ArrayWork& work, const ArrayOptions& options,
                           const std::string& out, SlurmReport report) {
  const fs::path folder = fs::path(out) / "slurm";
  const auto tell = [&](const std::string& sentence) {
    if (options.tell) options.tell(sentence);
  };
  PROBE_ASSIGN(auto lacking, work.missing(out, options.script.tasks));
  report.stored = report.total - sum_of(lacking);
  if (!report.merge_job.empty() || (lacking.empty() && report.job.empty())) {
    if (!report.merge_job.empty())
      tell("nothing is submitted: job " + report.merge_job + " is under way");
    return report;
  }
  // What shards have that were not joined yet.
  std::erase_if(lacking, [&](const auto& shard) {
    const std::string dir = out + "/" + shard_folder(shard.first, options.script.tasks);
    const auto left = work.missing(dir, options.script.tasks);
    return left.ok() && !left->contains(shard.first);
  });
  if (report.job.empty() && !lacking.empty()) {
    PROBE_ASSIGN(report.job, submit_there(folder, "job.sh", "job"));
    tell("job " + report.job + " submitted");
  }
  auto sent = submit_there(folder, "merge.sh", "merge_job", report.job);
  if (!sent) {
    Failure refused = sent.failure();
    refused.message += report.job.empty() ? ""
                                          : "; job " + report.job +
                                                " goes on, and the same command submits this again";
    return refused;
  }
  report.merge_job = *sent;
  tell("job " + report.merge_job + " joins the shards" +
       (report.job.empty() ? "" : " when job " + report.job + " has ended") + "; it speaks in " +
       (folder / "log/merge.txt").string());
  return report;
}

class RunWork final : public ArrayWork {
 public:
  RunWork(const plan::Plan& plan, const run::RunOptions& options, std::set<EpisodeKey> chosen)
      : plan_(plan), options_(options), chosen_(std::move(chosen)) {}

  FolderKind folder_kind() const override { return FolderKind::kRun; }
  std::string verb() const override { return "run"; }
  std::string actor_flag() const override { return "--policy"; }
  std::string actor() const override { return options_.policy; }
  std::string name() const override {
    return options_.name.empty() ? options_.policy : options_.name;
  }
  std::string things() const override { return "episodes"; }
  std::vector<std::string> words() const override { return run_words(options_); }
  std::int64_t total() const override { return static_cast<std::int64_t>(chosen_.size()); }

  Status check_same(const std::string& out) const override {
    PROBE_ASSIGN(const auto record, store::find_run_record(out));
    if (!record) return {};
    store::RunRecord asked = *record;
    asked.identity.plan_root = to_hex(plan_.root());
    asked.identity.policy = name();
    asked.identity.live = options_.live ? to_text(*options_.live) : "";
    asked.identity.until.clear();
    const std::string change = store::changes_between(*record, asked).identity;
    if (change.empty()) return {};
    return Failure{Fault::kStore, change + "; take another folder or remove this one", out};
  }

  Result<bool> is_begun(const std::string& dir) const override {
    PROBE_ASSIGN(const auto record, store::find_run_record(dir));
    return record.has_value();
  }

  Result<std::map<int, std::int64_t>> missing(const std::string& dir, int shards) const override {
    std::set<EpisodeKey> left = chosen_;
    PROBE_ASSIGN(const bool has_rows, is_begun(dir));
    if (has_rows) {
      PROBE_ASSIGN(const auto rows, store::read_results(dir));
      for (const store::ResultRow& row : rows) {
        if (!store::is_open(row)) left.erase(store::key_of(row));
      }
    }
    std::map<int, std::int64_t> lacking;
    for (const auto& [task, episode, seed] : left) {
      const auto index = plan_.find_task(task);
      if (!index) continue;
      const auto episodes = plan_.episodes(plan_.tasks()[*index]);
      const Sha256 id{episodes[static_cast<std::size_t>(episode)].episode_id};
      ++lacking[run::shard_of(id, seed, shards)];
    }
    return lacking;
  }

  Result<store::MergeSummary> merge(const store::MergeOptions& options) const override {
    return store::merge(options);
  }

 private:
  const plan::Plan& plan_;
  const run::RunOptions& options_;
  std::set<EpisodeKey> chosen_;
};

// Of the task that lacks the most, with the server's wait and five minutes to begin; 0 where
// nothing is lacking.
Result<std::int64_t> time_by(const SlurmOptions& options, const RunWork& work) {
  constexpr std::int64_t kBegin = 300;  // s
  PROBE_ASSIGN(const MeasuredTime measured, measured_time(options.time_from));
  PROBE_ASSIGN(const auto lacking,
               work.missing(absolute_path(options.run.out), options.script.tasks));
  std::int64_t most = 0;
  for (const auto& [shard, count] : lacking) most = std::max(most, count);
  const std::int64_t begin =
      kBegin + (options.script.server_command.empty() ? 0 : options.script.server_wait_s);
  if (most == 0) return 0;
  if (options.tell) {
    options.tell(fmt::format(
        "each task asks for time as measured: {} episodes of {} s by {} at once, half as much "
        "again, and {} minutes to begin{}",
        most, decimal_text(measured.seconds, 1), options.run.jobs, (begin + 59) / 60,
        measured.worlds == options.run.jobs
            ? ""
            : fmt::format(" (measured with {} at once: a server may be slower or faster by that)",
                          measured.worlds)));
  }
  return begin + static_cast<std::int64_t>(
                     std::ceil(time_for(measured, most, std::max(1, options.run.jobs))));
}

}  // namespace

Result<SlurmReport> run_on_slurm(const plan::Plan& plan, const SlurmOptions& options) {
  PROBE_ASSIGN(auto chosen, chosen_episodes(plan, options.run));
  const RunWork work(plan, options.run, std::move(chosen));
  ArrayOptions array = options;
  if (!options.time_from.empty()) {
    PROBE_ASSIGN(array.script.time_s, time_by(options, work));
  }
  return work_on_slurm(plan, work, options.run.out, options.run.jobs,
                       options.run.if_changed == run::IfChanged::kContinue, array);
}

Result<SlurmReport> work_on_slurm(const plan::Plan& plan, const ArrayWork& work,
                                  const std::string& given_out, int worlds, bool mixed_builds,
                                  const ArrayOptions& options) {
  const std::string out = absolute_path(given_out);
  const fs::path folder = fs::path(out) / "slurm";
  SlurmReport report;
  report.script = (folder / "job.sh").string();
  report.total = work.total();

  JobScript script = options.script;
  script.verb = work.verb();
  script.actor_flag = work.actor_flag();
  script.out = out;
  script.plan = (folder / "suite.plan").string();
  script.policy = work.actor();
  script.name = work.name();
  script.worlds = worlds;
  script.run_arguments = work.words();
  PROBE_ASSIGN(const std::string text, to_text(script));
  PROBE_ASSIGN(const std::string merge, merge_text(script, mixed_builds));
  PROBE_TRY(check_holds_no_other(out, work.folder_kind()));
  PROBE_TRY(work.check_same(out));
  // The jobs write there, too.
  for (const char* const own : {"slurm", "slurm/log", "shards"})
    PROBE_TRY(check_all_inside(out, own));
  std::error_code error;
  fs::create_directories(folder / "log", error);
  if (error) return Failure{Fault::kIo, "cannot be made: " + error.message(), folder.string()};
  PROBE_TRY(write_plan(folder / "suite.plan", plan));
  PROBE_TRY(write_file(report.script, std::as_bytes(std::span(text))));
  PROBE_TRY(write_file((folder / "merge.sh").string(), std::as_bytes(std::span(merge))));
  for (const fs::path& written : {fs::path(report.script), folder / "merge.sh"})
    fs::permissions(written, fs::perms::owner_exec, fs::perm_options::add, error);
  if (!options.submit) return report;

  PROBE_ASSIGN(report.job, job_under_way(folder / "job"));
  PROBE_ASSIGN(report.merge_job, job_under_way(folder / "merge_job"));
  if (options.detach) return detach(work, options, out, std::move(report));
  // Two that join would be in each other's way.
  if (!report.merge_job.empty()) {
    if (!report.job.empty()) PROBE_TRY(wait_for(report.job, options));
    PROBE_TRY(wait_for(report.merge_job, options));
    report.job.clear();
  }
  // A job that ended while nobody waited has shards that are not merged yet.
  if (report.job.empty()) PROBE_TRY(join(work, options, out, mixed_builds, report));
  PROBE_ASSIGN(auto lacking, work.missing(out, options.script.tasks));
  if (report.job.empty() && !lacking.empty()) {
    PROBE_ASSIGN(report.job, submit_there(folder, "job.sh", "job"));
    if (options.tell) options.tell("job " + report.job + " submitted");
  }
  if (!report.job.empty()) {
    PROBE_TRY(wait_for(report.job, options));
    PROBE_TRY(join(work, options, out, mixed_builds, report));
    PROBE_ASSIGN(lacking, work.missing(out, options.script.tasks));
  }
  report.stored = report.total - sum_of(lacking);
  note_unfinished(lacking, work, out, report);
  return report;
}

}  // namespace probe::cluster
