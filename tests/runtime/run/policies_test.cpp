// Names of policies, and what the simple ones answer.
#include "runtime/run/policies.h"

#include <doctest/doctest.h>

#include <cmath>

#include "runtime/policy/scripted.h"

namespace probe::run {
using namespace probe::policy;
namespace {

EpisodeStart start_with(std::uint64_t draw_seed) {
  EpisodeStart start;
  start.task = "carrot_on_plate";
  start.draw_seed = draw_seed;
  return start;
}

TEST_CASE("a misspelt policy names the nearest and the known ones") {
  const auto made = make_policy("exprt");
  REQUIRE_FALSE(made.ok());
  CHECK(made.failure().code == Fault::kUsage);
  CHECK(made.failure().message.starts_with(
      "unknown policy `exprt`, did you mean `expert`?\nthe policies are:\n  expert "));
  CHECK_FALSE(made.failure().message.ends_with("\n"));
  CHECK(made.failure().message.find("noisy:SIGMA") != std::string::npos);
  CHECK(choose_policy("zzz").failure().message.find("did you mean") == std::string::npos);
}

TEST_CASE("arguments are asked for, and refused where there are none") {
  CHECK(make_policy("null:3").failure().message == "policy `null` takes no argument");
  CHECK(make_policy("noisy").failure().message == "policy `noisy` is written `noisy:SIGMA`");
  CHECK(make_policy("noisy:1cm").failure().message.find("found `1cm`") != std::string::npos);
  CHECK_FALSE(make_policy("noisy:nan").ok());
  CHECK_FALSE(make_policy("noisy:-1").ok());
  CHECK_FALSE(make_policy("").ok());
  CHECK(make_policy("openpi://localhost:8000").ok());  // it connects when an episode begins
  CHECK(make_policy("openpi:localhost").failure().message.find("//HOST:PORT") != std::string::npos);
}

TEST_CASE("policies say whether seeds matter") {
  CHECK_FALSE(choose_policy("null")->traits.draws);
  CHECK_FALSE(choose_policy("expert")->traits.draws);
  CHECK_FALSE(choose_policy("noisy:0")->traits.draws);
  CHECK(choose_policy("noisy:0.01")->traits.draws);
  CHECK(choose_policy("random")->traits.draws);
  CHECK(choose_policy("wrong")->traits.wants_distractor);
  CHECK_FALSE(choose_policy("expert")->traits.wants_distractor);
  CHECK(choose_policy("replay:runs/a:b")->traits.recorded);
  CHECK(policy_argument("replay:runs/a:b") == "runs/a:b");
}

TEST_CASE("random actions depend on the episode's seed and on nothing else") {
  auto a = make_policy("random").value();
  auto b = make_policy("random").value();
  REQUIRE(a->begin(start_with(7)).ok());
  REQUIRE(b->begin(start_with(99)).ok());
  const Action other = *b->act({});
  REQUIRE(b->begin(start_with(7)).ok());
  for (int step = 0; step < 50; ++step) {
    const Action action = *a->act({});
    CHECK(action == *b->act({}));
    if (step == 0) CHECK(action != other);
    for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(action[i]) <= 0.02);
    CHECK(std::abs(action[6]) == 1);
  }
}

TEST_CASE("the null policy holds still with an open gripper") {
  auto policy = make_policy("null").value();
  REQUIRE(policy->begin(start_with(0)).ok());
  CHECK(*policy->act({}) == Action{0, 0, 0, 0, 0, 0, 1});
}

TEST_CASE("who wants a distractor holds still where there is none") {
  auto policy = make_still_without(2, make_random());
  REQUIRE(policy->begin(start_with(0)).ok());
  Privileged view;
  view.objects.resize(2);
  Observation observation;
  observation.privileged = &view;
  CHECK(*policy->act(observation) == Action{0, 0, 0, 0, 0, 0, 1});
  view.objects.resize(3);
  CHECK(*policy->act(observation) != Action{0, 0, 0, 0, 0, 0, 1});
}

TEST_CASE("a replay gives the stored actions and fails past their end") {
  PolicyContext context;
  context.recorded_actions = [](const std::string& dir, std::string_view task, int,
                                int) -> Result<policy::RecordedEpisode> {
    if (dir != "runs/a") return Failure{Fault::kStore, "no run here", dir};
    CHECK(task == "carrot_on_plate");
    return policy::RecordedEpisode{{{1, 0, 0, 0, 0, 0, 0}, {2, 0, 0, 0, 0, 0, 0}}, ""};
  };
  auto policy = make_policy("replay:runs/a", context).value();
  REQUIRE(policy->begin(start_with(0)).ok());
  Observation observation;
  observation.step = 1;
  CHECK((*policy->act(observation))[0] == 2);
  observation.step = 2;
  CHECK(policy->act(observation).failure().message ==
        "the stored episode has 2 actions, this one asks for another");
  auto absent = make_policy("replay:runs/b", context).value();
  CHECK_FALSE(absent->begin(start_with(0)).ok());
}

TEST_CASE("noise has the stated spread and leaves the gripper alone") {
  auto policy = make_noisy(make_null(), 0.01);
  REQUIRE(policy->begin(start_with(3)).ok());
  double sum = 0, squares = 0;
  const int n = 3000;
  for (int i = 0; i < n; ++i) {
    const Action action = *policy->act({});
    CHECK(action[6] == 1);
    sum += action[0];
    squares += action[0] * action[0];
  }
  CHECK(std::abs(sum / n) < 0.001);
  CHECK(std::sqrt(squares / n) == doctest::Approx(0.01).epsilon(0.05));
}

}  // namespace
}  // namespace probe::run
