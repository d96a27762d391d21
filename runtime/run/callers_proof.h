// Whether a policy of the caller's is the one that a folder was begun with. Of a function nothing
// is known but its name, which another one may have: before it continues a folder it does a stored
// episode again.
#pragma once

#include "runtime/base/result.h"
#include "runtime/run/run.h"

namespace probe::plan {
class Plan;
}

namespace probe::run {

// In: a plan, options whose `out` is the folder, and who acts. The first valid episode that is
// stored is done again, in a world of its own, and the actions are held against the trace's, bit
// for bit; nothing is stored. Fails (kStore) naming the step that was answered otherwise; with
// IfChanged::kContinue that is a note. An empty folder, or one without a valid episode, says
// nothing.
Status check_callers_policy(const plan::Plan& plan, const RunOptions& options, const Actor& actor,
                            std::vector<std::string>& notes);

}  // namespace probe::run
