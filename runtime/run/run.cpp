// Puts the parts together: selection, assets, store, workers.
#include "runtime/run/run.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <set>

#include "runtime/base/asset_root.h"
#include "runtime/base/paths.h"
#include "runtime/run/changed_folder.h"
#include "runtime/run/delivery.h"
#include "runtime/run/episode.h"
#include "runtime/run/policies.h"
#include "runtime/run/recorded.h"
#include "runtime/run/selection.h"
#include "runtime/run/workers.h"
#include "runtime/servers/reading.h"
#include "runtime/show/episode_video.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/robot_of.h"
#include "runtime/store/fingerprint.h"
#include "runtime/store/store.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;

// What all workers read, and what they write one at a time.
struct Shared {
  const plan::Plan& plan;
  const RunOptions& options;
  const Actor& actor;
  std::shared_ptr<const stage::SharedAssets> assets;
  std::string fingerprint;
  std::vector<EpisodeJob> jobs;
  store::Store& store;
  RunSummary& summary;
  policy::QueryMeter& queries;
  std::shared_ptr<servers::SharedModel> model;  // of all connections to a server
  std::shared_ptr<servers::SharedLine> line;    // of all worlds, where they ask in batches
  std::vector<std::pair<std::string, std::string>> measured;
  std::mutex mutex = {};                      // summary, progress and what follows
  std::vector<store::EpisodeKey> valid = {};  // of this call
  int lost_in_a_row = 0;  // episodes that a policy server's failures spoiled for good
  std::atomic<bool> given_up = false;
};

void add_once(std::vector<std::string>& notes, std::string note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
}

bool has_failed(const store::ResultRow& row) {
  if (row.invalid) return !store::is_not_attempted(row);
  for (const store::MetricValue& metric : row.metrics) {
    if (metric.name == "success") return metric.value == 0;
  }
  return false;
}

class EpisodeWorker {
 public:
  explicit EpisodeWorker(Shared& shared) : shared_(shared) {}

  Status begin() {
    run::PolicyContext context = policy_context();
    context.queries = &shared_.queries;
    context.model = shared_.model;
    context.line = shared_.line;
    context.measured = shared_.measured;
    PROBE_ASSIGN(policy_, shared_.actor.make(context));
    if (shared_.options.live)
      policy_ = policy::make_live(std::move(policy_), *shared_.options.live);
    return {};
  }

  Status run(std::size_t index) {
    const EpisodeJob& job = shared_.jobs[index];
    if (!stage_ || stage_->task() != job.task) {
      stage_.reset();  // frees the old before the new is made
      PROBE_ASSIGN(stage_, stage::Stage::create(shared_.plan, job.task, shared_.assets));
    }
    const store::TraceHeader header =
        make_trace_header(shared_.plan, job, *stage_, shared_.options.name, shared_.fingerprint,
                          shared_.options.live);
    PROBE_ASSIGN(const std::string path, shared_.store.temporary_trace(store::key_of(header)));
    for (int attempt = 0;; ++attempt) {
      auto played = write(job, header, path);
      if (!played) {
        std::error_code ignored;
        fs::remove(path, ignored);
        return played.failure();
      }
      if (!is_spoiled(*played) || attempt >= shared_.options.retries || shared_.given_up) {
        return commit(*played, static_cast<int>(job.task));
      }
      const std::lock_guard lock(shared_.mutex);
      ++shared_.summary.call.retried;
      shared_.summary.call.observations += played->row.steps;
    }
  }

 private:
  Result<Played> write(const EpisodeJob& job, const store::TraceHeader& header,
                       const std::string& path) {
    PROBE_ASSIGN(auto trace, store::TraceWriter::create(path, header));
    std::optional<show::EpisodeVideo> video;
    if (shared_.options.video != VideoChoice::kNone) {
      const std::string file = store::video_path(shared_.options.out, store::key_of(header));
      PROBE_TRY(make_folders(fs::path(file).parent_path().string()));
      video.emplace(header, file);
    }
    PROBE_ASSIGN(Played played,
                 run_episode(*stage_, shared_.plan, job, shared_.options.name, *policy_, *trace,
                             video ? &*video : nullptr, -1,
                             shared_.options.live ? shared_.options.live->most_held : 1));
    if (video) {
      const bool keep = shared_.options.video == VideoChoice::kAll || has_failed(played.row);
      PROBE_TRY(keep ? video->finish() : video->discard());
    }
    return played;
  }

