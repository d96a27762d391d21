#include "runtime/ask/recorded.h"

#include <map>

#include "runtime/ask/ask.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/until_words.h"

namespace probe::ask {

Result<Recorded> read_recorded(const plan::Plan& plan, const std::string& dir,
                               std::vector<std::string>& notes) {
  PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
  if (!record.identity.until.empty()) {
    return Failure{Fault::kUsage,
                   store::what_chose(record.identity.until) +
                       ": rates of answers about its ends would be of episodes that were chosen by "
                       "how they ended; " +
                       store::way_out(record.identity.until),
                   dir};
  }
  PROBE_ASSIGN(store::ProvenResults proven, store::read_proven_results(dir));
  Recorded recorded;
  const store::RunIdentity& identity = record.identity;
  constexpr std::size_t kShownRoot = 12;
  recorded.identity = identity.policy + ", plan " + identity.plan_root.substr(0, kShownRoot);
  if (!identity.policy_content.empty()) recorded.identity += ", " + identity.policy_content;
  if (!identity.live.empty()) recorded.identity += ", " + identity.live;
  for (const std::string& sentence : proven.refused) notes.push_back(sentence);
  PROBE_ASSIGN(const plan::Plan run_plan, store::open_run_plan(dir));
  std::size_t strange = 0;
  std::map<std::string, std::string> other_horizons;  // by task, what is told of it
  for (store::ResultRow& row : proven.rows) {
    if (row.invalid) continue;
    const auto task = plan.find_task(row.task);
    const auto index = static_cast<std::uint32_t>(row.episode);
    const bool is_there = task && index < plan.tasks()[*task].episodes.count;
    const std::uint32_t episode = is_there ? plan.tasks()[*task].episodes.first + index : 0;
    const bool is_same = is_there && start_id_of(plan, episode) == row.start_id &&
                         to_hex(sha256(plan.text(plan.tasks()[*task].prompt))) == row.prompt_sha256;
    if (!is_same) {
      ++strange;
      continue;
    }
    // The end of a longer or shorter episode is another moment.
    const auto ran = run_plan.find_task(row.task);
    const std::uint32_t horizon = plan.tasks()[*task].horizon;
    if (ran && run_plan.tasks()[*ran].horizon != horizon) {
      other_horizons.try_emplace(row.task, "`" + row.task + "` of " + dir +
                                               " is left out: it ran for at most " +
                                               std::to_string(run_plan.tasks()[*ran].horizon) +
                                               " steps, the plan's is " + std::to_string(horizon));
      continue;
    }
    recorded.ends.push_back({episode, row.seed, recorded.rows.size()});
    recorded.rows.push_back(std::move(row));
  }
  if (strange > 0) {
    notes.push_back(std::to_string(strange) + " episodes of " + dir +
                    " are left out: the plan has no task of that name, start and instruction");
  }
  if (recorded.ends.empty() && !other_horizons.empty())
    return Failure{Fault::kUsage, other_horizons.begin()->second, "--frames"};
  for (auto& [name, sentence] : other_horizons) notes.push_back(std::move(sentence));
  return recorded;
}

Result<std::vector<RecordedEnd>> recorded_ends(const plan::Plan& plan, const std::string& dir) {
  std::vector<std::string> notes;
  PROBE_ASSIGN(Recorded recorded, read_recorded(plan, dir, notes));
  return std::move(recorded.ends);
}

}  // namespace probe::ask
