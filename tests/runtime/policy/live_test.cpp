// Worlds that do not wait: which answer is done when, what is done where none is, and who is too
// slow.
#include "runtime/policy/live.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <utility>

using namespace probe;
using namespace probe::policy;

namespace {

constexpr double kHz = 5;  // a control step has 200 ms

Action numbered(double number) { return {number, 0, 0, 0, 0, 0, -1}; }

// Says the step it saw.
class Seer final : public Policy {
 public:
  Status begin(const EpisodeStart&) override { return {}; }
  Result<Action> act(const Observation& seen) override { return numbered(seen.step); }
};

// A policy with two halves: an answer has `length` actions, seen + i / 100, and comes when the
// test says on the wall clock.
class Halves final : public Policy, public Answerer {
 public:
  Halves(int length, int use, std::optional<double> ratio = {})
      : length_(length), use_(use), ratio_(ratio) {}

  std::vector<int> asked;                        // steps that were seen
  std::vector<std::chrono::milliseconds> times;  // of answers, the last for all others

  Status begin(const EpisodeStart&) override { return {}; }
  Result<Action> act(const Observation&) override { return Failure{Fault::kPolicy, "never", ""}; }
  Answerer* answerer() override { return this; }

  Status ask(const Observation& seen, LiveClock::time_point) override {
    const std::size_t number = std::min(asked.size(), times.size() - 1);
    asked.push_back(seen.step);
    answer_.actions.clear();
    for (int i = 0; i < length_; ++i) {
      const Action action = numbered(seen.step + i / 100.0);
      answer_.actions.emplace_back(action.begin(), action.end());
    }
    answer_.came = LiveClock::now() + times[number];
    return {};
  }
  Result<std::optional<Answer>> wait(LiveClock::time_point until) override {
    std::this_thread::sleep_until(std::min(until, answer_.came));
    if (answer_.came >= until) return std::optional<Answer>();
    return std::optional(answer_);
  }
  Result<Action> convert(const Said& said, const Observation&) override {
    Action action = Action::zeros(7);
    std::copy_n(said.begin(), action.size(), action.begin());
    return action;
  }
  void done(const Action&, const Observation&) override {}
  int steps_between(int) const override { return use_; }
  std::optional<double> ensemble_ratio() const override { return ratio_; }

 private:
  int length_, use_;
  std::optional<double> ratio_;
  Answer answer_;
};

EpisodeStart live_start(double hz = kHz) {
  EpisodeStart start;
  start.control_hz = hz;
  return start;
}

// What is done in each step as a number, "-" where nothing is, "?" behind one where a question went
// out, "!" where the action is late, and "<n" where the answer to step n takes effect.
std::string steps_of(Policy& policy, int count, double hz = kHz) {
  REQUIRE(policy.begin(live_start(hz)).ok());
  std::string text;
  for (int step = 0; step < count; ++step) {
    Observation seen;
    seen.step = step;
    const auto action = policy.act(seen);
    REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
    const LiveStep* live = policy.live_step();
    REQUIRE(live != nullptr);
    if (step > 0) text += " ";
    char number[20];
    std::snprintf(number, sizeof number, "%g", (*action)[0]);
    text += live->source == LiveSource::kHeld ? "-" : number;
    if (live->source == LiveSource::kLate) text += "!";
    for (const LiveAnswer& answer : live->answers) text += "<" + std::to_string(answer.asked);
    if (live->asks) text += "?";
    // Nothing moves without an action, and the gripper stays as it was told last: open at first.
    if (live->source == LiveSource::kHeld) {
      const bool is_told = text.find('<') != std::string::npos;
      CHECK(*action == Action{0, 0, 0, 0, 0, 0, is_told ? -1.0 : 1.0});
    }
  }
  policy.end({true, false, count});
  return text;
}

std::string with_delay(double delay_s, int count) {
  const auto policy = make_live(std::make_unique<Seer>(), LiveTerms{.delay_s = delay_s});
  return steps_of(*policy, count);
}

std::string chunked_with_delay(double delay_s, int length, int use, int count,
                               std::optional<double> ratio = {}) {
  auto halves = std::make_unique<Halves>(length, use, ratio);
  halves->times = {std::chrono::milliseconds(0)};
  const auto policy = make_live(std::move(halves), LiveTerms{.delay_s = delay_s});
  return steps_of(*policy, count);
}

}  // namespace

TEST_CASE("an answer within its control step is done in it: a world that waits does the same") {
  CHECK(with_delay(0, 4) == "0<0? 1<1? 2<2? 3<3?");
  CHECK(with_delay(0.199, 4) == "0<0? 1<1? 2<2? 3<3?");
}

TEST_CASE("an answer that takes a step is done a step late, and the next one asks at once") {
  // Each action is done once, late; the newest picture is asked with as soon as the policy is free.
  CHECK(with_delay(0.2, 5) == "-? 0!<0? 1!<1? 2!<2? 3!<3?");
  CHECK(with_delay(0.6, 8) == "-? - - 0!<0? - - 3!<3? -");
}

TEST_CASE("a policy that takes more than a step and less than two is at times late by two") {
  // It is done at 0.25, 0.5, 0.75 s and so on, and sees what is newest then.
  CHECK(with_delay(0.25, 6) == "-? 0!<0? 1!<1? 2!<2? - 3!<3?");
}

