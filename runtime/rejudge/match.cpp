#include "runtime/rejudge/match.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "runtime/plan/ids.h"
#include "runtime/store/episode_key.h"

namespace probe::rejudge {
namespace {

constexpr auto kGoalOnly = static_cast<std::uint32_t>(plan::Axis::kGoal);

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// "differs in the camera, pose of the source", by the parts of both start ids.
std::string difference(const plan::Plan& plan, std::uint32_t task, std::uint32_t episode,
                       const plan::Plan& recorded, const store::ResultRow& row) {
  const auto old_task = recorded.find_task(row.task);
  if (!old_task) return "the stored plan does not have the task";
  const plan::TaskRecord& before = recorded.tasks()[*old_task];
  const auto index = static_cast<std::size_t>(row.episode);
  if (index >= recorded.episodes(before).size()) return "the stored plan does not have the episode";
  const plan::TaskRecord& after = plan.tasks()[task];
  const auto a =
      plan::IdHasher(recorded.tables()).start_parts(before, recorded.episodes(before)[index]);
  const auto b = plan::IdHasher(plan.tables()).start_parts(after, plan.episodes(after)[episode]);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] != b[i]) parts.push_back(a[i].name);
  }
  if (a.size() != b.size()) parts.emplace_back("number of objects");
  return parts.empty() ? "it is not the start of the stored plan"
                       : "they differ in: " + joined(parts);
}

}  // namespace

Result<std::optional<std::uint32_t>> find_judge(const plan::Plan& plan,
                                                std::span<const std::uint32_t> candidates,
                                                const std::string& name) {
  std::vector<std::uint32_t> variants;
  for (const std::uint32_t candidate : candidates) {
    const plan::TaskRecord& task = plan.tasks()[candidate];
    if (plan.text(task.name) == name) return std::optional(candidate);
    if (task.baseline == plan::kNone || (task.axes & ~kGoalOnly) != 0) continue;
    if (plan.text(plan.tasks()[task.baseline].name) == name) variants.push_back(candidate);
  }
  if (variants.empty()) return std::optional<std::uint32_t>();
  if (variants.size() == 1) return std::optional(variants.front());
  return Failure{Fault::kUsage,
                 fmt::format("tasks `{}` and `{}` both stand for it; name a suite with one of them",
                             plan.text(plan.tasks()[variants[0]].name),
                             plan.text(plan.tasks()[variants[1]].name)),
                 name};
}

Result<Match> match_start(const plan::Plan& plan, std::uint32_t task, const store::ResultRow& row,
                          const plan::Plan& recorded) {
  const std::string where = to_text(store::key_of(row));
  const auto episodes = plan.episodes(plan.tasks()[task]);
  const auto index = static_cast<std::uint32_t>(row.episode);
  if (row.episode < 0 || index >= episodes.size()) {
    return Failure{Fault::kUsage,
                   fmt::format("task `{}` of the judging plan has {} episodes",
                               plan.text(plan.tasks()[task].name), episodes.size()),
                   where};
  }
  if (to_hex(Sha256{episodes[index].start_id}) == row.start_id) return Match{task, index};
  return Failure{Fault::kUsage,
                 "it began at another start than the judging plan's; " +
                     difference(plan, task, index, recorded, row),
                 where};
}

}  // namespace probe::rejudge
