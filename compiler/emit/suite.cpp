// Suites as records.
#include <algorithm>

#include "compiler/emit/emitter.h"

namespace probe::emit {

bool Emitter::suite_is_kept(const sema::Suite& suite) const {
  return options_.suite.empty() || suite.name == options_.suite;
}

// The episodes that a suite runs, where it does not run all of its members'.
plan::Slice Emitter::add_drawn(const sema::Suite& suite) {
  if (suite.drawn.empty()) return {};
  std::vector<std::uint32_t> episodes;
  for (const sema::TaskId id : suite.members) {
    if (tasks_[id] == plan::kNone) continue;
    const std::uint32_t first = records().tasks[tasks_[id]].episodes.first;
    for (const std::uint32_t start : suite.starts_of(id, model_.tasks[id]))
      episodes.push_back(first + start);
  }
  std::ranges::sort(episodes);
  return writer_.list(episodes);
}

void Emitter::add_suites() {
  for (const sema::Suite& suite : model_.suites) {
    if (!suite_is_kept(suite)) continue;
    plan::SuiteRecord record;
    record.name = writer_.text(suite.name);
    record.prefix = writer_.text(suite.prefix);
    if (suite.trained_on != sema::DatasetId::kNone) {
      record.trained_on = writer_.text(model_.datasets[suite.trained_on].name);
    }
    record.members = add_members(suite.members);
    record.seeds = writer_.list(suite.seeds);
    record.episodes = add_drawn(suite);
    records().suites.push_back(record);
  }
}

}  // namespace probe::emit
