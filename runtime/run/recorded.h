// Actions out of stored traces, for the policy replay:DIR and for servers of recorded episodes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "runtime/base/asset_root.h"
#include "runtime/plan/plan.h"
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

// What the robots of these tasks (indices) take, and what the actions of a run's valid episodes
// are. Both fail (kUsage) where there are several.
Result<servers::ServedActions> only_actions(const plan::Plan& plan,
                                            std::span<const std::uint32_t> tasks,
                                            const AssetRoot& assets);
Result<servers::ServedActions> only_actions(const std::string& dir);

// Which seed the episodes of a run are of, where its policy draws, so that of another seed they
// would be others; nothing where it draws nothing, or there are several.
Result<std::optional<int>> only_seed(const std::string& dir);

}  // namespace probe::run
