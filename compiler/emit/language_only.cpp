// P0704.
#include "compiler/emit/emitter.h"
#include "runtime/plan/axes.h"

namespace probe::emit {

bool Emitter::check_language_only(const std::vector<TaskId>& chosen) {
  bool ok = true;
  for (std::size_t i = 0; i < records().tasks.size(); ++i) {
    const plan::TaskRecord& task = records().tasks[i];
    if (task.baseline == plan::kNone || task.axes == 0 || (task.axes & ~plan::kLanguageAxes) != 0)
      continue;
    const plan::TaskRecord& baseline = records().tasks[task.baseline];
    bool same =
        task.judge_id == baseline.judge_id && task.episodes.count == baseline.episodes.count;
    for (std::uint32_t e = 0; same && e < task.episodes.count; ++e) {
      same = records().episodes[task.episodes.first + e].start_id ==
             records().episodes[baseline.episodes.first + e].start_id;
    }
    if (same) continue;
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
