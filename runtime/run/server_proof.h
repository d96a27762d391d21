// A policy server's part of a run: that the policy which was asked the first questions is the one
// that answered the folder's rows, from before the first episode to behind the last.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/reading.h"
#include "runtime/run/run.h"
#include "runtime/servers/identity.h"
#include "runtime/servers/servers.h"
#include "runtime/store/store.h"

namespace probe::run {

class ServerProof {
 public:
  // `arm` is the robot's whose state the questions carry; `worlds` ask the server at once.
  ServerProof(servers::ServerChoice choice, int worlds, const servers::KnownArm& arm);

  // The first questions. A server that is still warming up is asked them again for a while; fails
  // where it does not answer them: nothing could be shown of it later either.
  Result<policy::Reading> ask();

  // What was shown must be what it was when the folder was begun. Rows of calls that were not shown
  // to have had one policy to their end are its own where it answers alike, else nobody's.
  Status check_as_before(const policy::Reading& reading, const RunOptions& options,
                         store::Store& store, std::vector<std::string>& notes) const;

  // From now on rows are noted as unproven until the policy is shown to be the same one; `store`
  // outlives the connections that ask it. Before the first connection.
  Status watch(store::Store& store);

  // The questions once more: says so in `reading`. Fails where another policy answers, and makes
  // invalid what it may have answered: nobody can say when it was exchanged.
  Status check_to_the_end(policy::Reading& reading, store::Store& store,
                          std::vector<std::string>& notes) const;

  const std::shared_ptr<servers::SharedModel>& model() const { return model_; }
  // Of the connections of the run; nothing before ask().
  const std::shared_ptr<servers::Identity>& identity() const { return identity_; }

 private:
  servers::ServerChoice choice_;
  servers::KnownArm arm_;
  std::shared_ptr<servers::SharedModel> model_;  // of all connections
  std::shared_ptr<servers::Identity> identity_;
  std::atomic<bool> is_shown_again_ = false;  // after rows were stored
};

}  // namespace probe::run
