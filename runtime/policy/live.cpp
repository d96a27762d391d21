#include "runtime/policy/live.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <thread>

#include "runtime/base/percent.h"
#include "runtime/robot/action_space.h"

namespace probe::policy {
namespace {

using Time = LiveClock::time_point;
using Nanoseconds = std::chrono::nanoseconds;

// Of a control step, that the simulation may be behind the wall clock when one begins: a server
// would have less time, and other pictures, than at a robot.
constexpr double kMostBehind = 0.5;

double in_seconds(LiveClock::duration time) { return std::chrono::duration<double>(time).count(); }

std::string milliseconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f ms", seconds * 1000);
  return text;
}

// Policies of this process, and servers with a given delay: they think while the world's clock
// stands, and their answer comes when that time has passed on it. Told when a question goes out.
class Standing {
 public:
  Standing(Policy& inner, std::optional<double> delay_s) : inner_(inner), delay_s_(delay_s) {}

  Result<Answerer::Answer> ask(const Observation& seen, Time now) {
    const Time begun = LiveClock::now();
    Answerer::Answer answer;
    if (Answerer* halves = inner_.answerer()) {
      PROBE_TRY(halves->ask(seen, Time::max()));
      PROBE_ASSIGN(auto came, halves->wait(Time::max()));
      if (!came) return Failure{Fault::kPolicy, "no answer came", ""};
      answer = std::move(came).value();
    } else {
      PROBE_ASSIGN(const Action action, inner_.act(seen));
      answer.actions.emplace_back(action.begin(), action.end());
      answer.came = LiveClock::now();
    }
    const Nanoseconds took =
        delay_s_ ? Nanoseconds(static_cast<std::int64_t>(std::llround(*delay_s_ * 1e9)))
                 : std::chrono::duration_cast<Nanoseconds>(answer.came - begun);
    answer.came = now + took;
    return answer;
  }

 private:
  Policy& inner_;
  std::optional<double> delay_s_;
};

// The answers that have come, and what they have for a step.
class LiveAnswers {
 public:
  void clear() { answers_.clear(); }
  void put(int asked, std::vector<Answerer::Said> actions, bool keeps_older) {
    if (!keeps_older) answers_.clear();
    answers_.push_back({asked, std::move(actions)});
  }
  // `is_new`: the newest answer takes effect in this step.
  std::optional<Answerer::Said> at(int step, bool is_new, std::optional<double> ratio,
                                   LiveSource* source) {
    *source = LiveSource::kHeld;
    if (answers_.empty()) return std::nullopt;
    const auto index = [&](const Said& said) {
      return static_cast<std::size_t>(step - said.asked);
    };
    std::optional<Answerer::Said> late;
    const Said& newest = answers_.back();
    if (is_new && index(newest) >= newest.actions.size() && !newest.actions.empty())
      late = newest.actions.back();
    std::erase_if(answers_, [&](const Said& said) { return index(said) >= said.actions.size(); });
    if (answers_.empty()) {
      if (late) *source = LiveSource::kLate;
      return late;
    }
    *source = LiveSource::kAnswer;
    if (!ratio) return answers_.back().actions[index(answers_.back())];
    Answerer::Said sum(answers_.back().actions[index(answers_.back())].size());
    double weight = 1, total = 0;
    for (const Said& said : answers_) {  // oldest first
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * said.actions[index(said)][i];
      total += weight;
      weight *= *ratio;
    }
    for (double& value : sum) value /= total;
    return sum;
  }

 private:
  struct Said {
    int asked;
    std::vector<Answerer::Said> actions;
  };
  std::deque<Said> answers_;
};

class LivePolicy final : public Policy {
 public:
  LivePolicy(std::unique_ptr<Policy> inner, std::unique_ptr<Answerer> recorded,
             const LiveTerms& terms)
      : inner_(std::move(inner)), recorded_(std::move(recorded)), terms_(terms) {
    halves_ = recorded_ ? recorded_.get() : inner_->answerer();
    is_paced_ = !recorded_ && halves_ != nullptr && !terms_.delay_s;
  }

