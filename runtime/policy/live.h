// Policies in a world that does not wait for them. A question goes out with the newest observation;
// control steps go on; its answer takes effect in the control step in whose period it came, and its
// action number i is meant for the step i after the one that was seen, so that those whose time has
// passed are dropped. A step for which no answer has an action holds: no motion, the gripper as it
// was told last. runtime/policy/README.md has the rule and where it comes from. Knows no servers.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"

namespace probe::policy {

using LiveClock = std::chrono::steady_clock;

// What a run says of how it is live. Equal ones give equal rows where policies are.
struct LiveTerms {
  // Of every answer, s; none: as measured.
  std::optional<double> delay_s;
  double most_held = 0.9;  // of an episode's control steps, 0..1: more make it invalid
  bool operator==(const LiveTerms&) const = default;
};
// "live, as measured, at most 90 % held", "live, 80 ms, at most 90 % held".
std::string to_text(const LiveTerms& terms);

enum class LiveSource : std::uint8_t {
  kAnswer,  // the action that an answer has for this step
  kLate,    // the last action of an answer that came after the time of all of them
  kHeld,    // none: no motion
};
// "answer", "late", "held".
std::string_view to_word(LiveSource source);

// An answer, in the control step in which it takes effect; its delay in control steps is that
// step's number less `asked`.
struct LiveAnswer {
  int asked = 0;        // the step whose observation it answers
  double answer_s = 0;  // from that observation to the answer; of no part in any hash
  bool operator==(const LiveAnswer&) const = default;
};

// One control step of a live episode.
struct LiveStep {
  LiveSource source = LiveSource::kHeld;
  bool asks = false;  // a question went out with this step's observation
  // In the order in which they came; two where a late answer is overtaken by one in time.
  std::vector<LiveAnswer> answers;
  bool operator==(const LiveStep&) const = default;
};
inline constexpr std::size_t kMostAnswersOfAStep = 2;

// How often an episode, or a run, had no action of its policy, and how late its answers were.
struct LiveFigures {
  std::int64_t steps = 0, held = 0, late = 0;
  std::vector<int> delays;       // control steps, of each answer
  std::vector<double> answer_s;  // of each answer
  void add(int step, const LiveStep& live);
  void add(const LiveFigures& other);
  double held_share() const {
    return steps == 0 ? 0 : static_cast<double>(held) / static_cast<double>(steps);
  }
};
// "12.5 % of 1440 control steps held ...; 360 answers came after 1 control step (212 ms) at the
// median and 3 (611 ms) at the 99th percentile".
std::string to_text(const LiveFigures& figures);
// By nearest rank, 0 < share <= 1; of no values 0.
double percentile(std::vector<double> values, double share);

// The two halves of a policy that a live world needs apart. One question at a time.
class Answerer {
 public:
  using Said = std::vector<double>;  // an action's numbers as the policy has them
  struct Answer {
    std::vector<Said> actions;  // the first for the step that was seen
    LiveClock::time_point came;
  };
  virtual ~Answerer() = default;

  // What is asked does not change any more when this returns. An answer is of use until
  // `useful_until`, the episode's end on the wall clock; max(): whenever it comes.
  virtual Status ask(const Observation& seen, LiveClock::time_point useful_until) = 0;
  // The answer to the question, if it comes before `until`.
  virtual Result<std::optional<Answer>> wait(LiveClock::time_point until) = 0;
  // One of an answer's actions as what is done in the step of `now`.
  virtual Result<Action> convert(const Said& said, const Observation& now) = 0;
  // What is done in that step, whoever's it is.
  virtual void done(const Action& action, const Observation& now) = 0;

  // Control steps from the question with step `asked` to the next one, at least.
  virtual int steps_between(int asked) const = 0;
  // Weight of each newer answer's prediction of a step against the one before, for the mean of all;
  // none: the newest alone.
  virtual std::optional<double> ensemble_ratio() const { return std::nullopt; }
};

// `inner` in a world that does not wait. A policy that asks by an Answerer of its own is paced by
// the wall clock, unless the delay is given: then, and of any other policy, the world's clock
// stands while it thinks, and what it took (or the given delay) passes at once.
std::unique_ptr<Policy> make_live(std::unique_ptr<Policy> inner, const LiveTerms& terms);

// Of actions that are known, with an answerer whose answers come when it says (replay). The world's
// clock is only counted: step k begins k periods after LiveClock's epoch.
std::unique_ptr<Policy> make_live(std::unique_ptr<Answerer> recorded);

}  // namespace probe::policy
