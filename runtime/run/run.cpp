// Puts the parts together: selection, assets, store, workers.
#include "runtime/run/run.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>

#include "runtime/adaptive/sampled.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/paths.h"
#include "runtime/plan/roles.h"
#include "runtime/run/adaptive_jobs.h"
#include "runtime/run/callers_proof.h"
#include "runtime/run/changed_folder.h"
#include "runtime/run/delivery.h"
#include "runtime/run/episode_worker.h"
#include "runtime/run/policies.h"
#include "runtime/run/policy_name.h"
#include "runtime/run/recorded.h"
#include "runtime/run/selection.h"
#include "runtime/run/server_proof.h"
#include "runtime/run/workers.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/robot_of.h"
#include "runtime/store/chosen.h"
#include "runtime/store/callers_policy.h"
#include "runtime/store/fingerprint.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/store.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint32_t> tasks_of(const std::vector<EpisodeJob>& jobs) {
  std::set<std::uint32_t> tasks;
  for (const EpisodeJob& job : jobs) tasks.insert(job.task);
  return {tasks.begin(), tasks.end()};
}

std::vector<std::uint32_t> all_tasks(const plan::Plan& plan) {
  std::vector<std::uint32_t> tasks(plan.tasks().size());
  std::iota(tasks.begin(), tasks.end(), 0u);
  return tasks;
}

std::vector<EpisodeJob> one_of_each(const plan::Plan& plan) {
  std::vector<EpisodeJob> jobs;
  for (const std::uint32_t task : all_tasks(plan)) jobs.push_back({task, 0, 0});
  return jobs;
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
    return plan.tasks()[task].distractors == 0 &&
           plan::part_distractors_of(plan.tables(), plan.tasks()[task]).empty();
  });
  if (idle == 0) return;
  summary.notes.push_back("policy `" + policy + "` goes for a distractor and stays still in the " +
                          std::to_string(idle) + " of " + std::to_string(tasks.size()) +
                          " tasks that have none");
}

using store::EpisodeKey;

