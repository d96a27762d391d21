#include "runtime/search/trials.h"

#include <algorithm>
#include <utility>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"
#include "runtime/run/policies.h"
#include "runtime/store/store.h"

namespace probe::search {
namespace {

const std::vector<std::uint32_t>& no_starts() {
  static const std::vector<std::uint32_t> none;
  return none;
}

std::uint64_t hash_of(std::uint64_t seed, const std::string& kind, const std::string& task,
                      std::uint64_t number, std::uint64_t attempt) {
  return little_endian_number(Hasher()
                                  .text("search trial")
                                  .u64(seed)
                                  .text(kind)
                                  .text(task)
                                  .u64(number)
                                  .u64(attempt)
                                  .finish());
}

}  // namespace

Trials::Trials(const BaseTask& base, const PlannedPoints& planned, run::RunOptions options,
               Solved* solved, std::uint64_t seed, std::string kind, int first_seed)
    : base_(base),
      planned_(planned),
      options_(std::move(options)),
      solved_(solved),
      seed_(seed),
      kind_(std::move(kind)),
      first_seed_(first_seed) {}

void Trials::keep(const store::ResultRow& row) {
  known_[store::key_of(row)] = success_of(row);
  if (store::is_open(row)) lost_[store::key_of(row)] = *row.invalid;
}

Status Trials::read_known() {
  PROBE_ASSIGN(const auto record, store::find_run_record(options_.out));
  if (!record) return {};
  if (record->identity.plan_root != to_hex(planned_.plan.root()))
    return Failure{
        Fault::kUsage,
        "its episodes are of another plan than the points make now: another build, other "
        "assets, another expert, or an earlier round's episode that was run again and ended "
        "otherwise; choose another folder",
        options_.out};
  PROBE_ASSIGN(const auto rows, store::read_results(options_.out));
  // What a server or the world spoiled is run again, unless what was asked next followed from its
  // being left out.
  for (const store::ResultRow& row : rows) {
    const bool was_told_so =
        is_over_ && row.invalid && !store::Store::is_later_reason(*row.invalid);
    if (was_told_so || !store::is_open(row)) keep(row);
  }
  return {};
}

// A row may be made invalid after it was told: an answer was to another question than it seemed.
Status Trials::check_told() const {
  PROBE_ASSIGN(const auto rows, store::read_results(options_.out));
  for (const store::ResultRow& row : rows) {
    if (!store::is_open(row)) continue;
    const auto told = known_.find(store::key_of(row));
    if (told == known_.end() || !told->second) continue;
    return Failure{Fault::kPolicy,
                   store::to_text(told->first) + " is invalid: " + *row.invalid +
                       ". What is asked next followed from it: the same command runs it again",
                   options_.out};
  }
  return {};
}

// Of each trial a start that is fair, drawn anew for every one: trials of a point are independent
// draws from its starts, whether or not some are the same.
Result<std::vector<std::optional<Trials::Place>>> Trials::places_of(std::span<const Trial> trials) {
  struct Open {
    std::vector<std::uint32_t> starts;  // that may still be drawn
    std::uint64_t attempt = 0;
  };
  std::vector<std::optional<Place>> places(trials.size());
  std::vector<Open> open(trials.size());
  std::vector<std::size_t> waiting;
  std::vector<std::uint32_t> base_starts(base_.task().starts.size());
  for (std::uint32_t i = 0; i < base_starts.size(); ++i) base_starts[i] = i;
  const auto point_of = [&](const Trial& trial) -> const PlannedPoint* {
    return trial.point == kBase ? nullptr : &planned_.points[trial.point];
  };
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const PlannedPoint* const point = point_of(trials[t]);
    open[t].starts = point == nullptr ? base_starts : point->task ? point->starts : no_starts();
    if (point != nullptr && point->proof != kBase) {
      // A camera that is moved may see a start that the task's own does not.
      const PlannedPoint& proof = planned_.points[point->proof];
      std::erase_if(open[t].starts, [&](std::uint32_t start) {
        return !proof.task || std::ranges::find(proof.starts, start) == proof.starts.end();
      });
    }
    // Whose trial it is is told by what it is of, before anything is run for it.
    const std::string& name = point == nullptr ? base_.task().name : point->point.name;
    const bool is_mine =
        shards_ == 1 || static_cast<int>(hash_of(seed_, "shard", name, trials[t].number, 0) %
                                         static_cast<std::uint64_t>(shards_)) == shard_ - 1;
    if (!open[t].starts.empty() && is_mine) waiting.push_back(t);
  }
  while (!waiting.empty()) {
    std::vector<Solved::Question> questions;
    std::vector<std::uint32_t> drawn;
    for (const std::size_t t : waiting) {
      const PlannedPoint* const point = point_of(trials[t]);
      const std::string& name = point == nullptr ? base_.task().name : point->point.name;
      auto& starts = open[t].starts;
      const std::uint64_t hash = hash_of(seed_, kind_, name, trials[t].number, open[t].attempt++);
      drawn.push_back(starts[hash % starts.size()]);
      questions.push_back({point == nullptr ? kBase : point->proof, drawn.back()});
    }
    if (solved_ != nullptr) PROBE_TRY(solved_->find_out(planned_, questions));
    std::vector<std::size_t> again;
    for (std::size_t w = 0; w < waiting.size(); ++w) {
      const std::size_t t = waiting[w];
      const PlannedPoint* const point = point_of(trials[t]);
      auto& starts = open[t].starts;
      if (solved_ != nullptr && !solved_->is_solved(planned_, questions[w]).value_or(false)) {
        std::erase(starts, drawn[w]);
        if (!starts.empty()) again.push_back(t);
        continue;
      }
      Place place;
      place.task = point == nullptr ? planned_.base_task : *point->task;
      place.index = drawn[w];
      if (point != nullptr)
        place.index = static_cast<std::size_t>(std::ranges::find(point->starts, drawn[w]) -
                                               point->starts.begin());
      places[t] = place;
    }
    waiting = std::move(again);
  }
  // A policy that draws does another episode each time; one that does not would repeat itself.
  for (std::size_t t = 0; t < trials.size(); ++t) {
    if (places[t] && draws_) places[t]->seed = first_seed_ + static_cast<int>(trials[t].number);
  }
  return places;
}

