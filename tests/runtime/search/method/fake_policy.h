// Policies with known weak spots, and how a method is driven against one: what the tests of
// searches draw from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/search/method/draws.h"
#include "runtime/search/method/outcome.h"

namespace probe::search {

// A method driven to its end by a policy whose failure rate at a trial is `failure(trial)`; a
// negative one is an unfair point.
template <typename Method, typename Failure>
void drive(Method& method, const Failure& failure, std::uint64_t seed,
           const std::string& name = "policy") {
  Draws draws(seed, name);
  std::vector<Outcome> outcomes;
  while (!method.done()) {
    outcomes.clear();
    for (const auto& trial : method.ask()) {
      const double rate = failure(trial);
      const bool failed = draws.uniform() < rate;
      outcomes.push_back(rate < 0 ? Outcome::kLeftOut
                         : failed ? Outcome::kFailed
                                  : Outcome::kSucceeded);
    }
    method.tell(outcomes);
  }
}

}  // namespace probe::search
