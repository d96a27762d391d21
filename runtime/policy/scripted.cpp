// Null, random, replayed and noisy policies, and one that may have nothing to do.
#include "runtime/policy/scripted.h"

#include <optional>
#include <utility>
#include <vector>

#include "runtime/robot/action_space.h"

namespace probe::policy {
namespace {

// What an episode's actions are: those of a tool where nobody says which robot acts.
robot::ActionSpace space_of(const EpisodeStart& start) {
  return start.robot == nullptr ? robot::ActionSpace{} : robot::action_space_of(*start.robot);
}

// Asks the arm to stay where it is first seen, with an open gripper.
class StandsStill {
 public:
  void begin(const EpisodeStart& start) {
    space_ = space_of(start);
    stay_.reset();
  }
  const Action& act(const Observation& observation) {
    if (!stay_) stay_ = robot::standstill(space_, observation.proprioception.joints, 1);
    return *stay_;
  }

 private:
  robot::ActionSpace space_;
  std::optional<Action> stay_;
};

class NullPolicy final : public Policy {
 public:
  Status begin(const EpisodeStart& start) override {
    stands_.begin(start);
    return {};
  }
  Result<Action> act(const Observation& observation) override { return stands_.act(observation); }

 private:
  StandsStill stands_;
};

class RandomPolicy final : public Policy {
 public:
  Status begin(const EpisodeStart& start) override {
    draws_ = Draws(start.draw_seed);
    space_ = space_of(start);
    return {};
  }
  Result<Action> act(const Observation& observation) override {
    Action action = robot::standstill(space_, observation.proprioception.joints, 1);
    for (std::size_t i = 0; i + 1 < action.size(); ++i) {
      const double most = space_.is_length(i) ? 0.02 : 0.1;  // m, rad
      action[i] += most * (2 * draws_.uniform() - 1);
    }
    action.gripper() = draws_.uniform() < 0.5 ? -1 : 1;
    return action;
  }

 private:
  robot::ActionSpace space_;
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
    PROBE_ASSIGN(RecordedEpisode episode, recorded_(dir_, start.task, start.index, start.seed));
    if (start.robot != nullptr) {
      const bool is_of_joints = robot::action_space_of(*start.robot).is_of_joints();
      const std::string law = is_of_joints ? std::string(robot::row_of(start.robot->law).word) : "";
      const auto called = [](const std::string& of) {
        return of.empty() ? std::string("of a tool") : "of joints, as `" + of + "` takes them";
      };
      if (law != episode.joint_law) {
        return Failure{Fault::kPolicy,
                       "the stored episode's actions are " + called(episode.joint_law) +
                           ", this robot's " + called(law),
                       dir_};
      }
    }
    actions_ = std::move(episode.actions);
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

  Status begin(const EpisodeStart& start) override {
    stands_.begin(start);
    return inner_->begin(start);
  }
  Result<Action> act(const Observation& observation) override {
    const Privileged* view = observation.privileged;
    // A solution in skills may be about other things than objects: the inner one knows.
    if (view != nullptr && view->object_of(role_) < 0 && view->solution.empty() &&
        view->wrong_fixtures.empty())
      return stands_.act(observation);
    return inner_->act(observation);
  }
  void end(const EpisodeEnd& end) override { inner_->end(end); }
  std::optional<std::string> remark() const override { return inner_->remark(); }

 private:
  int role_;
  std::unique_ptr<Policy> inner_;
  StandsStill stands_;
};

class NoisyPolicy final : public Policy {
 public:
  NoisyPolicy(std::unique_ptr<Policy> inner, double sigma, double share)
      : inner_(std::move(inner)), sigma_(sigma), share_(share) {}

  Status begin(const EpisodeStart& start) override {
    draws_ = Draws(start.draw_seed);
    space_ = space_of(start);
    return inner_->begin(start);
  }
  Result<Action> act(const Observation& observation) override {
    PROBE_ASSIGN(Action action, inner_->act(observation));
    if (share_ < 1 && draws_.uniform() >= share_) return action;
    for (std::size_t i = 0; i + 1 < action.size(); ++i)
      action[i] += (space_.is_length(i) ? sigma_ : 2 * sigma_) * normal();  // m, rad
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
  robot::ActionSpace space_;
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
