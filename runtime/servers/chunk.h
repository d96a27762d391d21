// The actions a server has answered and which of them is next: chunks done without a question, or
// answers of every step weighed together.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

class ChunkQueue {
 public:
  explicit ChunkQueue(const Profile& profile);

  // At the start of an episode.
  void clear();

  // Whether the next action needs an answer first.
  bool wants_answer() const;

  // Fails (kPolicy) when an answer's actions are not as many as the profile says.
  Status check(const std::vector<RawAction>& actions) const;

  // An answer's actions, the first for this control step. Fails as check does.
  Status put(std::vector<RawAction> actions);

  // The action of this control step; only when no answer is wanted.
  RawAction take();

 private:
  RawAction blended() const;

  int length_, use_;
  bool blends_;
  double ratio_;
  bool has_answer_ = false;         // of this control step
  std::vector<RawAction> actions_;  // of the newest answer
  std::size_t next_ = 0, end_ = 0;  // of actions_, what is still done
  // Answers with a prediction of this step, oldest first, and what they predict for it and after.
  std::deque<std::deque<RawAction>> answers_;
};

}  // namespace probe::servers
