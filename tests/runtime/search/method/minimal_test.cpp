#include "runtime/search/method/minimal.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>

#include "tests/runtime/search/method/fake_policy.h"

namespace probe::search {
namespace {

constexpr AxisSet set_of(std::initializer_list<int> axes) {
  AxisSet set = 0;
  for (const int axis : axes) set |= AxisSet{1} << axis;
  return set;
}

// Fails exactly where all of `cause` is changed.
auto cause(AxisSet needed, double rate = 1, double otherwise = 0) {
  return [=](AxisSet set) { return (set & needed) == needed ? rate : otherwise; };
}

MinimalFinding minimal_of(int axes, const auto& failure, std::uint64_t seed = 1) {
  Minimal method({.axes = axes});
  drive(method, failure, seed);
  return method.finding();
}

}  // namespace

TEST_CASE("of eight changes the one, the pair or the three that break it are found, and no other") {
  for (const AxisSet needed : {set_of({0}), set_of({7}), set_of({2, 3}), set_of({0, 7}),
                               set_of({1, 4, 6}), set_of({0, 1, 2, 3, 4, 5, 6, 7})}) {
    const MinimalFinding found = minimal_of(8, cause(needed));
    CAPTURE(needed);
    CHECK(found.status == MinimalStatus::kFound);
    CHECK(found.set == needed);
    CHECK(found.doubtful == 0);
  }
}

TEST_CASE("of what is found every axis alone was put back, and passed") {
  const MinimalFinding found = minimal_of(8, cause(set_of({1, 4, 6}), 0.9, 0.1), 3);
  REQUIRE(found.set == set_of({1, 4, 6}));
  for (const int axis : {1, 4, 6}) {
    const auto without = std::find_if(found.tried.begin(), found.tried.end(), [&](const auto& one) {
      return one.set == (found.set & ~set_of({axis}));
    });
    REQUIRE(without != found.tried.end());
    CHECK(without->verdict == Verdict::kPasses);
    CHECK(without->failures.n > 0);
  }
}

TEST_CASE("a case that does not fail, a policy that fails unchanged and a single change are said") {
  CHECK(minimal_of(4, cause(set_of({0}), 0.1, 0.1)).status == MinimalStatus::kNotReliable);
  const MinimalFinding own = minimal_of(4, [](AxisSet) { return 1.0; });
  CHECK(own.status == MinimalStatus::kFailsAtOwnPoint);
  CHECK(own.set == 0);
  CHECK(minimal_of(1, cause(1)).set == 1);
}

TEST_CASE("of two causes one is found, whole") {
  const AxisSet one = set_of({0, 5}), other = set_of({2, 3});
  const MinimalFinding found = minimal_of(
      8, [&](AxisSet set) { return (set & one) == one || (set & other) == other ? 0.95 : 0.05; });
  CHECK((found.set == one || found.set == other));
}

TEST_CASE("sets that are unfair are left out, and an axis that needs one is doubtful") {
  // Axis 1 without axis 0 is not a fair point.
  const MinimalFinding found = minimal_of(4, [](AxisSet set) {
    if ((set & 3) == 2) return -1.0;
    return (set & 2) != 0 ? 1.0 : 0.0;
  });
  CHECK(found.status == MinimalStatus::kFound);
  CHECK(found.set == set_of({0, 1}));
  CHECK(found.doubtful == set_of({0}));
  CHECK(found.left_out > 0);
}

TEST_CASE("a rate between the two ends in unclear sets, and a small budget in what it has") {
  Minimal coin({.axes = 3, .test_budget = 20});
  drive(
      coin, [](AxisSet) { return 0.5; }, 1);
  CHECK(coin.finding().status == MinimalStatus::kNotReliable);
  Minimal poor({.axes = 8, .budget = 40});
  drive(poor, cause(set_of({1, 4, 6})), 1);
  CHECK(poor.finding().status == MinimalStatus::kBudgetSpent);
  CHECK((poor.finding().set & set_of({1, 4, 6})) == set_of({1, 4, 6}));
  CHECK(poor.finding().trials <= 40);
}

TEST_CASE(
    "a budget that ends before the case is known to fail names no set, one after it the case") {
  const auto spent = [](int budget) {
    Minimal method({.axes = 8, .budget = budget});
    drive(method, cause(set_of({1, 4, 6})), 1);
    CHECK(method.finding().status == MinimalStatus::kBudgetSpent);
    return method.finding().set;
  };
  CHECK(spent(4) == 0);
  CHECK(spent(8) == 255);  // before the own point is judged
}

TEST_CASE("a search for a minimal set that is told the same asks the same") {
  const auto failure = cause(set_of({1, 4}), 0.8, 0.2);
  Minimal a({.axes = 6}), b({.axes = 6});
  drive(a, failure, 9);
  drive(b, failure, 9);
  REQUIRE(a.finding().tried.size() == b.finding().tried.size());
  for (std::size_t i = 0; i < a.finding().tried.size(); ++i) {
    CHECK(a.finding().tried[i].set == b.finding().tried[i].set);
    CHECK(a.finding().tried[i].failures.n == b.finding().tried[i].failures.n);
  }
}

// Once well apart, once at the very rates that a set is told by.
TEST_CASE("minimal sets of a policy that errs are exact in 95 % of 400 searches") {
  struct Rates {
    double with, without;
  };
  for (const Rates rates : {Rates{0.9, 0.1}, Rates{0.7, 0.3}}) {
    int exact = 0, trials = 0;
    const int searches = 400;
    Draws draws(4, "causes");
    for (int i = 0; i < searches; ++i) {
      AxisSet needed = 0;
      while (std::popcount(needed) < 1 + i % 3) needed |= AxisSet{1} << draws.below(8);
      Minimal method({.axes = 8, .test_budget = 200, .budget = 4000});
      drive(method, cause(needed, rates.with, rates.without), static_cast<std::uint64_t>(i));
      const MinimalFinding& found = method.finding();
      exact += found.status == MinimalStatus::kFound && found.set == needed ? 1 : 0;
      trials += found.trials;
    }
    MESSAGE("fails at " << rates.with << " with the cause, at " << rates.without
                        << " without: minimal sets exact " << 100.0 * exact / searches << " %, "
                        << trials / searches << " trials a search");
    CHECK(exact >= 0.95 * searches);
  }
}

}  // namespace probe::search
