// Actions out of stored traces, for the policy replay:DIR and for servers of recorded episodes.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runtime/run/policies.h"
#include "runtime/servers/served.h"

namespace probe::run {

// With which replay:DIR reads the actions of stored episodes.
PolicyContext policy_context();

// The valid episodes of a run whose traces bear their rows. Fails as read_proven_results does, and
// (kUsage) where there is none, or two that begin with one picture and one instruction (of other
// seeds) and go on otherwise.
Result<std::shared_ptr<const servers::RecordedEpisodes>> recorded_episodes(const std::string& dir);

// Of each step of these the actions from it on, at most `most`, by the step's picture and
// instruction, for servers that keep nothing between questions. A picture that two different
// sequences follow is left out.
Result<std::shared_ptr<const servers::RecordedEpisodes>> recorded_steps(const std::string& dir,
                                                                        int most);

// What the actions of a run's valid episodes are, as a profile says it: changes of the tool, or
// what the law of its robots takes, for an arm of so many joints (else 0). Fails (kUsage) where
// there are several.
struct StoredActions {
  servers::ActionForm form = servers::ActionForm::kDelta;
  int arm_joints = 0;
};
Result<StoredActions> only_actions(const std::string& dir);

// Which seed the episodes of a run are of, where its policy draws, so that of another seed they
// would be others; nothing where it draws nothing, or there are several.
Result<std::optional<int>> only_seed(const std::string& dir);

}  // namespace probe::run