// Leaves the jobs that are not stored yet, or only as invalid. Returns the others. Where a rule chooses,
// nobody knows yet which of the invalid ones it comes to again.
std::set<EpisodeKey> drop_stored(const plan::Plan& plan,
                                 const std::vector<store::StoredEpisode>& stored, bool has_rule,
                                 std::vector<EpisodeJob>& jobs, RunSummary& summary) {
  constexpr std::size_t kToldOneByOne = 5;
  std::set<EpisodeKey> chosen, valid;
  for (const EpisodeJob& job : jobs) chosen.insert(key_of(plan, job));
  std::size_t again = 0;
  for (const store::StoredEpisode& episode : stored) {
    if (!chosen.contains(episode.key)) continue;
    if (episode.valid || store::is_not_attempted(episode.why)) {
      valid.insert(episode.key);
    } else if (++again <= kToldOneByOne) {
      summary.notes.push_back(to_text(episode.key) +
                              (has_rule ? " is run again if the rule needs it: " : " was run again: ") +
                              episode.why);
    }
  }
  if (again > kToldOneByOne) {
    summary.notes.push_back(std::to_string(again - kToldOneByOne) +
                            (has_rule ? " more invalid or damaged episodes are run again if it does"
                                      : " more invalid or damaged episodes were run again"));
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
    if (options.drops_until) here.identity.until = stored->identity.until;
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
Status check_seeds(const std::vector<EpisodeJob>& jobs, const Actor& actor) {
  if (!actor.server || !actor.server->only_seed) return {};
  const std::string own = std::to_string(*actor.server->only_seed);
  for (const EpisodeJob& job : jobs) {
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

// Whose state the questions carry: the first task's robot. Of the control laws of all tasks one
// that does not take every form; each episode begins with its own robot's.
Result<servers::KnownArm> arm_of(const plan::Plan& plan, const std::vector<EpisodeJob>& jobs,
                                 const stage::SharedAssets& assets) {
  const auto robot_in = [&](std::uint32_t task) -> const plan::RobotRecord& {
    return plan.robots()[plan.scenes()[plan.tasks()[task].scene].robot];
  };
  const plan::RobotRecord& record = robot_in(jobs.front().task);
  PROBE_ASSIGN(const robot::Robot robot, stage::robot_of(plan, record, *assets.robot(record.urdf)));
  servers::KnownArm arm{robot.control.arm_joints.size(), robot.control.finger_joints.size(), {}};
  for (const EpisodeJob& job : jobs) {
    // Records count from 1.
    const std::uint32_t control = robot_in(job.task).control;
    if (control == static_cast<std::uint32_t>(plan::Control::kEeDeltaPose)) continue;
    arm.control = static_cast<robot::ControlKind>(control - 1);
    if (!robot::control_kinds()[control - 1].per_joint) break;
  }
  return arm;
}

// The rule that the run in the folder was begun with, which is to be dropped; none: it has none.
Result<std::optional<adaptive::Rule>> rule_to_drop(const RunOptions& options) {
  PROBE_ASSIGN(const auto stored, store::find_run_record(options.out));
  if (!stored || stored->identity.until.empty()) return std::optional<adaptive::Rule>();
  PROBE_ASSIGN(adaptive::Rule rule,
               adaptive::rule_from_text(stored->identity.until, options.out));
  return std::optional(std::move(rule));
}

// What a run that stops by itself knows now; whoever follows it is told when no more will come.
Status sum_up(const std::string& out, RunSummary& summary) {
  PROBE_ASSIGN(const auto run, adaptive::read_adaptive(out));
  if (!run) return {};
  adaptive::Summarizer sums(*run);
  std::int64_t rows = 0;
  PROBE_TRY(store::for_each_row(out, [&](store::ResultRow&& row) -> Status {
    ++rows;
    sums.add(row);
    return {};
  }));
  summary.until = adaptive::to_lines(sums.summary());
  store::write_chosen(out, rows);
  return {};
}

// Every episode of the order has ended: which of them were run is not chosen any more.
Status drop_rule(store::Store& store, const std::string& out,
                 const std::vector<store::OrderedEpisode>& order, RunSummary& summary) {
  std::set<EpisodeKey> there;
  PROBE_TRY(store::for_each_row(out, [&](store::ResultRow&& row) -> Status {
    there.insert(store::key_of(row));
    return {};
  }));
  for (const store::OrderedEpisode& one : order)
    if (!there.contains(one.key)) return {};
  summary.notes.push_back("every episode has been run: the folder is like that of any other run");
  return store.forget_until();
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

Status set_until(const std::string& words, RunOptions& options) {
  options.drops_until = words == "none";
  options.until.reset();
  if (options.drops_until) return {};
  PROBE_ASSIGN(options.until, adaptive::parse_rule(words));
  return {};
}

Result<Actor> choose_actor(const RunOptions& options) {
  Actor actor;
  // Of a caller's policy the options call both so.
  PROBE_TRY(check_policy_name(options.name, options.own_policy ? "" : options.policy));
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

namespace {

// The first episodes of a caller that chooses while the results come in.
Result<Selection> first_choice(const plan::Plan& plan, const RunOptions& options) {
  Selection selection;
  if (!plan.suites().empty()) selection.suite = std::string(plan.text(plan.suites()[0].name));
  PROBE_ASSIGN(selection.jobs, options.next());
  return selection;
}

}  // namespace

Result<RunSummary> run(const plan::Plan& plan, const RunOptions& asked) {
  RunOptions options = asked;
  PROBE_ASSIGN(const Actor actor, choose_actor(options));
  const run::PolicyTraits& traits = actor.traits;
  std::vector<store::ResultRow> recorded;
  bool is_of_successes = false;  // as what is done again, which has no others
  if (traits.recorded) {
    const std::string dir = run::policy_argument(options.policy);
    PROBE_ASSIGN(recorded, recorded_rows(dir));
    PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
    is_of_successes = record.identity.only_success;
  }
  std::optional<adaptive::Rule> dropped;
  if (options.drops_until) {
    PROBE_ASSIGN(dropped, rule_to_drop(options));
  }
  RunOptions choosing = options;
  if (dropped) choosing.until = dropped;
  PROBE_ASSIGN(Selection selection,
               options.next ? first_choice(plan, options)
                            : select_jobs(plan, choosing, traits.draws,
                                          traits.recorded ? &recorded : nullptr));
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(options.assets));

  RunSummary summary;
  summary.notes = selection.notes;
  summary.total = static_cast<int>(selection.jobs.size());
  const bool is_empty = selection.jobs.empty();
  if (is_empty) {
    summary.notes.push_back("shard " + std::to_string(options.shard) + "/" +
                            std::to_string(options.shards) + " holds no episode: nothing to do");
  }
  PROBE_TRY(check_seeds(selection.jobs, actor));
  std::vector<store::OrderedEpisode> order;
  if (options.until) {
    PROBE_TRY(check_adaptive(*options.until, plan, options, traits.recorded, is_of_successes,
                             selection.jobs));
    PROBE_ASSIGN(order, put_in_order(*options.until, plan, options.out, selection.jobs));
  } else if (dropped) {
    PROBE_ASSIGN(const auto stored_order, store::read_order(options.out));
    order = put_in_order_again(*dropped, plan, stored_order, selection.jobs);
  }
  if (traits.wants_distractor) note_idle_tasks(plan, selection, options.policy, summary);
  // Assets are checked before the folder is touched: a plan that cannot run leaves nothing behind.
  // Which tasks will be chosen later nobody knows.
  PROBE_ASSIGN(auto assets,
               stage::SharedAssets::load(
                   plan, root, options.next ? all_tasks(plan) : tasks_of(selection.jobs)));
  const store::Fingerprint fingerprint = store::take_fingerprint(stage::asset_digest(plan));
  store::RunRecord record{
      {to_hex(plan.root()), options.name.empty() ? options.policy : options.name,
       content_of(options, traits), options.live ? to_text(*options.live) : "",
       options.only_success || is_of_successes,
       options.until  ? to_text(*options.until)
       : options.next ? std::string(store::kBySearch)
                      : ""},
      selection.suite,
      selection.seeds,
      fingerprint};
  for (const std::string& folder : options.assets.folders())
    record.asset_folders.push_back(absolute_path(folder));
  PROBE_ASSIGN(options.out, choose_folder(options, record, summary.notes));
  options.name = record.identity.policy;
  PROBE_ASSIGN(auto store, store::Store::open(options.out, record, plan.bytes()));
  summary.out = options.out;
  store::write_chosen(options.out, summary.total);
  // A shard of nothing is a part of the run like any other, for whoever merges all of them.
  if (is_empty) {
    if (dropped) PROBE_TRY(store->forget_until());
    return summary;
  }
  if (!order.empty() && !store->record().identity.until.empty())
    PROBE_TRY(store->freeze_order(order));
  const std::vector<EpisodeJob> chosen = selection.jobs;
  PROBE_ASSIGN(const auto stored_rows, store->episodes());
  const auto stored = drop_stored(plan, stored_rows, options.until.has_value(), selection.jobs, summary);
  std::set<EpisodeKey> known_before;  // of whoever chooses on
  for (const store::StoredEpisode& episode : stored_rows) {
    if (options.next && (episode.valid || store::is_not_attempted(episode.why)))
      known_before.insert(episode.key);
  }
  std::optional<AdaptiveJobs> adaptive_jobs;
  if (options.until) {
    selection.jobs = chosen;
    adaptive_jobs.emplace(*options.until, plan, chosen, order, stored_rows);
  }
  summary.skipped = static_cast<int>(stored.size());
  // What the caller says more of the policy vouches for it.
  if (traits.content == store::kCallersPolicy)
    PROBE_TRY(check_callers_policy(plan, options, actor, summary.notes));
  PROBE_TRY(note_missing_videos(options, stored, summary));
  if (options.progress)
    options.progress({0, summary.skipped, summary.total, nullptr, options.until.has_value()});
  PROBE_ASSIGN(const auto unproven, store->unproven());
  const bool is_there_all = adaptive_jobs ? adaptive_jobs->is_done() : selection.jobs.empty();
  const auto ended_well = [&]() -> Status {
    if (dropped) PROBE_TRY(drop_rule(*store, options.out, order, summary));
    // Rates of what a caller chose are told by no rule of ours.
    return options.next ? Status() : sum_up(options.out, summary);
  };
  if (is_there_all && (unproven.empty() || !actor.server)) {
    PROBE_TRY(ended_well());
    return summary;
  }

  summary.call.fingerprint = fingerprint;
  // Who chooses on may choose more than there are at first.
  summary.call.worlds =
      options.next ? options.jobs
                   : static_cast<int>(std::min((is_there_all ? chosen : selection.jobs).size(),
                                               static_cast<std::size_t>(options.jobs)));
  std::optional<ServerProof> proof;
  if (actor.server) {
    PROBE_ASSIGN(const servers::KnownArm arm,
                 arm_of(plan, options.next ? one_of_each(plan) : chosen, *assets));
    proof.emplace(*actor.server, summary.call.worlds, arm);
    PROBE_ASSIGN(summary.call.reading, proof->ask());
    PROBE_TRY(proof->check_as_before(*summary.call.reading, options, *store, summary.notes));
    for (std::string& finding : policy::findings_of(*summary.call.reading))
      summary.notes.push_back(std::move(finding));
    if (is_there_all) {
      summary.call.ended = true;
      PROBE_TRY(store->write_call(summary.call));
      PROBE_TRY(ended_well());
      return summary;
    }
    PROBE_TRY(proof->watch(*store));
  }
  PROBE_TRY(store->write_call(summary.call));
  note_batch(options, actor, summary);
  policy::QueryMeter queries;
  WorkersShared shared{.plan = plan,
                       .options = options,
                       .actor = actor,
                       .assets = std::move(assets),
                       .fingerprint = store::to_json(fingerprint),
                       .jobs = std::move(selection.jobs),
                       .store = *store,
                       .summary = summary,
                       .queries = queries,
                       .model = proof ? proof->model() : nullptr,
                       .line = std::make_shared<servers::SharedLine>(),
                       .identity = proof ? proof->identity() : nullptr,
                       .measured = summary.call.reading ? summary.call.reading->measured
                                                        : decltype(WorkersShared::measured)()};
  const auto make_worker = [&shared]() -> Result<Worker> {
    auto worker = std::make_shared<EpisodeWorker>(shared);
    PROBE_TRY(worker->begin());
    return Worker([worker](std::size_t index) { return worker->run(index); });
  };
  if (adaptive_jobs) {
    shared.ended = [&](const EpisodeKey& key, adaptive::Outcome outcome) {
      adaptive_jobs->tell(key, outcome);
    };
  }
  Status ran = adaptive_jobs
                   ? run_jobs(*adaptive_jobs, shared.jobs.size(), options.jobs, make_worker)
                   : run_jobs(shared.jobs.size(), options.jobs, make_worker);
  while (ran && options.next) {
    auto more = options.next();
    if (!more) ran = more.failure();
    if (!more || more->empty()) break;
    if (ran = check_seeds(*more, actor); !ran) break;
    std::erase_if(*more,
                  [&](const EpisodeJob& job) { return known_before.contains(key_of(plan, job)); });
    shared.jobs = std::move(*more);
    summary.total += static_cast<int>(shared.jobs.size());
    ran = run_jobs(shared.jobs.size(), options.jobs, make_worker);
  }
  // Where episodes under way were left, by a stop or a failure, what came next depended on more than
  // what is stored.
  const bool left_some = options.until && !ran;
  summary.call.ended = !left_some;
  summary.call.episodes = summary.done;
  summary.call.queries = queries.figures();
  // A world on the clock does not stand while it is asked for.
  if (options.live && !options.live->delay_s) summary.call.queries.waiting_s = 0;
  summary.call.elapsed_s = summary.call.queries.elapsed_s;
  Status unchanged;
  if (proof && (ran || policy::is_exchanged(proof->identity()->found())))
    unchanged = proof->check_to_the_end(*summary.call.reading, *store, summary.notes);
  const Status written = store->write_call(summary.call);
  PROBE_TRY(unchanged);
  PROBE_TRY(ran);
  PROBE_TRY(written);
  PROBE_TRY(note_delivery(plan, options.out, summary));
  PROBE_TRY(ended_well());
  return summary;
}

}  // namespace probe::run
