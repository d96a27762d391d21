// Suites as records.
#include "compiler/emit/emitter.h"

namespace probe::emit {

bool Emitter::suite_is_kept(const sema::Suite& suite) const {
  return options_.suite.empty() || suite.name == options_.suite;
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
    records().suites.push_back(record);
  }
}

}  // namespace probe::emit
