#include "runtime/run/adaptive_jobs.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "runtime/store/not_attempted.h"
#include "runtime/store/proof.h"
#include "runtime/store/until_words.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;
using store::EpisodeKey;

Failure usage(std::string message, std::string where = "--until") {
  return {Fault::kUsage, std::move(message), std::move(where)};
}

bool has_success(const plan::Plan& plan, std::uint32_t task) {
  return plan.find_metric(plan.tasks()[task], "success").has_value();
}

void sort_jobs(const adaptive::Rule& rule, const plan::Plan& plan, std::vector<EpisodeJob>& jobs) {
  std::vector<std::pair<Sha256, EpisodeJob>> ranked;
  for (const EpisodeJob& job : jobs) {
    const plan::TaskRecord& task = plan.tasks()[job.task];
    const Sha256 id{plan.episodes(task)[job.index].episode_id};
    ranked.emplace_back(adaptive::rank_of(rule.kind, plan.text(task.name), id, job.seed), job);
  }
  std::ranges::sort(ranked, {}, [](const auto& one) {
    return std::tuple(one.first, one.second.task, one.second.index, one.second.seed);
  });
  for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i] = ranked[i].second;
}

std::vector<store::OrderedEpisode> order_of(const plan::Plan& plan,
                                            std::span<const EpisodeJob> jobs) {
  std::vector<store::OrderedEpisode> order;
  for (const EpisodeJob& job : jobs) order.push_back({key_of(plan, job), {}});
  return order;
}

bool is_same_folder(const std::string& a, const std::string& b) {
  std::error_code error;
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error) && !error;
}

// Successes of the other run, by episode.
Result<std::map<EpisodeKey, bool>> read_other(adaptive::Rule& rule, const plan::Plan& plan,
                                              const std::string& out) {
  const std::string& dir = rule.dir;
  if (is_same_folder(dir, out)) return usage("cannot be decided against the run itself", dir);
  const auto record = store::read_run_record(dir);
  if (!record)
    return usage("`decided-against DIR` takes the folder of a run, but " + to_text(record.failure()));
  if (record->identity.plan_root != to_hex(plan.root()))
    return usage("is a run of another plan: nothing is decided against it", dir);
  if (record->identity.only_success) return usage(std::string(store::kSuccessesAlone), dir);
  if (!record->identity.until.empty())
    return usage(store::what_chose(record->identity.until) +
                     ": which episodes it has depends on how they ended; " +
                     store::way_out(record->identity.until),
                 dir);
  PROBE_ASSIGN(const store::ProvenResults proven, store::read_proven_results(dir));
  std::map<EpisodeKey, bool> successes;
  for (const store::ResultRow& row : proven.rows) {
    const auto success = std::ranges::find(row.metrics, "success", &store::MetricValue::name);
    if (!row.invalid && success != row.metrics.end())
      successes.emplace(store::key_of(row), success->value != 0);
  }
  rule.against = record->identity.policy;
  if (!record->identity.live.empty()) rule.against += " (" + record->identity.live + ")";
  return successes;
}

}  // namespace

Status check_adaptive(const adaptive::Rule& rule, const plan::Plan& plan, const RunOptions& options,
                      bool is_recorded, bool is_of_successes, std::span<const EpisodeJob> jobs) {
  if (options.only_success || is_of_successes)
    return usage("stops by the rate of success, and of successes alone there is none");
  if (is_recorded)
    return usage("`replay:DIR` repeats what came to an end in DIR, which is no sample of anything: "
                 "it is run whole");
  if (options.shards > 1 && rule.kind != adaptive::Rule::Kind::kEachTask) {
    return usage("of all tasks, and decisions, need one order of all episodes, of which a shard would "
                 "have no beginning: run them in one call with --jobs, or stop each task by itself",
                 "--shard");
  }
  for (const EpisodeJob& job : jobs) {
    if (has_success(plan, job.task)) continue;
    return usage("task `" + std::string(plan.text(plan.tasks()[job.task].name)) +
                 "` has no metric `success`, by whose rate a run stops: leave it out with --tasks");
  }
  return {};
}

