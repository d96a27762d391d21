// The questions that a run begins with: does the server read its pictures and instructions at all.
#pragma once

#include <memory>

#include "runtime/base/result.h"
#include "runtime/policy/reading.h"
#include "runtime/servers/identity.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/servers.h"

namespace probe::servers {

// One picture with two instructions, one instruction with two pictures, over one connection that is
// closed again. Waits for a server that is not there, and has it load its model, before any other
// connection of the run. What profile and server leave open of the actions' meaning is measured;
// fails (kUsage) on what the answers do not show, see meaning.h, and as a connection does (kPolicy,
// kUsage). What goes wrong with the answers is told in the reading. `arm` is the robot's whose
// state the questions carry; `model` is the run's, or nothing. Where the choice asks in batches,
// one of as many questions as it can have is compared with the same questions alone.
// `first`, where it is given, is what it takes to ask them again.
Result<policy::Reading> prove_reading(const ServerChoice& choice,
                                      const std::shared_ptr<SharedModel>& model,
                                      const KnownArm& arm, FirstAnswers* first = nullptr);
// Of the arm that the profile says.
Result<policy::Reading> prove_reading(const ServerChoice& choice);

// The same questions after the last episode: whether the policy that was read then is the one that
// answered to the end. Of one that draws, whose answers differ anyway, its hello is looked at.
// `model` is the run's, so that nothing is loaded again; waits for a server as a run does.
policy::AtEnd prove_again(const ServerChoice& choice, const std::shared_ptr<SharedModel>& model,
                          Identity& identity);

}  // namespace probe::servers
