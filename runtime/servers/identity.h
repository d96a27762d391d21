// Whether the policy that a call of `run` began with is the one that answers: its first questions,
// asked again over every connection that is made anew, now and then where no connection shows an
// exchange, and when the call ends.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/reading.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

// What it takes to ask the first questions again.
struct FirstAnswers {
  std::vector<KnownObservation> observations;
  std::vector<Chunk> answers;  // alone, in the same order
  bool is_steady = false;
  bool is_batched = false;   // they were also asked together
  bool is_gathered = false;  // the server asks them beside other worlds', and may round otherwise
  // What the server said of itself; nothing where two connections were told otherwise.
  std::vector<std::string> hello = {};
  KnownArm arm = {};
};

// One for the connections of a run. Any thread may call any method at any time.
class Identity {
 public:
  explicit Identity(FirstAnswers first) : first_(std::move(first)) {}
  // Before the first connection: `asks` is called each time before the policy is asked, and what it
  // returns when the policy was shown to be the one. What was answered meanwhile is not shown.
  using Shown = std::function<void()>;
  void tell(std::function<Shown()> asks) { asks_ = std::move(asks); }

  // Of a connection that was just opened, whose profile is `adapted`: its hello is looked at, and
  // of a policy that draws nothing the first question is asked, in an episode of its own (of one
  // asked in batches, all of them in one message, too). Fails (kPolicy) where another policy
  // answers, from then on at once, and where it is not answered.
  Status check(Transport& transport, const Profile& adapted);
  // The hello alone, of a connection that this side ended and made again.
  Status check_hello(const Transport& transport);

  // Of protocols where an exchange is not seen: an answer of an episode came; and whether so many
  // came since the last time that who answers is to be asked again at the border of an episode.
  // True to one caller, which check()s.
  static constexpr int kAnswersBetween = 50;
  void note_answer() { ++answers_; }
  bool is_due();

  // Every question, as when the call began.
  policy::AtEnd ask_all(Transport& transport, const Profile& adapted);

  // kNotAsked while nothing speaks against it; else what did.
  policy::AtEnd found() const;

  const FirstAnswers& first() const { return first_; }
  // Of a policy that draws nothing: whether this is its answer to the first question, asked among
  // others in one message.
  bool is_first_answer(const Chunk& answer) const;
  // The questions of one message were taken for one another.
  void note_mixed();

 private:
  Result<policy::AtEnd> ask_again(Transport& transport, const Profile& adapted, std::size_t count);
  Status lost() const;
  void note(policy::AtEnd at_end);

  FirstAnswers first_;
  std::function<Shown()> asks_;
  std::atomic<int> answers_ = 0;  // since the last is_due() that was true
  mutable std::mutex mutex_;
  policy::AtEnd found_ = policy::AtEnd::kNotAsked;
};

}  // namespace probe::servers
