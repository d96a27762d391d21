// Policies that look at nothing: null, random, and the actions of a stored episode.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/policy/policy.h"

namespace probe::policy {

// Stays where it first is with an open gripper.
std::unique_ptr<Policy> make_null();

// Each number uniform: translations within 2 cm, rotation vector within 0.1 rad a component,
// gripper open or closed. Of an arm that is told its joints: steps within 0.1 rad, or 2 cm where
// the joint slides; positions as far from where it is.
std::unique_ptr<Policy> make_random();

// Gives the actions of a stored episode of the run in `dir`.
struct RecordedEpisode {
  std::vector<Action> actions;  // a step each
  std::string joint_law;        // whose numbers they are; empty: a tool's
};
using RecordedActions = std::function<Result<RecordedEpisode>(
    const std::string& dir, std::string_view task, int episode, int seed)>;

// The recorded actions of the episode of the same task, index and seed in `dir`; fails past their
// end.
std::unique_ptr<Policy> make_recorded(std::string dir, RecordedActions recorded);

// `inner` where the episode has role `role` (as Privileged::object_of() counts), a part among its
// distractors or a solution; else stays where it is.
std::unique_ptr<Policy> make_still_without(int role, std::unique_ptr<Policy> inner);

// `inner` with normal noise on the first six numbers: standard deviation `sigma` metres on each
// translation, 2 `sigma` rad on each component of the rotation vector (10 mm and 1.1 degrees for
// 0.01). The gripper stays as it is. On joints as on those: `sigma` metres where the joint slides,
// else 2 `sigma` rad.
std::unique_ptr<Policy> make_noisy(std::unique_ptr<Policy> inner, double sigma);

// `inner`, pushed off its way now and then: in one step of eight, drawn, the noise of make_noisy is
// added, and in the others `inner` finds back. What it shows is how one recovers.
std::unique_ptr<Policy> make_pushed(std::unique_ptr<Policy> inner, double sigma);

// In which steps of an episode make_pushed pushed, ascending: the draws depend on `draw_seed` and
// the number of steps alone. `actions` are what was done, pushes included.
std::vector<int> pushed_steps(std::uint64_t draw_seed, std::span<const Action> actions);

}  // namespace probe::policy
