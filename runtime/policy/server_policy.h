// A policy that is asked over a wire: the part that all servers share. Requests in the profile's
// form, chunks, conversions, connections that are made again; what goes over the wire is a
// Transport's.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/policy/chunk.h"
#include "runtime/policy/policy.h"
#include "runtime/policy/profile.h"
#include "runtime/policy/query_meter.h"
#include "runtime/policy/transport.h"

namespace probe::policy {

// The request that the profile makes of an observation. Fails (code "policy") naming the cameras
// there are when one is missing, and as to_state does.
Result<Request> to_request(const Profile& profile, const Observation& observation);

// Of what a request carries.
Delivery delivery_of(const Request& request);

// One connection, used by one world. A failure in act() ends the episode: the connection is
// dropped, and the next begin() makes another.
class ServerPolicy : public Policy {
 public:
  // `server` is HOST:PORT, for messages. `queries` may be null, and outlives this.
  ServerPolicy(Profile profile, std::string server, std::unique_ptr<Transport> transport,
               QueryMeter* queries);
  ~ServerPolicy() override;

  // Connects if there is no connection, trying again with growing pauses until the profile's
  // `timeout.wait_s` have passed. Fails (code "policy", at once where a server answers with an
  // error; or "usage", at once, where the profile and the server do not go together).
  Status begin(const EpisodeStart& start) override;
  Result<Action> act(const Observation& observation) override;
  void end(const EpisodeEnd& end) override;
  std::optional<Delivery> delivery() const override { return delivery_; }
  std::vector<std::string> notes() const override { return notes_; }

 private:
  Status connect();
  Status ask(const Observation& observation);
  Deadlines deadlines() const;
  Failure named(Failure failure) const;
  void drop();

  Profile given_;    // as chosen
  Profile profile_;  // as the connected server has adapted it
  std::string server_;
  std::unique_ptr<Transport> transport_;
  QueryMeter* queries_;
  ChunkQueue queue_;
  std::optional<Delivery> delivery_;
  std::vector<std::string> notes_;  // of the transport, once there was a connection
  bool is_open_ = false;
  bool has_answered_ = false;  // this connection, once
  bool in_episode_ = false;    // begin_episode was fine and the connection stands since
};

}  // namespace probe::policy
