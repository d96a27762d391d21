// 4,000 made-up benchmark runs whose truth is known, for starts that were run and for those that
// were not: does each of the two questions err as seldom as it says, and cover as often?
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>

#include "runtime/stats/clustered.h"
#include "runtime/stats/here_and_anew.h"
#include "tests/runtime/stats/fake_benchmark.h"

namespace probe::stats {
namespace {

constexpr double kAlpha = 0.05;

struct Tally {
  std::map<std::string, Share> found;    // p at most 5 %
  std::map<std::string, Share> covered;  // the truth of the question

  void add(const std::string& what, const HereAndAnew& answers, double truth_here,
           double truth_anew) {
    const auto covers = [](const Interval& interval, double truth) {
      return interval.low <= truth && truth <= interval.high;
    };
    found[what + ", on these starts"].add(answers.here.p <= kAlpha);
    found[what + ", for starts never tried"].add(answers.anew.p <= kAlpha);
    covered[what + ", on these starts"].add(covers(answers.here.interval, truth_here));
    covered[what + ", for starts never tried"].add(covers(answers.anew.interval, truth_anew));
  }
};

std::uint32_t id(std::size_t i) { return static_cast<std::uint32_t>(i); }

// Policy 0 against policy 1.
void add_policies(const FakeRun& run, Tally& tally) {
  struct Scope {
    std::vector<PlacedPairs> pairs;
    double here = 0, anew = 0;  // truths, summed over starts

    void add(const PlacedPairs& row, double h, double a) {
      pairs.push_back(row);
      here += h;
      anew += a;
    }
    void ask_both(const std::string& what, Tally& tally) const {
      const double n = static_cast<double>(pairs.size());
      tally.add(what, compare_here_and_anew(pairs), here / n, anew / n);
    }
  };
  Scope all;
  std::array<Scope, kCategorySizes.size()> by_category;
  for (std::size_t t = 0; t < run.tasks.size(); ++t) {
    const FakeTask& task = run.tasks[t];
    for (std::size_t s = 0; s < run.starts; ++s) {
      const PlacedPairs row = {run.pairs(0, t, 1, t, s), id(t), id(t * run.starts + s),
                               id(task.baseline * run.starts + s)};
      const double here = run.rate(0, t, s) - run.rate(1, t, s);
      const double anew = task.truth[0] - task.truth[1];
      all.add(row, here, anew);
      by_category[task.category].add(row, here, anew);
    }
  }
  for (const Scope& scope : by_category) scope.ask_both("a category", tally);
  all.ask_both("all tasks", tally);
}

// Variants of one category against their baselines, under policy 0. On these starts the arms of a
// start are exchanged, since they share their baseline.
void add_variants(const FakeRun& run, Tally& tally) {
  std::array<std::vector<PlacedPairs>, kCategorySizes.size()> pairs;
  std::array<std::map<std::uint32_t, StartArms>, kCategorySizes.size()> arms;
  for (std::size_t t = kCategorySizes[0]; t < run.tasks.size(); ++t) {
    const FakeTask& task = run.tasks[t];
    for (std::size_t s = 0; s < run.starts; ++s) {
      const std::uint32_t place = id(task.baseline * run.starts + s);
      pairs[task.category].push_back({run.pairs(0, t, 0, task.baseline, s), id(t), place, place});
      StartArms& of_start = arms[task.category][place];
      if (of_start.empty()) of_start.push_back(run.count(0, task.baseline, s));
      of_start.push_back(run.count(0, t, s));
    }
  }
  for (std::size_t c = 1; c < pairs.size(); ++c) {
    std::vector<StartArms> starts;
    for (const auto& [place, of_start] : arms[c]) starts.push_back(of_start);
    tally.found["variants, on these starts"].add(shared_baseline_exact(starts) <= kAlpha);
    tally.found["variants, for starts never tried"].add(compare_here_and_anew(pairs[c]).anew.p <=
                                                        kAlpha);
  }
}

Tally simulate(const std::string& name, const FakeDesign& design, int runs, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  Tally tally;
  for (int i = 0; i < runs; ++i) {
    const FakeRun run = draw_run(design, bits);
    add_policies(run, tally);
    if (design.null_variants == 1) add_variants(run, tally);
  }
  for (const auto& [what, share] : tally.found)
    MESSAGE(name << ": " << what << ": found " << 100 * share.value() << " % of " << share.n);
  for (const auto& [what, share] : tally.covered)
    MESSAGE(name << ": " << what << ": covered " << 100 * share.value() << " % of " << share.n);
  return tally;
}

// No interval covers less often than it says.
void check_covered(const Tally& tally) {
  for (const auto& [what, share] : tally.covered) {
    CAPTURE(what);
    CHECK(share.value() >= 0.94);
    CHECK(share.value() <= 0.985);
  }
}

void check_errs_seldom(const Tally& tally, const std::string& question) {
  for (const auto& [what, share] : tally.found) {
    if (!what.ends_with(question)) continue;
    CAPTURE(what);
    CHECK(share.less_noise(kAlpha) <= kAlpha);
  }
}

}  // namespace

TEST_CASE("policies that are alike on every start are rarely told apart, by either question") {
  for (const std::int64_t seeds : {1, 3}) {
    const Tally tally =
        simulate("alike, seeds " + std::to_string(seeds),
                 {.seeds = seeds, .null_variants = 1, .null_policies = 1}, 1000, 11 + seeds);
    check_errs_seldom(tally, "on these starts");
    check_errs_seldom(tally, "for starts never tried");
    check_covered(tally);
  }
}

// Each policy likes some places and dislikes others, and neither is better over all places there
// are: on these starts they differ, which the first question finds and the second must not.
TEST_CASE("policies that are alike on average and not in each place differ on these starts only") {
  const Tally tally =
      simulate("alike on average", {.seeds = 1, .place_sd = 1.5, .null_policies = 1}, 1000, 5);
  check_errs_seldom(tally, "for starts never tried");
  check_covered(tally);
  CHECK(tally.found.at("all tasks, on these starts").value() > 3 * kAlpha);
}

// 51 tasks in eight places: many starts, few places.
TEST_CASE("differences in few places are found on these starts before they are for new ones") {
  const Tally tally =
      simulate("few places", {.seeds = 1, .starts = 2, .null_policies = 0}, 1000, 77);
  const double here = tally.found.at("all tasks, on these starts").value();
  const double anew = tally.found.at("all tasks, for starts never tried").value();
  CHECK(here > anew + 0.1);
}

}  // namespace probe::stats
