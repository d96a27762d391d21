#include "runtime/search/method/boundary.h"

#include <doctest/doctest.h>

#include <span>
#include <vector>

#include "runtime/search/method/monotone.h"
#include "tests/runtime/search/method/fake_policy.h"

namespace probe::search {
namespace {

BoundaryFinding boundary_of(BoundaryOptions options, const auto& failure) {
  Boundary method(options);
  drive(method, failure, options.seed);
  return method.finding();
}

}  // namespace

TEST_CASE("a policy that fails from level 13 on has its tolerance just before") {
  const auto found = boundary_of({.levels = 41}, [](int level) { return level >= 13 ? 1.0 : 0.0; });
  CHECK(found.status == BoundaryStatus::kFound);
  CHECK(found.threshold > 12);
  CHECK(found.threshold < 13);
  CHECK(found.low <= found.threshold);
  CHECK(found.threshold <= found.high);
  CHECK(found.own.k == found.own.n);
  CHECK(found.trials < 100);
}

TEST_CASE("half is half of what is done at the own value, not half of all trials") {
  // 0.6 falls to 0.4 half-way, which is not yet half, and to 0.1 at level 30.
  const auto found = boundary_of({.levels = 41, .budget = 1000}, [](int level) {
    return level < 20 ? 0.4 : level < 30 ? 0.6 : 0.9;
  });
  CHECK(found.status == BoundaryStatus::kFound);
  CHECK(found.threshold > 27);
  CHECK(found.threshold < 31);
}

TEST_CASE(
    "a policy that never succeeds is said to fail at its own value, one that always does not to "
    "fall") {
  const auto never = boundary_of({.levels = 41}, [](int) { return 1.0; });
  CHECK(never.status == BoundaryStatus::kFailsAtOwnValue);
  CHECK(never.trials <= 24);
  const auto always = boundary_of({.levels = 41}, [](int) { return 0.0; });
  CHECK(always.status == BoundaryStatus::kNoFall);
  CHECK(always.no_fall > 0.95);
  CHECK(always.last_level == 40);
}

TEST_CASE("two levels are an axis, and half a level the least error") {
  const auto found = boundary_of({.levels = 2}, [](int level) { return level == 1 ? 1.0 : 0.0; });
  CHECK(found.status == BoundaryStatus::kFound);
  CHECK(found.low >= 0);
  CHECK(found.high <= 1);
}

TEST_CASE("a budget that is too small is said, with one that would do") {
  const auto slope = [](int level) { return 0.1 + 0.8 * level / 40.0; };
  const auto found = boundary_of({.levels = 41, .budget = 80}, slope);
  CHECK(found.status == BoundaryStatus::kUndecided);
  CHECK(found.trials <= 80);
  REQUIRE(found.budget_needed);
  CHECK(*found.budget_needed > 80);
  CHECK(boundary_of({.levels = 41, .budget = 4}, slope).status == BoundaryStatus::kUndecided);
}

TEST_CASE("no budget is exceeded, whatever the own rate and wherever success falls or comes back") {
  for (const int budget : {4, 8, 16, 17, 80, 100}) {
    for (const double own : {0.3, 0.95}) {
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const BoundaryOptions options{.levels = 41, .seed = seed, .budget = budget};
        CAPTURE(budget);
        CAPTURE(own);
        const auto falls = [=](int level) { return 1 - own * (1 - 0.8 * level / 40.0); };
        const auto comes_back = [=](int level) {
          return level / 8 % 2 == 1 ? 1 - own / 2 : 1 - own;
        };
        const auto ends = [=](int level) { return level > 24 ? -1.0 : 1 - own; };
        CHECK(boundary_of(options, falls).trials <= budget);
        CHECK(boundary_of(options, comes_back).trials <= budget);
        CHECK(boundary_of(options, ends).trials <= budget);
      }
    }
  }
}

