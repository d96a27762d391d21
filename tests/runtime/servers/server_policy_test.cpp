// What is left of an answer when the instruction changes.
#include "runtime/servers/server_policy.h"

#include <doctest/doctest.h>

#include "runtime/servers/profile_library.h"

namespace probe::servers {
namespace {

// Answers three actions, which count from ten times the number of the question, in parts of a metre
// that a step may shift by.
constexpr double kPart = 1.0 / 64;
class Thrice final : public Transport {
 public:
  explicit Thrice(std::vector<std::string>& asked) : asked_(asked) {}
  Status open(const Deadlines&) override { return {}; }
  void close() override {}
  Result<std::vector<RawAction>> ask(const Request& request, const Deadlines&) override {
    asked_.push_back(request.prompt);
    std::vector<RawAction> actions(3, RawAction(7));
    for (std::size_t i = 0; i < actions.size(); ++i)
      actions[i][0] = kPart * (10 * static_cast<double>(asked_.size()) + static_cast<double>(i));
    return actions;
  }

 private:
  std::vector<std::string>& asked_;
};

// Answers with the next of some numbers for the gripper.
class Grips final : public Transport {
 public:
  explicit Grips(std::vector<double> numbers) : numbers_(std::move(numbers)) {}
  Status open(const Deadlines&) override { return {}; }
  void close() override {}
  Result<std::vector<RawAction>> ask(const Request&, const Deadlines&) override {
    RawAction action(7);
    action[6] = numbers_[asked_++ % numbers_.size()];
    return std::vector<RawAction>{action};
  }

 private:
  std::vector<double> numbers_;
  std::size_t asked_ = 0;
};

}  // namespace

TEST_CASE("what was answered to another instruction is not done under this one") {
  std::vector<std::string> asked;
  auto profile = find_profile("simpler_shim");
  REQUIRE_MESSAGE(profile.ok(), to_text(profile.failure()));
  profile->chunk_length = Profile{}.chunk_length;
  profile->chunk_use = Profile{}.chunk_use;
  ServerPolicy policy(*profile, "here", std::make_unique<Thrice>(asked), nullptr);
  const auto begun = policy.begin({});
  REQUIRE_MESSAGE(begun.ok(), to_text(begun.failure()));
  const std::vector<std::uint8_t> picture(8 * 6 * 3, 7);
  const auto act = [&](std::string_view prompt) {
    policy::Observation seen;
    seen.image = {8, 6, picture};
    seen.prompt = prompt;
    const auto action = policy.act(seen);
    REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
    return (*action)[0] / kPart;
  };
  CHECK(act("open it") == 10);
  CHECK(act("open it") == 11);
  CHECK(act("put it in") == 20);
  CHECK(act("put it in") == 21);
  CHECK(act("put it in") == 22);
  CHECK(act("put it in") == 30);
  CHECK(asked == std::vector<std::string>{"open it", "put it in", "put it in"});
}

TEST_CASE("a switch of the gripper is held for its steps, and another instruction begins anew") {
  const std::vector<double> answers = {1, 1, -1, -1, -1, 1, 1, 1, -1, -1};
  const std::vector<std::uint8_t> picture(8 * 6 * 3, 7);
  const auto gripper = [&](StickyRule rule) {
    auto profile = find_profile("simpler_shim");
    REQUIRE_MESSAGE(profile.ok(), to_text(profile.failure()));
    profile->action_sticky = rule;
    profile->action_sticky_steps = 3;
    ServerPolicy policy(*profile, "here", std::make_unique<Grips>(answers), nullptr);
    REQUIRE(policy.begin({}).ok());
    std::vector<double> said;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      policy::Observation seen;
      seen.image = {8, 6, picture};
      seen.prompt = i < 8 ? "open it" : "put it in";
      const auto action = policy.act(seen);
      REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
      said.push_back((*action)[6]);
    }
    return said;
  };
  const std::vector<double> plain = gripper(StickyRule::kNone);
  CHECK(plain[0] == -plain[2]);
  StickyGripper rule(StickyRule::kLast, 3);
  std::vector<double> held;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (i == 8) rule.reset();
    held.push_back(rule.step((plain[i] + 1) / 2));
  }
  CHECK(gripper(StickyRule::kLast) == held);
  CHECK(held[8] == 0);  // the first answer to an instruction is no change
  CHECK(held[2] == held[4]);
}

}  // namespace probe::servers
