// The run whose episodes' ends are asked about.
#pragma once

#include <string>
#include <vector>

#include "runtime/ask/prepared.h"
#include "runtime/ask/queries.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::ask {

// The valid episodes of a run that are of this plan's starts, in the order of their rows.
struct Recorded {
  RecordedRows rows;
  std::vector<RecordedEnd> ends;
  std::string identity;  // AskIdentity::frames
};
// Fails as store::read_proven_results does; what is left out of it is noted.
Result<Recorded> read_recorded(const plan::Plan& plan, const std::string& dir,
                               std::vector<std::string>& notes);

}  // namespace probe::ask