TEST_CASE("of a chunk that comes late the actions whose time has passed are not done") {
  CHECK(chunked_with_delay(0, 4, 4, 6) == "0<0? 0.01 0.02 0.03 4<4? 4.01");
  CHECK(chunked_with_delay(0.2, 4, 4, 7) == "-? 0.01<0 0.02 0.03 -? 4.01<4 4.02");
  // Asked for early enough, what is left of the old one bridges the time.
  CHECK(chunked_with_delay(0.2, 4, 3, 8) == "-? 0.01<0 0.02 0.03? 3.01<3 3.02 3.03? 6.01<6");
  // All of it is past: its last action is done, once.
  CHECK(chunked_with_delay(0.6, 2, 2, 5) == "-? - - 0.01!<0? -");
}

TEST_CASE("answers that overlap are weighed together for the step that all of them mean") {
  // Step 2 is meant by the answers to 0 and 1, whose second and third actions it is.
  CHECK(chunked_with_delay(0.2, 3, 1, 3, 1.0) == "-? 0.01<0? 0.515<1?");
}

TEST_CASE("on the wall clock an answer takes effect in the control step in whose time it came") {
  auto halves = std::make_unique<Halves>(1, 1);
  Halves& told = *halves;
  told.times = {std::chrono::milliseconds(20), std::chrono::milliseconds(1300),
                std::chrono::milliseconds(50'000)};
  const auto policy = make_live(std::move(halves), LiveTerms{});
  const auto begun = LiveClock::now();
  // A second a step, so that a busy machine keeps up with it.
  CHECK(steps_of(*policy, 5, 1) == "0<0? -? 1!<1? - -");
  CHECK(told.asked == std::vector<int>{0, 1, 2});
  // The answer that never came in time is nobody's.
  const double took = std::chrono::duration<double>(LiveClock::now() - begun).count();
  CHECK(took >= 4);
}

TEST_CASE("a simulation that falls behind the clock is told, and its episode does not count") {
  auto halves = std::make_unique<Halves>(1, 1);
  halves->times = {std::chrono::milliseconds(0)};
  const auto policy = make_live(std::move(halves), LiveTerms{});
  REQUIRE(policy->begin(live_start()).ok());
  Observation seen;
  REQUIRE(policy->act(seen).ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(350));
  seen.step = 1;
  const auto action = policy->act(seen);
  REQUIRE_FALSE(action.ok());
  CHECK(action.failure().code == Fault::kWorld);
  CHECK(action.failure().message.find("the simulation is slower than the clock: control step 1 "
                                      "began ") == 0);
}

TEST_CASE("a policy slower than its rate does not make the world later with each question") {
  auto halves = std::make_unique<Halves>(1, 1);
  halves->times = {std::chrono::milliseconds(150)};
  const auto policy = make_live(std::move(halves), LiveTerms{});
  EpisodeStart start;
  start.control_hz = 10;
  REQUIRE(policy->begin(start).ok());
  for (int step = 0; step < 30; ++step) {
    Observation seen;
    seen.step = step;
    const auto action = policy->act(seen);
    REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
    std::this_thread::sleep_for(std::chrono::milliseconds(8));  // of physics and pictures
  }
}

TEST_CASE("a gripper that was told to be half open stays so while nothing is done") {
  class Half final : public Policy {
   public:
    Status begin(const EpisodeStart&) override { return {}; }
    Result<Action> act(const Observation&) override { return Action{0, 0, 0, 0, 0, 0, 0}; }
  };
  const auto policy = make_live(std::make_unique<Half>(), LiveTerms{.delay_s = 0.6});
  REQUIRE(policy->begin(live_start()).ok());
  for (int step = 0; step < 6; ++step) {
    Observation seen;
    seen.step = step;
    const auto action = policy->act(seen);
    REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
    CHECK((*action)[6] == (step < 3 ? 1.0 : 0.0));  // open at first, as it was found
  }
}

TEST_CASE("a policy in this process is late by what it took") {
  class Slow final : public Policy {
   public:
    Status begin(const EpisodeStart&) override { return {}; }
    Result<Action> act(const Observation& seen) override {
      std::this_thread::sleep_for(std::chrono::milliseconds(seen.step == 0 ? 1050 : 0));
      return numbered(seen.step);
    }
  };
  const auto policy = make_live(std::make_unique<Slow>(), LiveTerms{});
  // Free again, it is in time with the picture of the step in which its first answer came.
  CHECK(steps_of(*policy, 4, 1) == "-? 1<0<1? 2<2? 3<3?");
}

TEST_CASE("figures say how often nothing was done and how late answers were") {
  LiveFigures figures;
  CHECK(to_text(figures) == "no control step was done");
  for (int step = 0; step < 100; ++step) {
    LiveStep live;
    live.source = step % 4 == 0 ? LiveSource::kHeld : LiveSource::kAnswer;
    if (step % 4 == 1) live.answers = {{step - (step == 97 ? 3 : 1), step == 97 ? 0.65 : 0.25}};
    figures.add(step, live);
  }
  CHECK(figures.held_share() == 0.25);
  CHECK(to_text(figures) ==
        "25.0 % of 100 control steps had no action of the policy; 25 answers took effect after 1 "
        "control step (250 ms) at the median, 3 control steps (650 ms) at the 99th percentile");
  CHECK(percentile({3, 1, 2}, 0.5) == 2);
  CHECK(percentile({3, 1, 2, 4}, 0.5) == 2);
  CHECK(percentile({}, 0.5) == 0);
}

TEST_CASE("terms say all that rows depend on") {
  CHECK(to_text(LiveTerms{}) == "live, as measured, at most 90 % held");
  CHECK(to_text(LiveTerms{.delay_s = 0.08, .most_held = 0.5}) == "live, 80 ms, at most 50 % held");
}