  // Whether a policy server kept the episode from its end. Other failures, those of policies in
  // this process, and what profile and server do not agree on would only repeat themselves.
  bool is_spoiled(const Played& played) const {
    return !shared_.actor.traits.content.empty() && played.policy_fault &&
           *played.policy_fault != Fault::kUsage;
  }

  Status commit(const Played& played, int task_order) {
    const store::ResultRow& row = played.row;
    // Not under the lock: other worlds must not wait for the disk.
    PROBE_TRY(shared_.store.commit(row, task_order));
    const std::lock_guard lock(shared_.mutex);
    ++shared_.summary.done;
    shared_.summary.call.observations += row.steps;
    for (std::string& note : policy_->notes()) add_once(shared_.summary.notes, std::move(note));
    if (store::is_not_attempted(row)) {
      ++shared_.summary.not_attempted;
    } else if (row.invalid) {
      ++shared_.summary.invalid;
    } else {
      shared_.valid.push_back(store::key_of(row));
    }
    if (shared_.options.progress) {
      shared_.options.progress(
          {shared_.summary.done, shared_.summary.skipped, shared_.summary.total, &row});
    }
    if (!is_spoiled(played)) {
      if (!row.invalid) shared_.lost_in_a_row = 0;
      return {};
    }
    const int bound = shared_.options.give_up_after;
    if (bound == 0 || ++shared_.lost_in_a_row < bound) return {};
    shared_.given_up = true;
    return give_up(*row.invalid);
  }

  Failure give_up(const std::string& last) const {
    const RunSummary& summary = shared_.summary;
    const int stored = summary.skipped + summary.done - summary.invalid - summary.not_attempted;
    return {Fault::kPolicy,
            "the policy failed in " + std::to_string(shared_.lost_in_a_row) +
                " episodes in a row, the last time so: " + last + "\n  " + std::to_string(stored) +
                " of " + std::to_string(summary.total) + " episodes are stored in " + summary.out +
                "; when the server answers again, the same command continues",
            shared_.options.name};
  }

  Shared& shared_;
  std::unique_ptr<policy::Policy> policy_;
  std::unique_ptr<stage::Stage> stage_;
};

std::vector<std::uint32_t> tasks_of(const std::vector<EpisodeJob>& jobs) {
  std::set<std::uint32_t> tasks;
  for (const EpisodeJob& job : jobs) tasks.insert(job.task);
  return {tasks.begin(), tasks.end()};
}

// Rows of the run that `replay:DIR` repeats; only those that came to an end.
Result<std::vector<store::ResultRow>> recorded_rows(const std::string& dir) {
  const auto record = store::read_run_record(dir);
  auto rows = store::read_results(dir);
  for (const Failure* failure :
       {record ? nullptr : &record.failure(), rows ? nullptr : &rows.failure()}) {
    if (failure == nullptr) continue;
    return Failure{Fault::kUsage,
                   "DIR of `replay:DIR` is the folder of a run, but " + to_text(*failure),
                   "--policy"};
  }
  std::erase_if(*rows, [](const store::ResultRow& row) { return row.invalid.has_value(); });
  return rows;
}

// A policy that goes for a distractor stays still where there is none.
void note_idle_tasks(const plan::Plan& plan, const Selection& selection, const std::string& policy,
                     RunSummary& summary) {
  const std::vector<std::uint32_t> tasks = tasks_of(selection.jobs);
  const auto idle = std::count_if(tasks.begin(), tasks.end(), [&](std::uint32_t task) {
    return plan.tasks()[task].distractors == 0;
  });
  if (idle == 0) return;
  summary.notes.push_back("policy `" + policy + "` goes for a distractor and stays still in the " +
                          std::to_string(idle) + " of " + std::to_string(tasks.size()) +
                          " tasks that have none");
}

using store::EpisodeKey;

