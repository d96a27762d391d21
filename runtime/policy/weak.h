// A policy with a known weak spot, for whoever tests what finds such spots: another policy that
// does nothing where the spot is met.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"

namespace probe::policy {

// What is held against a number: the light there is, how far the first camera stands from where the
// task's baseline has it (m), how many more objects lie around than there, whether other words are
// said (1) or the same (0).
enum class WeakTo : std::uint8_t { kAmbient, kPower, kCamera, kClutter, kReworded };

struct WeakSpot {
  struct Term {
    WeakTo to = WeakTo::kAmbient;
    bool below = false;  // weak below the number, else at it and above
    double bound = 0;
    double width = 0;  // how far from the bound the chance to fail falls to 0.27; 0: a step
  };
  std::vector<Term> terms;  // all of them have to be met
};

// "ambient<0.12", "camera>=3cm", "clutter>=2+reworded", "power<0.5~0.1". Fails (kUsage, where =
// --policy) on anything else.
Result<WeakSpot> read_weak_spot(std::string_view text);

// The probability that an episode meets the spot.
double chance_of(const WeakSpot& spot, const Surroundings& surroundings);

// `inner`, or an arm that stands still in episodes that meet the spot: drawn where it is no step.
std::unique_ptr<Policy> make_weak(WeakSpot spot, std::unique_ptr<Policy> inner);

}  // namespace probe::policy
