#include "runtime/adaptive/sampled.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "runtime/base/digit_groups.h"
#include "runtime/base/percent.h"
#include "runtime/base/printable.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/until_words.h"

namespace probe::adaptive {
namespace {

constexpr std::size_t kMostLines = 60, kWidest = 5;
constexpr std::size_t kLongestName = 200;

std::string groups(std::int64_t count) { return digit_groups(static_cast<std::size_t>(count)); }

std::string range(const SampledRate& rate) {
  return percent_range(rate.interval.low, rate.interval.high, " to ") + " %";
}

std::int64_t sum(const std::vector<stats::Drawn>& lists, std::int64_t stats::Drawn::*part) {
  std::int64_t all = 0;
  for (const stats::Drawn& list : lists) all += list.*part;
  return all;
}

stats::Drawn together(std::span<const stats::Drawn> lists) {
  stats::Drawn all;
  for (const stats::Drawn& list : lists) {
    all.total += list.total;
    all.successes += list.successes;
    all.failures += list.failures;
    all.unknown += list.unknown;
  }
  return all;
}

}  // namespace

std::int64_t SampledTask::total() const { return sum(lists, &stats::Drawn::total); }
std::int64_t SampledTask::successes() const { return sum(lists, &stats::Drawn::successes); }
std::int64_t SampledTask::failures() const { return sum(lists, &stats::Drawn::failures); }
std::int64_t SampledTask::unknown() const { return sum(lists, &stats::Drawn::unknown); }

Result<std::optional<AdaptiveRun>> read_adaptive(const std::string& dir) {
  PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
  if (record.identity.until.empty()) return std::optional<AdaptiveRun>();
  AdaptiveRun run;
  PROBE_ASSIGN(run.rule, rule_from_text(record.identity.until, dir));
  PROBE_ASSIGN(run.order, store::read_order(dir));
  PROBE_ASSIGN(const auto calls, store::read_run_calls(dir));
  const bool is_in_turn = std::ranges::all_of(
      calls, [](const store::RunCall& call) { return call.ended || call.worlds == 1; });
  if (is_in_turn) run.drawing = stats::Drawing::kInTurn;
  return std::optional(std::move(run));
}

std::vector<bool> counted_places(const AdaptiveRun& run, const std::vector<bool>& has_row) {
  std::vector<bool> counted(run.order.size());
  std::set<std::string> stopped;  // at the first gap
  const bool is_by_task = run.rule.kind == Rule::Kind::kEachTask;
  for (std::size_t place = 0; place < run.order.size(); ++place) {
    const std::string& task = is_by_task ? run.order[place].key.task : "";
    if (stopped.contains(task)) continue;
    counted[place] = has_row[place];
    if (!has_row[place]) stopped.insert(task);
  }
  return counted;
}

std::vector<int> seeds_of(std::span<const store::OrderedEpisode> order) {
  std::set<int> seeds;
  for (const store::OrderedEpisode& one : order) seeds.insert(one.key.seed);
  return {seeds.begin(), seeds.end()};
}

Sampled::Sampled(Rule::Kind kind, std::vector<int> seeds)
    : is_by_seed_(kind == Rule::Kind::kDecided), seeds_(std::move(seeds)) {}

std::size_t Sampled::list_of(int seed) const {
  if (!is_by_seed_) return 0;
  return static_cast<std::size_t>(std::ranges::lower_bound(seeds_, seed) - seeds_.begin());
}

void Sampled::add(SampledTask& task, int seed, Outcome outcome) const {
  const std::size_t list = list_of(seed);
  if (task.lists.size() <= list) task.lists.resize(list + 1);
  stats::Drawn& of = task.lists[list];
  ++of.total;
  if (outcome == Outcome::kSuccess) ++of.successes;
  if (outcome == Outcome::kFailure) ++of.failures;
  if (outcome == Outcome::kUnknown) ++of.unknown;
  if (outcome == Outcome::kNotAttempted) ++task.not_attempted;
}

std::optional<SampledRate> rate_of(const Rule& rule, stats::Drawing drawing,
                                   std::span<const SampledTask> tasks) {
  // What was not attempted is no part of the rate, which is known of what has been run whole alone.
  const auto attempted = [](const SampledTask& task) {
    stats::Drawn all = together(task.lists);
    all.total -= task.not_attempted;
    return all;
  };
  const auto is_clear = [](const SampledTask& task) {
    return task.not_attempted == 0 || task.is_whole();
  };
  std::vector<stats::Drawn> lists;  // that were drawn each by itself
  if (!std::ranges::all_of(tasks, is_clear)) return std::nullopt;
  if (rule.kind == Rule::Kind::kEachTask) {
    for (const SampledTask& task : tasks) {
      if (const stats::Drawn list = attempted(task); list.total > 0) lists.push_back(list);
    }
  } else if (std::ranges::all_of(tasks, &SampledTask::is_whole)) {
    stats::Drawn all;
    for (const SampledTask& task : tasks) all = together(std::vector{all, attempted(task)});
    if (all.total > 0) lists.push_back(all);
  } else {
    for (const SampledTask& task : tasks) {
      if (task.not_attempted > 0) return std::nullopt;
      lists.resize(std::max(lists.size(), task.lists.size()));
      for (std::size_t i = 0; i < task.lists.size(); ++i)
        lists[i] = together(std::vector{lists[i], task.lists[i]});
    }
  }
  if (lists.empty()) return std::nullopt;
  SampledRate out;
  const stats::Drawn all = together(lists);
  for (const stats::Drawn& list : lists) {
    const std::int64_t known = list.successes + list.failures;
    if (known == 0) return std::nullopt;
    out.rate += static_cast<double>(list.successes) / static_cast<double>(known) *
                static_cast<double>(list.total) / static_cast<double>(all.total);
  }
  // Seeds of one start were drawn together, so none is a list of its own turn.
  out.interval = lists.size() == 1 ? stats::rate_of_drawn(lists[0], kConfidence)
                                   : stats::rate_of_lists(lists,
                                                          rule.kind == Rule::Kind::kEachTask
                                                              ? drawing
                                                              : stats::Drawing::kAnyhow,
                                                          kConfidence);
  return out;
}

Outcome outcome_of(const store::ResultRow& row, std::string_view metric) {
  if (store::is_not_attempted(row)) return Outcome::kNotAttempted;
  if (row.invalid) return Outcome::kUnknown;
  const auto found = std::ranges::find(row.metrics, metric, &store::MetricValue::name);
  if (found == row.metrics.end()) return Outcome::kUnknown;
  return found->value != 0 ? Outcome::kSuccess : Outcome::kFailure;
}

Summarizer::Summarizer(const AdaptiveRun& run) : run_(run), outcomes_(run.order.size()) {
  for (std::size_t place = 0; place < run.order.size(); ++place)
    places_.emplace_back(run.order[place].key, place);
  std::ranges::sort(places_);
}

void Summarizer::add(const store::ResultRow& row) {
  const std::pair<store::EpisodeKey, std::size_t> key{store::key_of(row), 0};
  const auto found = std::ranges::lower_bound(places_, key);
  if (found == places_.end() || found->first != key.first) return;
  outcomes_[found->second] = outcome_of(row);
}

Summary Summarizer::summary() const {
  Summary out;
  out.rule = to_text(run_.rule);
  out.against = run_.rule.against;
  out.planned = static_cast<std::int64_t>(run_.order.size());
  std::vector<bool> has_row;
  for (const Outcome outcome : outcomes_) has_row.push_back(has_ended(outcome));
  const std::vector<bool> counted = counted_places(run_, has_row);
  const Sampled sampled(run_.rule.kind, seeds_of(run_.order));
  std::map<std::string, std::size_t> known;
  for (std::size_t place = 0; place < counted.size(); ++place) {
    const store::EpisodeKey& key = run_.order[place].key;
    const auto [at, is_new] = known.try_emplace(key.task, out.tasks.size());
    if (is_new) out.tasks.push_back({key.task, {}, {}});
    sampled.add(out.tasks[at->second].sampled, key.seed,
                counted[place] ? outcomes_[place] : Outcome::kAbsent);
    out.counted += counted[place] ? 1 : 0;
    out.beyond += has_row[place] && !counted[place] ? 1 : 0;
  }
  std::vector<SampledTask> all;
  for (TaskSummary& task : out.tasks) {
    task.rate = rate_of(run_.rule, run_.drawing, std::span(&task.sampled, 1));
    all.push_back(task.sampled);
  }
  out.all = rate_of(run_.rule, run_.drawing, all);
  if (run_.rule.kind != Rule::Kind::kDecided) return out;
  out.decision.emplace();
  std::vector<std::pair<Outcome, bool>> start;
  for (std::size_t place = 0; place < counted.size() && counted[place];) {
    const store::EpisodeKey& first = run_.order[place].key;
    start.clear();
    for (; place < counted.size() && run_.order[place].key.task == first.task &&
           run_.order[place].key.episode == first.episode;
         ++place) {
      if (!counted[place]) return out;
      start.emplace_back(outcomes_[place], run_.order[place].other.value_or(false));
    }
    out.decision->add(start);
  }
  return out;
}

namespace {

std::string task_line(const TaskSummary& task) {
  const SampledTask& of = task.sampled;
  const std::int64_t known = of.successes() + of.failures();
  std::string line = fmt::format("  {}: {} of {} episodes, {} of {} succeed",
                                 printable(task.name, kLongestName),
                                 known + of.unknown() + of.not_attempted, of.total(),
                                 of.successes(), known);
  if (task.rate) line += ", " + range(*task.rate);
  if (of.unknown() > 0) line += fmt::format(" ({} invalid may have been either)", of.unknown());
  if (of.not_attempted > 0) line += fmt::format(" ({} not attempted)", of.not_attempted);
  return line;
}

double width(const TaskSummary& task) {
  return task.rate ? task.rate->interval.high - task.rate->interval.low : 1;
}

std::string decision_line(const Decision& decision, const std::string& against) {
  const std::string than = "`" + printable(against, kLongestName) + "`";
  const std::string counts =
      fmt::format("{} starts: it succeeds more often on {}, less often on {}; anytime-valid p = {:.2g}",
                  groups(decision.starts()), decision.won(), decision.lost(), decision.ever().p);
  switch (decision.verdict()) {
    case Decision::Verdict::kBetter:
      return "better than " + than + " on these starts (" + counts + ")";
    case Decision::Verdict::kWorse:
      return "worse than " + than + " on these starts (" + counts + ")";
    case Decision::Verdict::kOpen:
      break;
  }
  return "not decided against " + than + " (" + counts + ")";
}

}  // namespace

std::vector<std::string> to_lines(const Summary& summary, bool is_long) {
  std::vector<std::string> lines = {fmt::format(
      "until {}: {} of {} episodes count; 95 % intervals are of the rate that all {} would "
      "have, and hold whenever the run stopped",
      printable(in_words(summary.rule), kLongestName), groups(summary.counted), groups(summary.planned),
      groups(summary.planned))};
  if (summary.beyond > 0)
    lines.push_back(fmt::format("{} rows do not count yet: episodes before them in the order are "
                                "missing; the same command runs them",
                                groups(summary.beyond)));
  std::vector<const TaskSummary*> tasks;
  for (const TaskSummary& task : summary.tasks) tasks.push_back(&task);
  std::ranges::stable_sort(tasks, {}, &TaskSummary::name);
  if (!is_long && tasks.size() > kMostLines) {
    std::ranges::stable_sort(tasks, std::greater(), [](const TaskSummary* t) { return width(*t); });
    tasks.resize(kWidest);
    lines.push_back(fmt::format("  of {} tasks those with the widest intervals:", summary.tasks.size()));
  }
  for (const TaskSummary* task : tasks) lines.push_back(task_line(*task));
  if (summary.all && summary.tasks.size() > 1)
    lines.push_back(fmt::format("  all tasks, each weighted by its episodes: {} %, {}",
                                decimal_text(100 * summary.all->rate, 1), range(*summary.all)));
  if (summary.decision) lines.push_back(decision_line(*summary.decision, summary.against));
  return lines;
}

std::string why_not_fixed(const std::string& until) {
  const std::string why =
      store::is_by_search(until)
          ? std::string("a search chose its episodes by what it found")
          : "how many episodes were run depended on how they ended (--until: " +
                printable(in_words(until), kLongestName) + ")";
  return why + ", which tests and intervals of a fixed number do not allow for";
}

}  // namespace probe::adaptive