Outcome Trials::outcome_of(const Place& place) const {
  const run::EpisodeJob job{place.task, static_cast<std::uint32_t>(place.index), place.seed};
  const auto found = known_.find(run::key_of(planned_.plan, job));
  const std::optional<bool> success = found == known_.end() ? std::nullopt : found->second;
  if (!success) return Outcome::kLeftOut;
  return *success ? Outcome::kSucceeded : Outcome::kFailed;
}

// Tells what is known and asks on, until something has to be run.
Result<std::vector<run::EpisodeJob>> Trials::advance() {
  while (true) {
    if (!asked_.empty()) {
      std::vector<Outcome> outcomes;
      for (const std::optional<Place>& place : asked_) {
        outcomes.push_back(place ? outcome_of(*place) : Outcome::kLeftOut);
        if (shards_ > 1) continue;  // some are others'
        if (!place) ++unfair_;
        if (place && outcomes.back() == Outcome::kLeftOut) ++invalid_;
      }
      asked_.clear();
      asking_->tell(outcomes);
    }
    PROBE_ASSIGN(const std::vector<Trial> trials, asking_->ask());
    if (trials.empty()) return std::vector<run::EpisodeJob>{};
    PROBE_ASSIGN(asked_, places_of(trials));
    std::vector<run::EpisodeJob> jobs;
    std::set<store::EpisodeKey> wanted;
    for (const std::optional<Place>& place : asked_) {
      if (!place) continue;
      const run::EpisodeJob job{place->task, static_cast<std::uint32_t>(place->index), place->seed};
      const store::EpisodeKey key = run::key_of(planned_.plan, job);
      if (!known_.contains(key) && wanted.insert(key).second) jobs.push_back(job);
    }
    if (!jobs.empty()) return jobs;
  }
}

Status Trials::run(const Asking& asking) {
  asking_ = &asking;
  PROBE_ASSIGN(const run::PolicyChoice choice,
               run::choose_policy(options_.policy, options_.accepts_any_certificate));
  draws_ = choice.traits.draws;
  PROBE_TRY(read_known());
  // What is known needs no policy, and no server that is there.
  PROBE_ASSIGN(std::vector<run::EpisodeJob> jobs, advance());
  if (jobs.empty()) return {};
  run::RunOptions options = options_;
  options.assets = planned_.assets;
  const auto told = options.progress;
  options.progress = [&](const run::RunProgress& progress) {
    if (progress.row != nullptr) {
      keep(*progress.row);
      ++ran_;
    }
    if (told) told(progress);
  };
  bool is_first = true;
  options.next = [&]() -> Result<std::vector<run::EpisodeJob>> {
    if (std::exchange(is_first, false)) return jobs;
    return advance();
  };
  PROBE_ASSIGN(const run::RunSummary summary, run::run(planned_.plan, options));
  PROBE_TRY(check_told());
  notes_.insert(notes_.end(), summary.notes.begin(), summary.notes.end());
  return {};
}

std::string Trials::first_invalid() const {
  if (lost_.empty()) return "";
  const auto& [key, why] = *lost_.begin();
  return store::to_text(key) + ": " + why;
}

}  // namespace probe::search
