// Known observations asked of a server, each in an episode of its own, for `policy test` and for
// the probe at a run's beginning. Runs no simulator.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

// An answer's actions, as the server sent them.
using Chunk = std::vector<RawAction>;

// Which of the known observations: pictures and instructions are numbered from 0, and a mirrored
// state is the same arm on the robot's other side.
struct Question {
  int picture = 0;
  int words = 0;  // below kInstructions
  bool is_mirrored = false;
};
inline constexpr int kInstructions = 2;

// Where a question's arm is: the WidowX at the start of its table tasks, gripper open, 5 cm to one
// side so that mirroring it moves it.
policy::Proprioception known_state(bool is_mirrored);

class Questions {
 public:
  // `transport` outlives this.
  Questions(const Profile& profile, Transport& transport)
      : profile_(profile), transport_(transport) {}

  // One attempt; the profile becomes what the server makes of it.
  Status open();
  // For a transport that is open already, and the profile that it adapted.
  void adopt(const Profile& adapted) { profile_ = adapted; }

  // The first answer of an episode that is begun and ended.
  Result<Chunk> ask(const Question& question);

  const Profile& profile() const { return profile_; }
  int asked() const { return asked_; }
  const std::vector<double>& times() const { return times_; }  // of answers, s

 private:
  Deadlines deadlines() const;

  Profile profile_;
  Transport& transport_;
  int asked_ = 0;
  std::vector<double> times_;
};

}  // namespace probe::servers
