#include "runtime/run/episode_worker.h"

#include <algorithm>
#include <filesystem>

#include "runtime/adaptive/sampled.h"
#include "runtime/base/paths.h"
#include "runtime/run/recorded.h"
#include "runtime/servers/identity.h"
#include "runtime/show/episode_video.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/video_place.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;

void add_once(std::vector<std::string>& notes, std::string note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
}

}  // namespace

bool has_failed(const store::ResultRow& row) {
  if (row.invalid) return store::is_open(row);
  for (const store::MetricValue& metric : row.metrics) {
    if (metric.name == "success") return metric.value == 0;
  }
  return false;
}

Status EpisodeWorker::begin() {
  run::PolicyContext context = policy_context();
  context.queries = &shared_.queries;
  context.model = shared_.model;
  context.line = shared_.line;
  context.identity = shared_.identity;
  context.measured = shared_.measured;
  PROBE_ASSIGN(policy_, shared_.actor.make(context));
  if (shared_.options.live) policy_ = policy::make_live(std::move(policy_), *shared_.options.live);
  return {};
}

Status EpisodeWorker::run(std::size_t index) {
  const EpisodeJob& job = shared_.jobs[index];
  const Failure stopped{Fault::kUsage, "stopped; the same call continues", shared_.options.out};
  if (is_stopped()) return stopped;
  if (!stage_ || stage_->task() != job.task) {
    stage_.reset();  // frees the old before the new is made
    PROBE_ASSIGN(stage_, stage::Stage::create(shared_.plan, job.task, shared_.assets));
  }
  const store::TraceHeader header = make_trace_header(
      shared_.plan, job, *stage_, shared_.options.name, shared_.fingerprint, shared_.options.live);
  PROBE_ASSIGN(const std::string path, shared_.store.temporary_trace(store::key_of(header)));
  for (int attempt = 0;; ++attempt) {
    auto played = write(job, header, path);
    if (policy_->is_earlier_spoiled() && attempt == 0) PROBE_TRY(spoil_last());
    // What was under way when the end was asked for is nobody's failure.
    if (!played || is_stopped()) {
      std::error_code ignored;
      fs::remove(path, ignored);
      return played ? stopped : played.failure();
    }
    if (!is_spoiled(*played) || attempt >= shared_.options.retries || shared_.given_up ||
        is_exchanged()) {
      if (shared_.options.only_success && !played->row.invalid && has_failed(played->row))
        return drop(*played, path);
      return commit(*played, static_cast<int>(job.task));
    }
    const std::lock_guard lock(shared_.mutex);
    ++shared_.summary.call.retried;
    shared_.summary.call.observations += played->row.steps;
  }
}

Result<Played> EpisodeWorker::write(const EpisodeJob& job, const store::TraceHeader& header,
                                    const std::string& path) {
  PROBE_ASSIGN(auto trace, store::TraceWriter::create(path, header));
  std::optional<show::EpisodeVideo> video;
  if (shared_.options.video != VideoChoice::kNone) {
    PROBE_ASSIGN(std::string file,
                 store::place_for_video(shared_.options.out, store::key_of(header)));
    video.emplace(header, std::move(file));
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
bool EpisodeWorker::is_spoiled(const Played& played) const {
  return !shared_.actor.traits.content.empty() && played.policy_fault &&
         *played.policy_fault != Fault::kUsage;
}

// The episode that this world stored last, whose answers were not to its questions.
Status EpisodeWorker::spoil_last() {
  if (!last_valid_) return {};
  PROBE_TRY(
      shared_.store.invalidate({*last_valid_}, "policy: " + std::string(store::Store::kOutOfStep)));
  if (shared_.ended) shared_.ended(*last_valid_, adaptive::Outcome::kUnknown);
  const std::lock_guard lock(shared_.mutex);
  ++shared_.summary.invalid;
  add_once(shared_.summary.notes, to_text(*last_valid_) +
                                      " is invalid: " + std::string(store::Store::kOutOfStep) +
                                      "; the same command does it again");
  last_valid_.reset();
  return {};
}

bool EpisodeWorker::is_exchanged() const {
  return shared_.identity && policy::is_exchanged(shared_.identity->found());
}

Status EpisodeWorker::commit(const Played& played, int task_order) {
  const store::ResultRow& row = played.row;
  // Not under the lock: other worlds must not wait for the disk.
  PROBE_TRY(shared_.store.commit(row, task_order));
  if (shared_.ended) shared_.ended(store::key_of(row), adaptive::outcome_of(row));
  last_valid_.reset();
  if (!row.invalid) last_valid_ = store::key_of(row);
  const std::lock_guard lock(shared_.mutex);
  ++shared_.summary.done;
  shared_.summary.call.observations += row.steps;
  for (std::string& note : policy_->notes()) add_once(shared_.summary.notes, std::move(note));
  shared_.summary.not_attempted.add(row);
  if (store::is_open(row)) ++shared_.summary.invalid;
  if (shared_.options.progress) {
    shared_.options.progress({shared_.summary.done, shared_.summary.skipped, shared_.summary.total,
                              &row, shared_.options.until.has_value()});
  }
  if (is_exchanged()) {
    shared_.given_up = true;
    return Failure{Fault::kPolicy, "another policy answers", shared_.options.name};  // see run()
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

Status EpisodeWorker::drop(const Played& played, const std::string& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) return Failure{Fault::kIo, "cannot be removed: " + error.message(), path};
  last_valid_.reset();
  const std::lock_guard lock(shared_.mutex);
  ++shared_.summary.done;
  ++shared_.summary.not_kept;
  shared_.summary.call.observations += played.row.steps;
  if (shared_.options.progress) {
    shared_.options.progress(
        {shared_.summary.done, shared_.summary.skipped, shared_.summary.total, &played.row});
  }
  return {};
}

Failure EpisodeWorker::give_up(const std::string& last) const {
  const RunSummary& summary = shared_.summary;
  const int stored =
      summary.skipped + summary.done - summary.invalid - summary.not_attempted.count();
  return {Fault::kPolicy,
          "the policy failed in " + std::to_string(shared_.lost_in_a_row) +
              " episodes in a row, the last time so: " + last + "\n  " + std::to_string(stored) +
              " of " + std::to_string(summary.total) + " episodes are stored in " + summary.out +
              "; when the server answers again, the same command continues",
          shared_.options.name};
}

}  // namespace probe::run