Result<std::vector<store::OrderedEpisode>> put_in_order(adaptive::Rule& rule, const plan::Plan& plan,
                                                        const std::string& out,
                                                        std::vector<EpisodeJob>& jobs) {
  sort_jobs(rule, plan, jobs);
  std::vector<store::OrderedEpisode> order = order_of(plan, jobs);
  if (rule.kind != adaptive::Rule::Kind::kDecided || jobs.empty()) return order;
  PROBE_ASSIGN(const auto successes, read_other(rule, plan, out));
  std::size_t missing = 0;
  EpisodeKey first;
  Hasher hasher;
  for (store::OrderedEpisode& one : order) {
    const auto found = successes.find(one.key);
    if (found == successes.end()) {
      if (missing++ == 0) first = one.key;
      continue;
    }
    one.other = found->second;
    hasher.text(one.key.task)
        .u64(static_cast<std::uint64_t>(one.key.episode))
        .u64(static_cast<std::uint64_t>(one.key.seed))
        .u8(*one.other ? 1 : 0);
  }
  if (missing > 0) {
    return usage("has no valid episode for " + std::to_string(missing) + " of the " +
                     std::to_string(order.size()) + " that are chosen, first " + to_text(first) +
                     ": run them there, or choose what it has with --tasks, --episodes and --seeds",
                 rule.dir);
  }
  rule.outcomes = to_hex(hasher.finish()).substr(0, 16);
  return order;
}

std::vector<store::OrderedEpisode> put_in_order_again(
    const adaptive::Rule& rule, const plan::Plan& plan, std::span<const store::OrderedEpisode> stored,
    std::vector<EpisodeJob>& jobs) {
  sort_jobs(rule, plan, jobs);
  std::vector<store::OrderedEpisode> order = order_of(plan, jobs);
  for (std::size_t i = 0; i < std::min(order.size(), stored.size()); ++i)
    if (order[i].key == stored[i].key) order[i].other = stored[i].other;
  return order;
}

namespace {

std::vector<adaptive::Planned> planned_of(std::span<const EpisodeJob> jobs,
                                          std::span<const store::OrderedEpisode> order,
                                          std::span<const store::StoredEpisode> stored) {
  std::map<EpisodeKey, adaptive::Outcome> ended;
  for (const store::StoredEpisode& one : stored) {
    if (one.valid) {
      ended[one.key] = one.success ? adaptive::Outcome::kSuccess : adaptive::Outcome::kFailure;
    } else if (store::is_not_attempted(one.why)) {
      ended[one.key] = adaptive::Outcome::kNotAttempted;
    }
  }
  std::vector<adaptive::Planned> planned;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const auto found = ended.find(order[i].key);
    planned.push_back({jobs[i].task, jobs[i].index,
                       found == ended.end() ? adaptive::Outcome::kAbsent : found->second,
                       order[i].other.value_or(false)});
  }
  return planned;
}

}  // namespace

AdaptiveJobs::AdaptiveJobs(const adaptive::Rule& rule, const plan::Plan& plan,
                           std::span<const EpisodeJob> jobs,
                           std::span<const store::OrderedEpisode> order,
                           std::span<const store::StoredEpisode> stored)
    : chooser_(rule, planned_of(jobs, order, stored)) {
  for (std::size_t i = 0; i < jobs.size(); ++i) places_.emplace(key_of(plan, jobs[i]), i);
}

bool AdaptiveJobs::is_done() {
  const std::lock_guard lock(mutex_);
  return !chooser_.wants_more();
}

std::optional<std::size_t> AdaptiveJobs::next() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (is_stopped_) return std::nullopt;
    if (const auto place = chooser_.next()) return place;
    // What is under way may leave a task less sure than it seems.
    if (chooser_.under_way() == 0) return std::nullopt;
    told_.wait(lock);
  }
}

void AdaptiveJobs::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  told_.notify_all();
}

void AdaptiveJobs::tell(const EpisodeKey& key, adaptive::Outcome outcome) {
  const std::lock_guard lock(mutex_);
  if (const auto place = places_.find(key); place != places_.end())
    chooser_.tell(place->second, outcome);
  told_.notify_all();
}

}  // namespace probe::run
