// P0704.
#include <map>
#include <vector>

#include "compiler/emit/emitter.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/ids.h"

namespace probe::emit {

bool Emitter::check_language_only(const std::vector<TaskId>& chosen) {
  // The ids of these tasks alone: `check` writes no plan, which needs those of all.
  plan::IdHasher ids(records().tables());
  const auto starts_of = [&](const plan::TaskRecord& task) {
    std::vector<Sha256> starts;
    for (std::uint32_t e = 0; e < task.episodes.count; ++e)
      starts.push_back(ids.start(task, records().episodes[task.episodes.first + e]));
    return starts;
  };
  std::map<std::uint32_t, std::vector<Sha256>> of_baselines;  // which have many such variants
  bool ok = true;
  for (std::size_t i = 0; i < records().tasks.size(); ++i) {
    const plan::TaskRecord& task = records().tasks[i];
    if (task.baseline == plan::kNone || task.axes == 0 || (task.axes & ~plan::kLanguageAxes) != 0)
      continue;
    const plan::TaskRecord& baseline = records().tasks[task.baseline];
    const auto [starts, is_new] = of_baselines.try_emplace(task.baseline);
    if (is_new) starts->second = starts_of(baseline);
    if (ids.judge(task) == ids.judge(baseline) && starts_of(task) == starts->second) continue;
    ok = false;
    const sema::Task& written = model_.tasks[chosen[i]];
    diagnostics_.report(
        Code::P0704, written.span,
        "`" + written.name +
            "` changes only language, but its starts or its judgement differ from its baseline");
  }
  return ok;
}

}  // namespace probe::emit
