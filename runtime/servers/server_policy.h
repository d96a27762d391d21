// A policy that is asked over a wire: the part that all servers share. Requests in the profile's
// form, chunks, conversions, connections that are made again; what goes over the wire is a
// Transport's.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/policy/live.h"
#include "runtime/policy/policy.h"
#include "runtime/policy/query_meter.h"
#include "runtime/robot/action_space.h"
#include "runtime/robot/kinematics.h"
#include "runtime/servers/chunk.h"
#include "runtime/servers/identity.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

// The request that the profile makes of an observation. Fails (kPolicy) naming the cameras
// there are when one is missing, and as to_state does.
Result<Request> to_request(const Profile& profile, const policy::Observation& observation);

// Of what a request carries.
policy::Delivery delivery_of(const Request& request);

// One connection, used by one world. A failure in act() ends the episode: the connection is
// dropped, and the next begin() makes another. In a world that does not wait a question is asked on
// a thread of its own; one that is still under way when the episode ends is waited for, no longer
// than an attempt to connect, and forgotten.
class ServerPolicy : public policy::Policy, public policy::Answerer {
 public:
  // `server` is HOST:PORT, for messages. `queries` may be null, and outlives this. `identity`, if
  // there is one, is asked of each connection but those that this side ended.
  ServerPolicy(Profile profile, std::string server, std::unique_ptr<Transport> transport,
               policy::QueryMeter* queries, std::shared_ptr<Identity> identity = nullptr);
  ~ServerPolicy() override;

  // Connects if there is no connection, trying again with growing pauses until the profile's
  // `timeout.wait_s` have passed. Fails (kPolicy, at once where a server answers with an
  // error; or kUsage, at once, where the profile and the server do not go together).
  Status begin(const policy::EpisodeStart& start) override;
  Result<policy::Action> act(const policy::Observation& observation) override;
  void end(const policy::EpisodeEnd& end) override;
  std::optional<Failure> spoiled() const override { return spoiled_; }
  bool is_earlier_spoiled() const override { return is_earlier_spoiled_; }
  std::optional<policy::Delivery> delivery() const override { return delivery_; }
  std::vector<std::string> notes() const override { return notes_; }

  policy::Answerer* answerer() override { return this; }
  Status ask(const policy::Observation& seen, policy::LiveClock::time_point useful_until) override;
  Result<std::optional<Answer>> wait(policy::LiveClock::time_point until) override;
  Result<policy::Action> convert(const RawAction& said, const policy::Observation& now) override;
  void done(const policy::Action& action, const policy::Observation& now) override;
  int steps_between(int asked) const override;
  std::optional<double> ensemble_ratio() const override;

 private:
  Status connect();
  Status ask_and_wait(const policy::Observation& observation);
  Result<Request> next_request(const policy::Observation& observation);
  void forget_question();
  Status check_identity();
  Status show_who_answers();
  Status kept(const Status& fine);
  bool is_exchanged_unseen() const;
  void note_answer();
  void note_unasked(const Failure& failure);
  Deadlines deadlines() const;
  void drop();
  void hang_up();

  Profile given_;    // as chosen
  Profile profile_;  // as the connected server has adapted it
  std::string server_;
  std::unique_ptr<Transport> transport_;
  policy::QueryMeter* queries_;
  std::shared_ptr<Identity> identity_;
  ChunkQueue queue_;
  std::string instruction_;  // of the last question
  StickyGripper sticky_{StickyRule::kNone, 1};
  std::optional<policy::Delivery> delivery_;
  std::optional<robot::Chain> arm_;  // of the episode's robot, where actions name its joints
  robot::ActionSpace space_;         // of the episode's robot
  std::optional<Pose> target_;  // of the arm's controller; none before an episode's first action
  std::vector<std::string> notes_;  // of the transport, once there was a connection
  bool is_open_ = false;
  std::optional<Failure> spoiled_;  // how the episode that was ended last was
  bool is_earlier_spoiled_ = false;
  int asked_ = 0;                                // questions of the episode
  policy::LiveClock::time_point asked_at_ = {};  // of the question under way, in a live world
  wire::Duration last_took_{0};                  // the last answer, from its question on
  bool is_shown_ = false;                        // who answers, since a connection was last lost
  bool has_answered_ = false;                    // this connection, once
  std::future<Result<Answer>> question_;         // under way
  std::size_t last_length_ = 1;                  // actions of the last answer
  bool in_episode_ = false;  // begin_episode was fine and the connection stands since
};

}  // namespace probe::servers
