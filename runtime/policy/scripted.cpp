// Null, random, replayed and noisy policies, and one that may have nothing to do.
#include "runtime/policy/scripted.h"

#include <utility>
#include <vector>

namespace probe::policy {
namespace {

constexpr Action kStill{0, 0, 0, 0, 0, 0, 1};

class NullPolicy final : public Policy {
 public:
  Status begin(const EpisodeStart&) override { return {}; }
  Result<Action> act(const Observation&) override { return kStill; }
};

class RandomPolicy final : public Policy {
 public:
  Status begin(const EpisodeStart& start) override {
    draws_ = Draws(start.draw_seed);
    return {};
  }
  Result<Action> act(const Observation&) override {
    Action action{};
    for (std::size_t i = 0; i < robot::kActionGripper; ++i) {
      const double most = i < robot::kActionTurn ? 0.02 : 0.1;  // m, rad
      action[i] = most * (2 * draws_.uniform() - 1);
    }
    action[robot::kActionGripper] = draws_.uniform() < 0.5 ? -1 : 1;
    return action;
  }

 private:
  Draws draws_{0};
};

class RecordedPolicy final : public Policy {
 public:
  RecordedPolicy(std::string dir, RecordedActions recorded)
      : dir_(std::move(dir)), recorded_(std::move(recorded)) {}

  Status begin(const EpisodeStart& start) override {
    if (!recorded_) {
      return Failure{Fault::kPolicy, "nothing here can read stored episodes", dir_};
    }
    PROBE_ASSIGN(actions_, recorded_(dir_, start.task, start.index, start.seed));
    return {};
  }
  Result<Action> act(const Observation& observation) override {
    const auto step = static_cast<std::size_t>(observation.step);
    if (step >= actions_.size()) {
      return Failure{Fault::kPolicy,
                     "the stored episode has " + std::to_string(actions_.size()) +
                         " actions, this one asks for another",
                     dir_};
    }
    return actions_[step];
  }

 private:
  std::string dir_;
  RecordedActions recorded_;
  std::vector<Action> actions_;
};

class StillWithoutPolicy final : public Policy {
 public:
  StillWithoutPolicy(int role, std::unique_ptr<Policy> inner)
      : role_(role), inner_(std::move(inner)) {}

  Status begin(const EpisodeStart& start) override { return inner_->begin(start); }
  Result<Action> act(const Observation& observation) override {
    const Privileged* view = observation.privileged;
    // A solution in skills may be about other things than objects: the inner one knows.
    if (view != nullptr && view->object_of(role_) < 0 && view->solution.empty()) return kStill;
    return inner_->act(observation);
  }
  void end(const EpisodeEnd& end) override { inner_->end(end); }
  std::optional<std::string> remark() const override { return inner_->remark(); }

 private:
  int role_;
  std::unique_ptr<Policy> inner_;
};

class NoisyPolicy final : public Policy {
 public:
  NoisyPolicy(std::unique_ptr<Policy> inner, double sigma, double share)
      : inner_(std::move(inner)), sigma_(sigma), share_(share) {}

  Status begin(const EpisodeStart& start) override {
    draws_ = Draws(start.draw_seed);
    return inner_->begin(start);
  }
  Result<Action> act(const Observation& observation) override {
    PROBE_ASSIGN(Action action, inner_->act(observation));
    if (share_ < 1 && draws_.uniform() >= share_) return action;
    for (std::size_t i = 0; i < robot::kActionGripper; ++i) {
      action[i] += (i < robot::kActionTurn ? sigma_ : 2 * sigma_) * normal();  // m, rad
    }
    return action;
  }
  void end(const EpisodeEnd& end) override { inner_->end(end); }
  std::optional<std::string> remark() const override { return inner_->remark(); }

 private:
  // Twelve uniforms make a normal to within what a wrist can tell, without the C library's log and
  // sine, whose last bits depend on the CPU.
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += draws_.uniform();
    return sum;
  }

  std::unique_ptr<Policy> inner_;
  double sigma_, share_;  // of the steps that are noisy
  Draws draws_{0};
};

constexpr double kPushedShare = 1.0 / 8;

// What it was given, step by step.
class SayingPolicy final : public Policy {
 public:
  explicit SayingPolicy(std::span<const Action> actions) : actions_(actions) {}
  Status begin(const EpisodeStart& /*start*/) override { return {}; }
  Result<Action> act(const Observation& observation) override {
    return actions_[static_cast<std::size_t>(observation.step)];
  }

 private:
  std::span<const Action> actions_;
};

}  // namespace

std::unique_ptr<Policy> make_null() { return std::make_unique<NullPolicy>(); }

std::unique_ptr<Policy> make_random() { return std::make_unique<RandomPolicy>(); }

std::unique_ptr<Policy> make_recorded(std::string dir, RecordedActions recorded) {
  return std::make_unique<RecordedPolicy>(std::move(dir), std::move(recorded));
}

std::unique_ptr<Policy> make_still_without(int role, std::unique_ptr<Policy> inner) {
  return std::make_unique<StillWithoutPolicy>(role, std::move(inner));
}

std::unique_ptr<Policy> make_noisy(std::unique_ptr<Policy> inner, double sigma) {
  return std::make_unique<NoisyPolicy>(std::move(inner), sigma, 1);
}

std::unique_ptr<Policy> make_pushed(std::unique_ptr<Policy> inner, double sigma) {
  return std::make_unique<NoisyPolicy>(std::move(inner), sigma, kPushedShare);
}

std::vector<int> pushed_steps(std::uint64_t draw_seed, std::span<const Action> actions) {
  // The same policy about the same number of actions, of which it is seen whether it lets them be.
  NoisyPolicy again(std::make_unique<SayingPolicy>(actions), 1, kPushedShare);
  EpisodeStart start;
  start.draw_seed = draw_seed;
  std::vector<int> pushed;
  if (!again.begin(start)) return pushed;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    Observation seen;
    seen.step = static_cast<int>(i);
    const Result<Action> said = again.act(seen);
    if (said && *said != actions[i]) pushed.push_back(seen.step);
  }
  return pushed;
}

}  // namespace probe::policy