  Status begin(const EpisodeStart& start) override {
    if (!(start.control_hz > 0)) {
      return Failure{Fault::kInternal, "an episode without a control rate cannot be live", ""};
    }
    period_ = Nanoseconds(static_cast<std::int64_t>(std::llround(1e9 / start.control_hz)));
    answers_.clear();
    question_.reset();
    next_ = 0;
    space_ = start.robot == nullptr ? robot::ActionSpace{} : robot::action_space_of(*start.robot);
    told_.reset();
    live_ = {};
    return inner_ ? inner_->begin(start) : Status();
  }

  Result<Action> act(const Observation& now) override {
    const int step = now.step;
    live_ = {};
    if (step == 0) begun_ = is_paced_ ? LiveClock::now() : Time{};
    PROBE_TRY(keep_pace(step));
    seen_ = is_paced_ ? LiveClock::now() : begun_ + step * period_;
    if (!question_ && step >= next_) PROBE_TRY(ask(now, seen_));
    if (question_) PROBE_TRY(look_for_answers(now));
    return decide(now);
  }

  void end(const EpisodeEnd& end) override {
    if (inner_) inner_->end(end);
  }
  std::optional<Failure> spoiled() const override {
    return inner_ ? inner_->spoiled() : std::nullopt;
  }
  bool is_earlier_spoiled() const override { return inner_ && inner_->is_earlier_spoiled(); }
  std::optional<std::string> remark() const override {
    return inner_ ? inner_->remark() : std::nullopt;
  }
  std::optional<Delivery> delivery() const override {
    return inner_ ? inner_->delivery() : std::nullopt;
  }
  const LiveStep* live_step() const override { return &live_; }
  std::vector<std::string> notes() const override {
    return inner_ ? inner_->notes() : std::vector<std::string>();
  }

 private:
  struct Question {
    int asked;
    Time seen;                               // when its observation was there
    std::optional<Answerer::Answer> answer;  // of Standing
    std::string prompt;                      // that it was asked with
  };

  // The world's step k begins k periods after its first.
  Status keep_pace(int step) const {
    if (!is_paced_) return {};
    const Time due = begun_ + step * period_;
    std::this_thread::sleep_until(due);
    const double behind = in_seconds(LiveClock::now() - due);
    if (behind <= kMostBehind * in_seconds(period_)) return {};
    return Failure{Fault::kWorld,
                   "the simulation is slower than the clock: control step " + std::to_string(step) +
                       " began " + milliseconds(behind) + " late, and a step has " +
                       milliseconds(in_seconds(period_)) +
                       "; run fewer worlds, or on a machine with less to do",
                   ""};
  }

  Status ask(const Observation& now, Time when) {
    live_.asks = true;
    question_ = Question{now.step, seen_, std::nullopt, std::string(now.prompt)};
    if (is_paced_) return halves_->ask(now, begun_ + std::max(now.horizon, now.step + 1) * period_);
    if (recorded_) return halves_->ask(now, Time::max());
    Standing standing(*inner_, terms_.delay_s);
    PROBE_ASSIGN(question_->answer, standing.ask(now, when));
    return {};
  }

  // The answer, where it comes before this step's period is over: counted from when its observation
  // was there, as the step of that began then, and no longer than the world's clock allows.
  Status look_for_answers(const Observation& now) {
    const int step = now.step;
    while (question_) {
      Time until = question_->seen + (step - question_->asked + 1) * period_;
      // A step that began late has less time to wait, else the world would never be in time again.
      if (is_paced_) until = std::min(until, begun_ + (step + 1) * period_);
      std::optional<Answerer::Answer> answer;
      if (question_->answer) {
        if (question_->answer->came < until) answer = std::move(question_->answer);
      } else {
        PROBE_ASSIGN(answer, halves_->wait(until));
      }
      if (!answer) return {};
      const int asked = question_->asked;
      live_.answers.push_back({asked, in_seconds(answer->came - question_->seen)});
      // What was answered to another instruction is not averaged into this one's.
      const bool is_same = question_->prompt == answered_prompt_;
      answered_prompt_ = std::move(question_->prompt);
      question_.reset();
      answers_.put(asked, std::move(answer->actions), ratio().has_value() && is_same);
      next_ = asked + std::max(1, halves_ != nullptr ? halves_->steps_between(asked) : 1);
      if (asked == step || next_ > step) return {};
      // The policy is free again in the middle of this step: it sees the newest picture at once,
      // and may still be in time with it.
      PROBE_TRY(ask(now, std::max(answer->came, seen_)));
    }
    return {};
  }

