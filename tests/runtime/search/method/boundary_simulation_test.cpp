// Boundaries of made-up policies whose tolerance is known: how near, how sure, at what cost.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "runtime/search/method/boundary.h"
#include "tests/runtime/search/method/fake_policy.h"

namespace probe::search {
namespace {

constexpr int kLevels = 41;
constexpr int kSearches = 200;

// Success at a place on the axis, 0..1, and where it has fallen to half.
struct FakeAxis {
  std::function<double(double)> success;
  double tolerance = 0;
};

double normal(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

FakeAxis with_tolerance(std::function<double(double)> success) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (success(middle) > success(0) / 2 ? low : high) = middle;
  }
  return {std::move(success), high};
}

FakeAxis step(double at, double before = 0.95, double after = 0.02) {
  return with_tolerance([=](double x) { return x < at ? before : after; });
}

// Every start breaks somewhere else, normally distributed around `at`.
FakeAxis starts_around(double at, double spread, double before = 0.95) {
  return with_tolerance([=](double x) { return before * normal((at - x) / spread); });
}

// So many starts, each of which breaks at a place of its own; tried at random.
FakeAxis some_starts(int count, double at, double spread, Draws& draws) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) {
    double sum = 0;  // of twelve: nearly normal
    for (int j = 0; j < 12; ++j) sum += draws.uniform();
    places.push_back(at + spread * (sum - 6));
  }
  return with_tolerance([=](double x) {
    const auto beyond =
        std::count_if(places.begin(), places.end(), [=](double p) { return x < p; });
    return static_cast<double>(beyond) / count;
  });
}

struct Figures {
  std::array<int, 8> ends{};  // by status
  int near = 0, covered = 0;
  std::vector<int> trials;
  int of(BoundaryStatus status) const { return ends[static_cast<std::size_t>(status)]; }
};

Figures simulate(const std::string& what, int searches, BoundaryOptions options,
                 const std::function<FakeAxis(Draws&)>& draw) {
  Figures figures;
  const double axis = options.levels - 1;
  for (int i = 0; i < searches; ++i) {
    options.seed = static_cast<std::uint64_t>(i);
    Draws draws(options.seed, what);
    const FakeAxis fake = draw(draws);
    Boundary method(options);
    drive(
        method, [&](int level) { return 1 - fake.success(level / axis); }, options.seed, what);
    const BoundaryFinding found = method.finding();
    ++figures.ends[static_cast<std::size_t>(found.status)];
    figures.trials.push_back(found.trials);
    if (found.status != BoundaryStatus::kFound) continue;
    figures.near += std::abs(found.threshold / axis - fake.tolerance) <= options.error ? 1 : 0;
    figures.covered +=
        found.low / axis <= fake.tolerance && fake.tolerance <= found.high / axis ? 1 : 0;
  }
  std::sort(figures.trials.begin(), figures.trials.end());
  const auto share = [&](int count) { return 100.0 * count / searches; };
  const int found = figures.of(BoundaryStatus::kFound);
  MESSAGE(what << ": found " << share(found) << " %, within 5 % of the axis " << share(figures.near)
               << " %, interval covers " << 100.0 * figures.covered / std::max(found, 1)
               << " % of found; no fall " << share(figures.of(BoundaryStatus::kNoFall))
               << ", own value " << share(figures.of(BoundaryStatus::kFailsAtOwnValue))
               << ", not monotone " << share(figures.of(BoundaryStatus::kNotMonotone))
               << ", undecided " << share(figures.of(BoundaryStatus::kUndecided)) << " %; trials "
               << figures.trials[figures.trials.size() / 2] << ", 95 % below "
               << figures.trials[figures.trials.size() * 95 / 100]);
  return figures;
}

double between(Draws& draws, double low, double high) {
  return low + (high - low) * draws.uniform();
}

void check_found(const Figures& figures, int searches) {
  CHECK(figures.near >= 0.95 * searches);
  CHECK(figures.covered >= 0.93 * figures.of(BoundaryStatus::kFound));
}

}  // namespace

TEST_CASE("steps are found within 5 % of the axis in 95 % of 200 searches, near the ends, too") {
  const BoundaryOptions options{.levels = kLevels};
  check_found(
      simulate("steps", kSearches, options, [](Draws& d) { return step(between(d, 0.05, 0.95)); }),
      kSearches);
  check_found(
      simulate("steps by the own value and by the end", kSearches, options,
               [](Draws& d) {
                 return step(d.uniform() < 0.5 ? between(d, 0.01, 0.05) : between(d, 0.95, 0.99));
               }),
      kSearches);
  check_found(simulate("steps from 0.6 to 0.1", kSearches, options,
                       [](Draws& d) { return step(between(d, 0.1, 0.9), 0.6, 0.1); }),
              kSearches);
}