// Leaves the jobs that are not stored yet, or only as invalid. Returns the others.
Result<std::set<EpisodeKey>> drop_stored(const plan::Plan& plan, store::Store& store,
                                         std::vector<EpisodeJob>& jobs, RunSummary& summary) {
  constexpr std::size_t kToldOneByOne = 5;
  PROBE_ASSIGN(const auto stored, store.episodes());
  std::set<EpisodeKey> chosen, valid;
  for (const EpisodeJob& job : jobs) chosen.insert(key_of(plan, job));
  std::size_t again = 0;
  for (const store::StoredEpisode& episode : stored) {
    if (!chosen.contains(episode.key)) continue;
    if (episode.valid || episode.why.starts_with(store::kNotAttempted)) {
      valid.insert(episode.key);
    } else if (++again <= kToldOneByOne) {
      summary.notes.push_back(to_text(episode.key) + " was run again: " + episode.why);
    }
  }
  if (again > kToldOneByOne) {
    summary.notes.push_back(std::to_string(again - kToldOneByOne) +
                            " more invalid or damaged episodes were run again");
  }
  std::erase_if(jobs, [&](const EpisodeJob& job) { return valid.contains(key_of(plan, job)); });
  return valid;
}

// Videos are made while an episode runs; says how to get those of episodes that were there.
Status note_missing_videos(const RunOptions& options, const std::set<EpisodeKey>& stored,
                           RunSummary& summary) {
  if (options.video == VideoChoice::kNone || stored.empty()) return {};
  PROBE_ASSIGN(const auto rows, store::read_results(options.out));
  int missing = 0;
  std::string first;
  for (const store::ResultRow& row : rows) {
    if (!stored.contains(store::key_of(row))) continue;
    if (options.video == VideoChoice::kFailures && !has_failed(row)) continue;
    if (is_there(store::video_path(options.out, store::key_of(row)))) continue;
    if (missing++ == 0) {
      first = row.task + " " + std::to_string(row.episode) + " " + std::to_string(row.seed);
    }
  }
  if (missing > 0) {
    summary.notes.push_back(std::to_string(missing) +
                            " episodes that were there have no video; one is made by `vlaprobe "
                            "replay " +
                            options.out + " " + first + " --video FILE.mp4`");
  }
  return {};
}

// A server may move during a run, and be given more time: its rows keep the name that they began
// with. The content has all else that an address says.
bool has_only_moved(const store::RunIdentity& there, const store::RunIdentity& here) {
  return !there.policy_content.empty() && there.policy_content == here.policy_content &&
         there.policy != here.policy;
}

// The folder to write into, by `options.if_changed`; what is written in spite of a change becomes
// part of `record`.
Result<std::string> choose_folder(const RunOptions& options, store::RunRecord& record,
                                  std::vector<std::string>& notes) {
  const fs::path asked = fs::path(options.out).lexically_normal();
  const std::string base = (asked.has_filename() ? asked : asked.parent_path()).string();
  for (int copy = 1;; ++copy) {
    const std::string dir = copy == 1 ? options.out : base + "-" + std::to_string(copy);
    PROBE_ASSIGN(const auto stored, store::find_run_record(dir));
    if (!stored) return dir;
    const bool moved = options.name.empty() && has_only_moved(stored->identity, record.identity);
    store::RunRecord here = record;
    if (moved) here.identity.policy = stored->identity.policy;
    const store::RunChanges changes = store::changes_between(*stored, here);
    if (!changes.any()) {
      if (moved) notes.push_back("the rows keep the policy's name `" + here.identity.policy + "`");
      record = std::move(here);
      return dir;
    }
    PROBE_ASSIGN(const bool here_again,
                 goes_on(dir, {changes.identity, changes.policy_content, changes.build},
                         options.if_changed, notes));
    if (!here_again) continue;
    record.identity = stored->identity;
    return dir;
  }
}

// Two worlds at a server that keeps one episode's words would be done with each other's.
Status check_worlds(const RunOptions& options, const Actor& actor) {
  if (!actor.server || options.jobs <= 1) return {};
  const servers::Profile& profile = actor.server->profile;
  if (profile.worlds == servers::WorldsAtOnce::kMany) return {};
  return Failure{Fault::kUsage,
                 "profile `" + profile.name +
                     "` has `worlds = one`: the server keeps something of an episode for all who "
                     "ask it, and worlds would be done with each other's instructions; run with "
                     "--jobs 1, or say worlds=many of a policy that keeps nothing",
                 "--jobs"};
}

