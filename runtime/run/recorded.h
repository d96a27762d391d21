// Actions out of stored traces, for the policy replay:DIR and for servers of recorded episodes.
#pragma once

#include <memory>

#include "runtime/run/policies.h"
#include "runtime/servers/served.h"

namespace probe::run {

// With which replay:DIR reads the actions of stored episodes.
PolicyContext policy_context();

// The valid episodes of a run whose traces bear their rows; of several with one first picture and
// one instruction (other seeds) the first. Fails as read_proven_results does, and (kUsage) where
// there is none.
Result<std::shared_ptr<const servers::RecordedEpisodes>> recorded_episodes(const std::string& dir);

// Of each step of these the actions from it on, at most `most`, by the step's picture and
// instruction, for servers that keep nothing between questions. A picture that two different
// sequences follow is left out.
Result<std::shared_ptr<const servers::RecordedEpisodes>> recorded_steps(const std::string& dir,
                                                                        int most);

}  // namespace probe::run
