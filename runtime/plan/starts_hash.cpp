#include "runtime/plan/starts_hash.h"

#include <set>

#include "runtime/plan/ids.h"

namespace probe::plan {

Sha256 starts_hash(const Plan& plan, const TaskRecord& task) {
  std::set<std::array<std::uint8_t, 32>> starts;
  for (const EpisodeRecord& episode : plan.episodes(task)) starts.insert(episode.start_id);
  Hasher hasher;
  hasher.text("vlaprobe.starts.1");
  for (const auto& start : starts) hasher.hash(to_sha256(start));
  return hasher.finish();
}

}  // namespace probe::plan
