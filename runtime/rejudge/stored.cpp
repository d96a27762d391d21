#include "runtime/rejudge/stored.h"

#include <algorithm>
#include <map>
#include <optional>

#include "runtime/base/glob.h"

namespace probe::rejudge {
namespace {

Result<std::vector<std::uint32_t>> candidates_of(const plan::Plan& plan, const std::string& suite) {
  std::vector<std::uint32_t> tasks;
  if (suite.empty()) {
    for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) tasks.push_back(t);
    return tasks;
  }
  const auto index = plan.find_suite(suite);
  if (!index) return Failure{Fault::kUsage, "the judging plan has no such suite", suite};
  const auto members = plan.members(plan.suites()[*index]);
  tasks.assign(members.begin(), members.end());
  return tasks;
}

}  // namespace

Result<std::vector<Job>> match_rows(const plan::Plan& plan, const plan::Plan& recorded,
                                    std::span<const store::ResultRow> rows,
                                    const std::string& suite, const std::string& tasks,
                                    std::vector<std::string>& left_out) {
  PROBE_ASSIGN(const auto candidates, candidates_of(plan, suite));
  std::map<std::string, std::optional<std::uint32_t>> judges;
  std::vector<Job> jobs;
  for (const store::ResultRow& row : rows) {
    if (!matches_glob(tasks, row.task)) continue;
    const auto [known, is_new] = judges.try_emplace(row.task);
    if (is_new) {
      PROBE_ASSIGN(known->second, find_judge(plan, candidates, row.task));
      if (!known->second) left_out.push_back(row.task);
    }
    if (!known->second) continue;
    PROBE_ASSIGN(const Match match, match_start(plan, *known->second, row, recorded));
    jobs.push_back({&row, match});
  }
  return jobs;
}

Failure nothing_judged(const std::string& suite, const std::string& tasks,
                       std::span<const std::string> left_out) {
  if (left_out.empty()) return {Fault::kUsage, "no stored episode matches `" + tasks + "`", ""};
  return {
      Fault::kUsage,
      "the judging plan has none of the stored tasks, such as `" + left_out.front() +
          "`; a text that declares no task and no suite has its metrics put behind the run's own",
      suite};
}

store::ResultRow judged_row(const plan::Plan& plan, const Job& job, const Rescored& score,
                            const store::Trace& trace) {
  const plan::TaskRecord& task = plan.tasks()[job.match.task];
  store::ResultRow row = *job.row;
  row.task = std::string(plan.text(task.name));
  row.metrics = score.metrics;
  if (!row.invalid) row.invalid = score.invalid;  // what spoiled it is in no trace
  row.steps = static_cast<int>(score.steps.size());
  Hasher frames;  // of the steps that were judged
  for (std::size_t i = 0; i < score.steps.size(); ++i) frames.hash(trace.steps[i].image_hash);
  row.frames_sha256 = row.steps > 0 ? to_hex(frames.finish()) : "";
  row.episode_id = to_hex(Sha256{plan.episodes(task)[job.match.episode].episode_id});
  return row;
}

}  // namespace probe::rejudge