  Result<Action> decide(const Observation& now) {
    Action action = hold(now);
    if (const auto said = answers_.at(now.step, !live_.answers.empty(), ratio(), &live_.source)) {
      if (halves_ != nullptr) {
        PROBE_ASSIGN(action, halves_->convert(*said, now));
      } else {
        action = Action(std::span<const double>(*said));
      }
    }
    told_ = action;
    if (halves_ != nullptr) halves_->done(action, now);
    return action;
  }

  // No motion, the gripper as it was told last.
  Action hold(const Observation& now) const {
    if (told_) return robot::standstill(space_, told_->arm(), told_->gripper());
    const Proprioception& arm = now.proprioception;
    return robot::standstill(space_, arm.joints, arm.openness >= 0.5 ? 1 : -1);
  }

  std::optional<double> ratio() const {
    return halves_ == nullptr ? std::nullopt : halves_->ensemble_ratio();
  }

  std::unique_ptr<Policy> inner_;       // or
  std::unique_ptr<Answerer> recorded_;  // this
  Answerer* halves_ = nullptr;          // of either; none of most policies in this process
  LiveTerms terms_;
  bool is_paced_ = false;
  Nanoseconds period_{0};
  Time begun_, seen_;  // the episode; this step's observation
  std::optional<Question> question_;
  std::string answered_prompt_;  // of the newest answer
  int next_ = 0;  // step of the next question, at the earliest
  LiveAnswers answers_;
  robot::ActionSpace space_;
  std::optional<Action> told_;  // last
  LiveStep live_;
};

std::string plural(std::int64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string percent_of(double share) { return decimal_text(100 * share, 1) + " %"; }

}  // namespace

std::string_view to_word(LiveSource source) {
  switch (source) {
    case LiveSource::kAnswer:
      return "answer";
    case LiveSource::kLate:
      return "late";
    case LiveSource::kHeld:
      break;
  }
  return "held";
}

std::string to_text(const LiveTerms& terms) {
  char delay[40] = "as measured", most[40];
  if (terms.delay_s) std::snprintf(delay, sizeof delay, "%.9g ms", *terms.delay_s * 1000);
  std::snprintf(most, sizeof most, "%.6g", terms.most_held * 100);
  return std::string("live, ") + delay + ", at most " + most + " % held";
}

void LiveFigures::add(int step, const LiveStep& live) {
  ++steps;
  if (live.source == LiveSource::kHeld) ++held;
  if (live.source == LiveSource::kLate) ++late;
  for (const LiveAnswer& answer : live.answers) {
    delays.push_back(step - answer.asked);
    answer_s.push_back(answer.answer_s);
  }
}

void LiveFigures::add(const LiveFigures& other) {
  steps += other.steps;
  held += other.held;
  late += other.late;
  delays.insert(delays.end(), other.delays.begin(), other.delays.end());
  answer_s.insert(answer_s.end(), other.answer_s.begin(), other.answer_s.end());
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto index = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
  return values[std::min(index, values.size() - 1)];
}

std::string to_text(const LiveFigures& figures) {
  if (figures.steps == 0) return "no control step was done";
  std::string text = percent_of(figures.held_share()) + " of " +
                     plural(figures.steps, "control step") + " had no action of the policy";
  if (figures.late > 0)
    text += ", " + plural(figures.late, "step") + " one that came after its time";
  if (figures.delays.empty()) return text + "; no answer came in time";
  const std::vector<double> delays(figures.delays.begin(), figures.delays.end());
  const auto at = [&](double share) {
    return plural(static_cast<std::int64_t>(percentile(delays, share)), "control step") + " (" +
           milliseconds(percentile(figures.answer_s, share)) + ")";
  };
  return text + "; " + plural(static_cast<std::int64_t>(delays.size()), "answer") +
         " took effect after " + at(0.5) + " at the median, " + at(0.99) +
         " at the 99th percentile";
}

std::unique_ptr<Policy> make_live(std::unique_ptr<Policy> inner, const LiveTerms& terms) {
  return std::make_unique<LivePolicy>(std::move(inner), nullptr, terms);
}

std::unique_ptr<Policy> make_live(std::unique_ptr<Answerer> recorded) {
  return std::make_unique<LivePolicy>(nullptr, std::move(recorded), LiveTerms{});
}

}  // namespace probe::policy