// A server of recorded episodes answers any seed with those of its own.
Status check_seeds(const Selection& selection, const Actor& actor) {
  if (!actor.server || !actor.server->only_seed) return {};
  const std::string own = std::to_string(*actor.server->only_seed);
  for (const EpisodeJob& job : selection.jobs) {
    if (job.seed == *actor.server->only_seed) continue;
    return Failure{Fault::kUsage,
                   "the server has the episodes of seed " + own + ", not of seed " +
                       std::to_string(job.seed) + ": run with --seeds " + own,
                   "--seeds"};
  }
  return {};
}

// Delays that are measured must be the policy's alone: not those of other worlds' questions, and
// not of a machine that is busy with other worlds.
Status check_live(const RunOptions& options, const Actor& actor) {
  if (!options.live) return {};
  const auto refused = [](const std::string& why, const char* where) {
    return Failure{Fault::kUsage, why, where};
  };
  if (actor.traits.recorded) {
    return refused("`replay:DIR` has the actions of every step at hand: nothing of it is late",
                   "--live");
  }
  if (options.live->delay_s) return {};
  if (options.jobs > 1) {
    return refused(
        "the worlds of a live run would wait for one another's answers, and the delays "
        "that are measured not be the policy's; run with --jobs 1, or give every answer "
        "a delay with --live-delay",
        "--jobs");
  }
  if (actor.server && actor.server->batch.most > 1) {
    return refused("questions of a live run do not wait for others: ask without `batch`",
                   "--policy");
  }
  return {};
}

// A batch holds no more than one question a world.
void note_batch(const RunOptions& options, const Actor& actor, RunSummary& summary) {
  if (!actor.server || actor.server->batch.most <= options.jobs) return;
  summary.notes.push_back("batches of " + std::to_string(actor.server->batch.most) +
                          " never fill with --jobs " + std::to_string(options.jobs) +
                          ": each world asks one question at a time");
}

// Whose state the questions carry: the first task's robot. Of the control laws of all tasks the one
// that takes the least.
Result<servers::KnownArm> arm_of(const plan::Plan& plan, const std::vector<EpisodeJob>& jobs,
                                 const stage::SharedAssets& assets) {
  const auto robot_in = [&](std::uint32_t task) -> const plan::RobotRecord& {
    return plan.robots()[plan.scenes()[plan.tasks()[task].scene].robot];
  };
  const plan::RobotRecord& record = robot_in(jobs.front().task);
  PROBE_ASSIGN(const robot::Robot robot, stage::robot_of(plan, record, *assets.robot(record.urdf)));
  servers::KnownArm arm{robot.control.arm_joints.size(), robot.control.finger_joints.size(), {}};
  for (const EpisodeJob& job : jobs) {
    if (robot_in(job.task).control == static_cast<std::uint32_t>(plan::Control::kOscPose))
      arm.control = robot::ControlKind::kOscPose;
  }
  return arm;
}

// A policy server's part of a run: what it is asked before the first episode and after the last.
struct ServerProof {
  servers::ServerChoice choice;
  servers::KnownArm arm;
  std::shared_ptr<servers::SharedModel> model;
};

ServerProof proof_of(servers::ServerChoice choice, int worlds, const servers::KnownArm& arm,
                     std::shared_ptr<servers::SharedModel> model) {
  // No batch of the run will hold more; of one question, a batch shows nothing.
  constexpr int kLeastShown = 2;
  choice.batch.most = std::min(choice.batch.most, std::max(worlds, kLeastShown));
  return {std::move(choice), arm, std::move(model)};
}