TEST_CASE("an unfair end is left out and counted, and the last fair level is told") {
  const auto always =
      boundary_of({.levels = 41}, [](int level) { return level > 24 ? -1.0 : 0.0; });
  CHECK(always.status == BoundaryStatus::kNoFall);
  CHECK(always.last_level >= 22);
  CHECK(always.last_level <= 24);
  CHECK(always.left_out > 0);
  CHECK(always.left_out < 40);
  const auto found = boundary_of({.levels = 41}, [](int level) {
    return level > 24 ? -1.0 : level >= 13 ? 1.0 : 0.0;
  });
  CHECK(found.status == BoundaryStatus::kFound);
  CHECK(found.threshold < 13);
  CHECK(boundary_of({.levels = 41}, [](int level) { return level == 0 ? -1.0 : 0.0; }).status ==
        BoundaryStatus::kLeftOut);
  const auto nothing =
      boundary_of({.levels = 41}, [](int level) { return level > 0 ? -1.0 : 0.0; });
  CHECK(nothing.status == BoundaryStatus::kLeftOut);
  CHECK(nothing.last_level == 0);
}

TEST_CASE("a policy that succeeds again further out has no tolerance") {
  const auto found =
      boundary_of({.levels = 41}, [](int level) { return level > 10 && level < 25 ? 1.0 : 0.0; });
  CHECK(found.status == BoundaryStatus::kNotMonotone);
  CHECK(found.monotone_p < 0.005);
}

TEST_CASE("success that falls all along is monotone, one that comes back is not") {
  const std::vector<stats::Count> falls = {{20, 20}, {0, 0}, {18, 20}, {11, 20}, {3, 20}, {0, 20}};
  const std::vector<stats::Count> comes_back = {{20, 20}, {2, 20}, {0, 0}, {18, 20}};
  CHECK(monotone_p(falls, 1) == 1);
  CHECK(monotone_p(comes_back, 1) == doctest::Approx(0.001));
  CHECK(monotone_p({}, 1) == 1);
}

TEST_CASE("a boundary that is told the same asks the same, batch by batch") {
  Boundary a({.levels = 41, .seed = 3}), b({.levels = 41, .seed = 3});
  Draws draws(3, "policy");
  while (!a.done()) {
    const std::vector<int> asked(a.ask().begin(), a.ask().end());
    REQUIRE(asked == std::vector<int>(b.ask().begin(), b.ask().end()));
    REQUIRE(!asked.empty());
    REQUIRE(asked.size() <= 8);
    std::vector<Outcome> outcomes;
    for (const int level : asked) {
      outcomes.push_back(draws.uniform() < 0.2 + 0.015 * level ? Outcome::kFailed
                                                               : Outcome::kSucceeded);
    }
    a.tell(outcomes);
    b.tell(outcomes);
  }
  CHECK(b.done());
  CHECK(a.finding().threshold == b.finding().threshold);
}

TEST_CASE("a boundary is resumed from what is stored, in the middle of a batch, too") {
  const auto failure = [](int level) { return 0.2 + 0.015 * level; };
  Boundary whole({.levels = 41, .seed = 3});
  Draws draws(3, "policy");
  std::vector<Outcome> stored;
  while (!whole.done()) {
    const std::size_t before = stored.size();
    for (const int level : whole.ask()) {
      stored.push_back(draws.uniform() < failure(level) ? Outcome::kFailed : Outcome::kSucceeded);
    }
    whole.tell(std::span(stored).subspan(before));
  }
  Boundary again({.levels = 41, .seed = 3});
  const std::size_t told = resume(again, std::span(stored).first(45));
  CHECK(told <= 45);
  CHECK(45 - told < again.ask().size());
  CHECK(resume(again, std::span(stored).subspan(told)) == stored.size() - told);
  CHECK(again.done());
  CHECK(again.finding().threshold == whole.finding().threshold);
  CHECK(again.finding().trials == whole.finding().trials);
}

}  // namespace probe::search
