#include "runtime/search/solved.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "runtime/base/paths.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/store.h"

namespace probe::search {
namespace {

namespace fs = std::filesystem;

const std::string kExpertFolder = "expert-";
// One seed: the expert draws nothing.
constexpr int kExpertSeed = 0;

}  // namespace

std::optional<bool> success_of(const store::ResultRow& row) {
  if (row.invalid) return std::nullopt;
  for (const store::MetricValue& metric : row.metrics) {
    if (metric.name == "success") return metric.value != 0;
  }
  return std::nullopt;
}

Solved::Key Solved::key_of(const PlannedPoints& planned, const Question& question) const {
  if (question.point == kBase) return {space::own_values(base_.space()), 0, question.start};
  const space::Point& point = planned.points[question.point].point;
  return {point.values, point.draw, question.start};
}

std::optional<bool> Solved::is_solved(const PlannedPoints& planned,
                                      const Question& question) const {
  const auto found = known_.find(key_of(planned, question));
  if (found == known_.end() || found->second == Answer::kNoSkill) return std::nullopt;
  return found->second == Answer::kYes;
}

int Solved::unsolved() const {
  return static_cast<int>(
      std::ranges::count_if(known_, [](const auto& one) { return one.second == Answer::kNo; }));
}

int Solved::not_attempted() const {
  return static_cast<int>(std::ranges::count_if(
      known_, [](const auto& one) { return one.second == Answer::kNoSkill; }));
}

// Rows of the expert in the round's plan: what they say of the points there.
void Solved::keep(const PlannedPoints& planned, const store::ResultRow& row) {
  const auto task = planned.plan.find_task(row.task);
  if (!task) return;
  Question question;
  question.start = static_cast<std::uint32_t>(row.episode);
  if (*task != planned.base_task) {
    const auto point = std::ranges::find(planned.points, task, &PlannedPoint::task);
    if (point == planned.points.end() ||
        static_cast<std::size_t>(row.episode) >= point->starts.size())
      return;
    question.point = static_cast<std::size_t>(point - planned.points.begin());
    question.start = point->starts[static_cast<std::size_t>(row.episode)];
  }
  const std::optional<bool> success = success_of(row);
  const bool no_skill = store::is_not_attempted(row);
  // A world that does not settle as the text says is no fair start either.
  known_[key_of(planned, question)] = success.value_or(false) ? Answer::kYes
                                      : no_skill              ? Answer::kNoSkill
                                                              : Answer::kNo;
}

Status Solved::begin(const PlannedPoints& planned, const std::string& folder) {
  folder_ = folder;
  folders_ = 0;
  PROBE_ASSIGN(const auto names, list_folder(folder));
  for (const std::string& name : names) {
    if (!name.starts_with(kExpertFolder)) continue;
    const std::string dir = (fs::path(folder) / name).string();
    PROBE_ASSIGN(const auto record, store::find_run_record(dir));
    if (!record || record->identity.plan_root != to_hex(planned.plan.root())) continue;
    PROBE_ASSIGN(const auto rows, store::read_results(dir));
    for (const store::ResultRow& row : rows) keep(planned, row);
  }
  return {};
}

Status Solved::find_out(const PlannedPoints& planned, std::span<const Question> questions) {
  std::vector<run::EpisodeJob> jobs;
  std::set<Key> asked;
  for (const Question& question : questions) {
    const Key key = key_of(planned, question);
    if (known_.contains(key) || !asked.insert(key).second) continue;
    const bool is_base = question.point == kBase;
    const std::uint32_t task = is_base ? planned.base_task : *planned.points[question.point].task;
    std::size_t index = question.start;
    if (!is_base) {
      const auto& starts = planned.points[question.point].starts;
      index = static_cast<std::size_t>(std::ranges::find(starts, question.start) - starts.begin());
    }
    jobs.push_back({task, static_cast<std::uint32_t>(index), kExpertSeed});
  }
  if (jobs.empty()) return {};
  run::RunOptions options = options_;
  options.policy = "expert";
  do {
    options.out = (fs::path(folder_) / (kExpertFolder + std::to_string(++folders_))).string();
  } while (is_there(options.out));
  options.progress = [&](const run::RunProgress& progress) {
    if (progress.row != nullptr) keep(planned, *progress.row);
  };
  bool is_first = true;
  options.next = [&]() -> Result<std::vector<run::EpisodeJob>> {
    return std::exchange(is_first, false) ? jobs : std::vector<run::EpisodeJob>{};
  };
  options.assets = planned.assets;
  PROBE_ASSIGN([[maybe_unused]] const run::RunSummary summary, run::run(planned.plan, options));
  return {};
}

}  // namespace probe::search