// What is shown of the server must be what it was when the folder was begun.
Status check_as_before(const policy::Reading& reading, const RunOptions& options,
                       std::vector<std::string>& notes) {
  PROBE_ASSIGN(const auto calls, store::read_run_calls(options.out));
  const store::ReadingChanges changes = store::changes_between(calls, reading);
  if (changes.measured) {
    return Failure{Fault::kStore,
                   "was begun with a server whose answers showed other units, forms or rotations; "
                   "say them in the profile, and take another folder",
                   options.out};
  }
  if (!changes.policy) return {};
  const std::string said =
      "was begun with a policy that answered the first questions otherwise than the one at " +
      reading.server + " does now: it is another one, or on a machine that rounds otherwise";
  if (options.if_changed == IfChanged::kContinue) {
    notes.push_back(options.out + " " + said + ": continued all the same");
    return {};
  }
  return Failure{Fault::kStore,
                 said +
                     "; take another folder, or --if-changed continue, which mixes them in this "
                     "one",
                 options.out};
}

// Nobody can say when it was exchanged, so what the call did is not to be believed.
Status check_to_the_end(const ServerProof& proof, Shared& shared) {
  policy::Reading& reading = *shared.summary.call.reading;
  reading.at_end = servers::prove_again(proof.choice, proof.model, proof.arm, reading);
  if (reading.at_end == policy::AtEnd::kUnclear)
    shared.summary.notes.push_back(policy::findings_of(reading).back());
  if (reading.at_end != policy::AtEnd::kOther) return {};
  PROBE_TRY(shared.store.invalidate(
      shared.valid, "policy: " + reading.server + ": " + std::string(store::Store::kExchanged)));
  return Failure{Fault::kPolicy,
                 "another policy answers than at the beginning: it was exchanged meanwhile, and "
                 "the " +
                     std::to_string(shared.valid.size()) +
                     " episodes of this call are invalid; the same command does them again",
                 reading.server};
}

// Whether what makes tasks different reached the policy, over all that the folder holds.
Status note_delivery(const plan::Plan& plan, const std::string& out, RunSummary& summary) {
  constexpr std::size_t kTold = 5;
  PROBE_ASSIGN(const auto rows, store::read_results(out));
  const auto findings = check_delivery(plan, rows);
  for (std::size_t i = 0; i < findings.size() && i < kTold; ++i) {
    summary.notes.push_back(findings[i].sentence);
  }
  if (findings.size() > kTold) {
    summary.notes.push_back(std::to_string(findings.size() - kTold) +
                            " more of this kind: `vlaprobe results " + out + " --delivery`");
  }
  return {};
}

// What the rows' name does not say of the policy: a server's profile; of a policy in this process
// that goes by another name, which one it is. Two policies under one name are not one run.
std::string content_of(const RunOptions& options, const PolicyTraits& traits) {
  if (!traits.content.empty() || options.own_policy) return traits.content;
  if (options.name.empty() || options.name == options.policy) return "";
  // A recorded run may have moved since.
  return std::string(store::kOwnPolicy) +
         (traits.recorded ? std::string("replay") : options.policy);
}

}  // namespace

Result<Actor> choose_actor(const RunOptions& options) {
  Actor actor;
  if (options.own_policy) {
    actor = {options.own_policy->traits, nullptr, options.own_policy->make};
  } else {
    PROBE_ASSIGN(auto choice, choose_policy(options.policy, options.accepts_any_certificate));
    actor = {choice.traits, choice.server, [choice](const run::PolicyContext& context) {
               return run::make_policy(choice, context);
             }};
  }
  PROBE_TRY(check_worlds(options, actor));
  PROBE_TRY(check_live(options, actor));
  // Made once before anything else, so that a policy that cannot be had is told before the folder
  // exists.
  if (auto made = actor.make(policy_context()); !made) return made.failure();
  return actor;
}

