// Known observations asked of a server, each in an episode of its own, for `policy test` and for
// the probe at a run's beginning. Runs no simulator.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/laws.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"
#include "runtime/wire/value.h"

namespace probe::servers {

// An answer's actions, as the server sent them.
using Chunk = std::vector<RawAction>;

// Which of the known observations: pictures and instructions are numbered from 0, and a mirrored
// state is the same arm on the robot's other side.
struct KnownObservation {
  int picture = 0;  // at most kMostInBatch: one for each observation of a batch
  int words = 0;    // below kInstructions
  bool is_mirrored = false;
};
inline constexpr int kInstructions = 2;

// How far the numbers of an answer are from those of another, at most; infinite where they are of
// other lengths.
double apart(const Chunk& here, const Chunk& there);

// What a batch of observations that were also asked alone shows of a server.
struct TogetherFinding {
  // It took one observation for another, so none of its answers is believed: why. Empty: it did
  // not.
  std::string mixed;
  double difference = 0;  // the largest of an answer's number from that of the observation alone
};
// An answer of the batch that is far nearer to another observation's than to its own is that one's.
TogetherFinding compare_together(const std::vector<Chunk>& alone,
                                 const std::vector<Chunk>& together);

// Of what robot an observation's state is: how many joints it says, of the arm and of the fingers.
struct KnownArm {
  std::size_t joints = 6;
  std::size_t fingers = 2;
  robot::ControlKind control = robot::ControlKind::kEeDeltaPose;  // what actions go through
};

// Where an observation's arm is, gripper open, 5 cm to one side so that mirroring it moves it: of
// six joints the WidowX at the start of its table tasks, of seven a Franka at its ready pose; of
// another number all joints but the first are at zero, and the tool is the WidowX's.
policy::Proprioception known_state(bool is_mirrored, const KnownArm& arm = {});

// The one that a profile is for, with two fingers.
inline KnownArm known_arm(const Profile& profile) {
  return {.joints = static_cast<std::size_t>(profile.arm_joints)};
}

// 640 x 480, row 0 on top; `index` is KnownObservation::picture.
wire::Bytes known_picture(int index);

// Whether a picture's bytes and an instruction are those of an observation, as rendered and worded:
// our own servers of recorded episodes answer them too, so that they can be shown to read.
bool is_known_observation(std::span<const std::uint8_t> picture, std::string_view words);

class KnownObservations {
 public:
  // `transport` outlives this.
  KnownObservations(const Profile& profile, Transport& transport, const KnownArm& arm = {})
      : profile_(profile), transport_(transport), arm_(arm) {}

  // One attempt; the profile becomes what the server makes of it.
  Status open();
  // For a transport that is open already, and the profile that it adapted.
  void adopt(const Profile& adapted) { profile_ = adapted; }

  // The first answer of an episode that is begun and ended.
  Result<Chunk> ask(const KnownObservation& observation);

  // The answers to several in one message, each as if it were alone in an episode.
  Result<std::vector<Chunk>> ask_together(const std::vector<KnownObservation>& observations);

  // Over what the observations carry, as the profile has it sent.
  Result<Sha256> hash_of(const std::vector<KnownObservation>& observations) const;

  const Profile& profile() const { return profile_; }
  const KnownArm& arm() const { return arm_; }
  int asked() const { return asked_; }
  const std::vector<double>& times() const { return times_; }  // of answers, s

  Result<Request> request_of(const KnownObservation& observation) const;

 private:
  Deadlines deadlines() const;

  Profile profile_;
  Transport& transport_;
  KnownArm arm_;
  int asked_ = 0;
  std::vector<double> times_;
};

}  // namespace probe::servers