TEST_CASE("slopes are found within 5 % of the axis in 95 % of 200 searches") {
  check_found(simulate("starts that differ, sd 0.05", kSearches, {.levels = kLevels},
                       [](Draws& d) { return starts_around(between(d, 0.1, 0.9), 0.05); }),
              kSearches);
  check_found(simulate("starts that differ, sd 0.1", kSearches, {.levels = kLevels, .budget = 600},
                       [](Draws& d) { return starts_around(between(d, 0.1, 0.9), 0.1, 0.9); }),
              kSearches);
  check_found(
      simulate("24 starts that differ, sd 0.1", kSearches, {.levels = kLevels, .budget = 600},
               [](Draws& d) { return some_starts(24, between(d, 0.2, 0.8), 0.1, d); }),
      kSearches);
}

TEST_CASE("a shallow slope takes more trials, and a small budget says how many about") {
  const auto shallow = [](Draws& d) { return starts_around(between(d, 0.2, 0.8), 0.2, 0.9); };
  check_found(
      simulate("starts that differ, sd 0.2", 60, {.levels = kLevels, .budget = 1500}, shallow), 60);
  std::vector<int> needed;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Draws draws(seed, "small budget");
    const FakeAxis fake = shallow(draws);
    Boundary method({.levels = kLevels, .seed = seed, .budget = 160});
    drive(
        method, [&](int level) { return 1 - fake.success(level / (kLevels - 1.0)); }, seed);
    if (const auto budget = method.finding().budget_needed) needed.push_back(*budget);
  }
  REQUIRE(needed.size() > 30);
  std::sort(needed.begin(), needed.end());
  MESSAGE("with a budget of 160, "
          << needed.size() << " of 60 undecided; budget said: median " << needed[needed.size() / 2]
          << ", " << needed[needed.size() / 10] << " to " << needed[needed.size() * 9 / 10]
          << " in 80 %");
}

TEST_CASE("what has no tolerance is not given one") {
  const int searches = 100;
  const BoundaryOptions options{.levels = kLevels};
  const auto flat = [](double rate) {
    return [=](Draws&) { return FakeAxis{[=](double) { return rate; }, 2}; };
  };
  CHECK(simulate("always succeeds", searches, options, flat(1)).of(BoundaryStatus::kNoFall) == 100);
  CHECK(
      simulate("never succeeds", searches, options, flat(0)).of(BoundaryStatus::kFailsAtOwnValue) ==
      100);
  CHECK(simulate("succeeds at 0.6", searches, options, flat(0.6)).of(BoundaryStatus::kFound) <= 5);
  CHECK(simulate("falls from 0.9 to 0.63", searches, options, [](Draws& d) {
          return step(between(d, 0.3, 0.7), 0.9, 0.63);
        }).of(BoundaryStatus::kFound) <= 5);
  const auto band = [](double width) {
    return [=](Draws& d) {
      const double at = between(d, 0.1, 0.85 - width);
      return FakeAxis{[=](double x) { return x > at && x < at + width ? 0.05 : 0.95; }, 2};
    };
  };
  const Figures wide = simulate("fails in a band of 20 %", searches, options, band(0.2));
  CHECK(wide.of(BoundaryStatus::kNotMonotone) >= 95);
  CHECK(wide.of(BoundaryStatus::kFound) == 0);
  const Figures narrow = simulate("fails in a band of 10 %", searches, options, band(0.1));
  CHECK(narrow.of(BoundaryStatus::kNotMonotone) >= 60);
  CHECK(narrow.of(BoundaryStatus::kFound) == 0);
}

// Of 5,000 trials, which is also what it takes to resume them.
TEST_CASE("what to choose 5,000 trials costs is printed") {
  Boundary method({.levels = 201, .error = 1e-4, .budget = 5000});
  const std::clock_t begun = std::clock();
  int asks = 0;
  Draws draws(1, "policy");
  std::vector<Outcome> outcomes;
  while (!method.done()) {
    ++asks;
    outcomes.clear();
    for (const int level : method.ask()) {
      const bool failed = draws.uniform() < 0.1 + 0.7 * level / 200.0;
      outcomes.push_back(failed ? Outcome::kFailed : Outcome::kSucceeded);
    }
    method.tell(outcomes);
  }
  const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  const int trials = method.finding().trials;
  CHECK(trials > 4000);
  MESSAGE("boundary: " << trials << " trials chosen in " << seconds << " s of CPU, "
                       << 1e3 * seconds / trials << " ms a trial");
}

}  // namespace probe::search