Result<RunSummary> run(const plan::Plan& plan, const RunOptions& asked) {
  RunOptions options = asked;
  PROBE_ASSIGN(const Actor actor, choose_actor(options));
  const run::PolicyTraits& traits = actor.traits;
  std::vector<store::ResultRow> recorded;
  if (traits.recorded) {
    PROBE_ASSIGN(recorded, recorded_rows(run::policy_argument(options.policy)));
  }
  PROBE_ASSIGN(Selection selection,
               select_jobs(plan, options, traits.draws, traits.recorded ? &recorded : nullptr));
  PROBE_ASSIGN(const std::string root, find_asset_root(options.assets));

  RunSummary summary;
  summary.notes = selection.notes;
  summary.total = static_cast<int>(selection.jobs.size());
  if (selection.jobs.empty()) {
    summary.notes.push_back("shard " + std::to_string(options.shard) + "/" +
                            std::to_string(options.shards) + " holds no episode: nothing to do");
    return summary;
  }
  PROBE_TRY(check_seeds(selection, actor));
  if (traits.wants_distractor) note_idle_tasks(plan, selection, options.policy, summary);
  // Assets are checked before the folder is touched: a plan that cannot run leaves nothing behind.
  PROBE_ASSIGN(auto assets, stage::SharedAssets::load(plan, root, tasks_of(selection.jobs)));
  const store::Fingerprint fingerprint = store::take_fingerprint(stage::asset_digest(plan));
  store::RunRecord record{
      {to_hex(plan.root()), options.name.empty() ? options.policy : options.name,
       content_of(options, traits), options.live ? to_text(*options.live) : ""},
      selection.suite,
      selection.seeds,
      fingerprint};
  PROBE_ASSIGN(options.out, choose_folder(options, record, summary.notes));
  options.name = record.identity.policy;
  PROBE_ASSIGN(auto store, store::Store::open(options.out, record, plan.bytes()));
  summary.out = options.out;
  PROBE_ASSIGN(const auto stored, drop_stored(plan, *store, selection.jobs, summary));
  summary.skipped = static_cast<int>(stored.size());
  PROBE_TRY(note_missing_videos(options, stored, summary));
  if (options.progress) options.progress({0, summary.skipped, summary.total, nullptr});
  if (selection.jobs.empty()) return summary;

  summary.call.fingerprint = fingerprint;
  summary.call.worlds =
      static_cast<int>(std::min(selection.jobs.size(), static_cast<std::size_t>(options.jobs)));
  const auto model = std::make_shared<servers::SharedModel>();
  std::optional<ServerProof> proof;
  if (actor.server) {
    PROBE_ASSIGN(const servers::KnownArm arm, arm_of(plan, selection.jobs, *assets));
    proof = proof_of(*actor.server, summary.call.worlds, arm, model);
    PROBE_ASSIGN(summary.call.reading, servers::prove_reading(proof->choice, model, arm));
    PROBE_TRY(check_as_before(*summary.call.reading, options, summary.notes));
    for (std::string& finding : policy::findings_of(*summary.call.reading))
      summary.notes.push_back(std::move(finding));
  }
  PROBE_TRY(store->write_call(summary.call));
  note_batch(options, actor, summary);
  policy::QueryMeter queries;
  Shared shared{.plan = plan,
                .options = options,
                .actor = actor,
                .assets = std::move(assets),
                .fingerprint = store::to_json(fingerprint),
                .jobs = std::move(selection.jobs),
                .store = *store,
                .summary = summary,
                .queries = queries,
                .model = model,
                .line = std::make_shared<servers::SharedLine>(),
                .measured = summary.call.reading ? summary.call.reading->measured
                                                 : decltype(Shared::measured)()};
  const auto make_worker = [&shared]() -> Result<Worker> {
    auto worker = std::make_shared<EpisodeWorker>(shared);
    PROBE_TRY(worker->begin());
    return Worker([worker](std::size_t index) { return worker->run(index); });
  };
  const Status ran = run_jobs(shared.jobs.size(), options.jobs, make_worker);
  summary.call.ended = true;
  summary.call.episodes = summary.done;
  summary.call.queries = queries.figures();
  // A world on the clock does not stand while it is asked for.
  if (options.live && !options.live->delay_s) summary.call.queries.waiting_s = 0;
  summary.call.elapsed_s = summary.call.queries.elapsed_s;
  Status unchanged;
  if (ran && proof) unchanged = check_to_the_end(*proof, shared);
  const Status written = store->write_call(summary.call);
  PROBE_TRY(ran);
  PROBE_TRY(written);
  PROBE_TRY(unchanged);
  PROBE_TRY(note_delivery(plan, options.out, summary));
  return summary;
}

}  // namespace probe::run
