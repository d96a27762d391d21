#include "runtime/stats/clustered.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace probe::stats {
namespace {

std::vector<StartPairs> of_one_task(const std::vector<Cluster>& clusters) {
  std::vector<StartPairs> pairs;
  for (const Cluster& c : clusters) {
    pairs.push_back({c, 0, static_cast<std::uint32_t>(pairs.size())});
  }
  return pairs;
}

void check_same(const Interval& a, const Interval& b) {
  CHECK(a.low == doctest::Approx(b.low));
  CHECK(a.high == doctest::Approx(b.high));
}

}  // namespace

TEST_CASE("one task and one seed have Wilson's and Newcombe's intervals") {
  std::vector<StartCount> starts;
  std::vector<Cluster> pairs;
  for (std::uint32_t i = 0; i < 24; ++i) {
    starts.push_back({{i < 9 ? 1 : 0, 1}, 0, i});
    pairs.push_back(i < 9    ? Cluster{.only_a = 1}
                    : i < 12 ? Cluster{.only_b = 1}
                             : Cluster{.neither = 1});
  }
  check_same(clustered_rate(starts), wilson({9, 24}));
  check_same(clustered_difference(of_one_task(pairs)).interval,
             newcombe_paired({.only_a = 9, .only_b = 3, .neither = 12}, 24).interval);
}

TEST_CASE("equal seeds of a start are worth one, and Student's quantile more doubt") {
  std::vector<StartCount> three, one;
  for (std::uint32_t i = 0; i < 24; ++i) {
    three.push_back({{i < 9 ? 3 : 0, 3}, 0, i});
    one.push_back({{i < 9 ? 1 : 0, 1}, 0, i});
  }
  const Interval wide = clustered_rate(three);
  const Interval plain = clustered_rate(one);
  CHECK(wide.low < plain.low);
  CHECK(wide.low > plain.low - 0.02);
  CHECK(wide.high > plain.high);
  CHECK(wide.high < plain.high + 0.02);
}

TEST_CASE("seeds without any agreement beyond chance are worth almost as many starts") {
  const std::vector<Cluster> spread(24, Cluster{.only_a = 1, .neither = 2});
  const Interval clustered = clustered_difference(of_one_task(spread)).interval;
  const Interval pairs = newcombe_paired({.only_a = 24, .neither = 48}, 72).interval;
  CHECK(clustered.low == doctest::Approx(pairs.low).epsilon(0.1));
  CHECK(clustered.high == doctest::Approx(pairs.high).epsilon(0.1));
}

// Four tasks in 24 places without a difference say no more than 24 pairs.
TEST_CASE("without any difference the places count once each") {
  std::vector<StartPairs> pairs, one;
  for (std::uint32_t i = 0; i < 96; ++i) pairs.push_back({{.both = 1}, i / 24, i % 24});
  for (std::uint32_t i = 0; i < 24; ++i) one.push_back({{.both = 1}, 0, i});
  check_same(clustered_difference(pairs).interval, clustered_difference(one).interval);
}

TEST_CASE("without any success the starts count once each") {
  std::vector<StartCount> starts;
  for (std::uint32_t i = 0; i < 24; ++i) starts.push_back({{0, 3}, 0, i});
  check_same(clustered_rate(starts), wilson({0, 24}));
  CHECK(clustered_rate({}).high == 1);
}

// Two tasks of rates 1/6 and 5/6: the difference between them is no doubt about their mean.
TEST_CASE("tasks of unlike rates give a narrower interval than their pooled counts") {
  std::vector<StartCount> starts;
  for (std::uint32_t i = 0; i < 48; ++i) {
    const bool success = i < 24 ? i < 4 : i < 44;
    starts.push_back({{success ? 1 : 0, 1}, i / 24, i});
  }
  const Interval narrow = clustered_rate(starts);
  const Interval pooled_counts = wilson({24, 48});
  CHECK(narrow.low > pooled_counts.low + 0.02);
  CHECK(narrow.high < pooled_counts.high - 0.02);
}

TEST_CASE("with one variant a start the shared baseline's test is that of sign flips") {
  const std::vector<StartArms> starts = {
      {{3, 3}, {0, 3}}, {{2, 3}, {0, 3}}, {{0, 3}, {1, 3}}, {{1, 3}, {1, 3}}};
  const std::vector<Cluster> clusters = {{.only_a = 3}, {.only_a = 2}, {.only_b = 1}};
  CHECK(shared_baseline_exact(starts) == doctest::Approx(clustered_exact(clusters)));
}

// One start, a baseline that succeeds and three variants that fail: any of four arms could have
// been the baseline, and only one choice gives |0 - 3|; the others give 1 - 0 + 0 + 0 = 1.
TEST_CASE("three variants of one baseline are one finding, not three") {
  const StartArms arms = {{1, 1}, {0, 1}, {0, 1}, {0, 1}};
  CHECK(shared_baseline_exact(std::vector<StartArms>{arms}) == doctest::Approx(0.25));
  CHECK(shared_baseline_exact(std::vector<StartArms>{arms, arms}) == doctest::Approx(1.0 / 16));
  CHECK(shared_baseline_exact({}) == 1);
}

// R 4.2.2: fisher.test(matrix(c(7, 3, 1, 9), 2))$p.value = 0.01977; groups of one size, so that
// two-sided by probability and by difference agree.
TEST_CASE("one episode a start makes the unpaired test Fisher's") {
  std::vector<Count> a(10, {0, 1}), b(10, {0, 1});
  for (std::size_t i = 0; i < 7; ++i) a[i].k = 1;
  b[0].k = 1;
  CHECK(unpaired_exact(a, b) == doctest::Approx(0.0197666).epsilon(1e-4));
  CHECK(unpaired_exact(a, a) == doctest::Approx(1));
  CHECK(unpaired_exact(a, {}) == 1);
}

namespace {

// `k` of `n` starts with one success each, the others with none.
std::vector<Count> single(std::int64_t k, std::int64_t n) {
  std::vector<Count> starts(static_cast<std::size_t>(n), {0, 1});
  std::fill_n(starts.begin(), k, Count{1, 1});
  return starts;
}

void check_p(double p, double truth) { CHECK(std::abs(p / truth - 1) < 1e-8); }

}  // namespace

// Binomial coefficients in whole numbers of any length (Python's math.comb), halves of both tails
// by the difference of rates.
TEST_CASE("few starts against many are tested exactly, however small the chance") {
  check_p(unpaired_exact(single(24, 24), single(120, 1200)), 8.14198049233e-24);
  check_p(unpaired_exact(single(24, 24), single(130, 1300)), 6.99832999689e-24);
  check_p(unpaired_exact(single(20, 24), single(30, 1300)), 4.70035651963e-27);
  check_p(unpaired_exact(single(30, 1300), single(20, 24)), 4.70035651963e-27);
  check_p(unpaired_exact(single(24, 24), single(0, 1300)), 9.08797546089e-52);
  CHECK(unpaired_exact(single(12, 24), single(650, 1300)) == 1);
}

TEST_CASE("tens of thousands of starts are tested exactly") {
  check_p(unpaired_exact(single(600, 1200), single(700, 1200)), 4.9493255591e-05);
  check_p(unpaired_exact(single(9000, 10000), single(8700, 10000)), 3.235695089977e-11);
  check_p(unpaired_exact(single(59700, 92400), single(60000, 92400)), 0.1453708124789);
  check_p(unpaired_exact(single(60000, 92400), single(59000, 92400)), 1.214311816909e-06);
  check_p(unpaired_exact(single(92400, 92400), single(92000, 92400)), 5.024455867711e-121);
  check_p(unpaired_exact(single(70000, 92400), single(65000, 92400)), 1.341217412252e-151);
}

// Three seeds a start: by all ways to deal the values, in whole numbers of any length.
TEST_CASE("starts of several seeds are dealt whole") {
  const auto starts = [](std::initializer_list<std::int64_t> times) {
    std::vector<Count> all;
    std::int64_t k = 0;
    for (const std::int64_t n : times) all.insert(all.end(), static_cast<std::size_t>(n), {k++, 3});
    return all;
  };
  // 24 of 48 with sum 60, of 0 x 10, 1 x 8, 2 x 9, 3 x 21.
  check_p(unpaired_exact(starts({1, 2, 5, 16}), starts({9, 6, 4, 5})), 0.000188291130084);
  // 60 of 120 with sum 150, of 0 x 20, 1 x 18, 2 x 19, 3 x 63.
  check_p(unpaired_exact(starts({4, 4, 10, 42}), starts({16, 14, 9, 21})), 1.40713852111e-05);
  // 24 of 300 with sum 60.
  check_p(unpaired_exact(starts({1, 2, 5, 16}), starts({199, 16, 14, 47})), 8.65145205532e-11);
}

// The normal limit with half a success of continuity, whose error at this size is 1 in 10^4.
TEST_CASE("tens of thousands of starts of several seeds are tested") {
  std::vector<Count> a, b;
  for (std::int64_t i = 0; i < 92'400; ++i) {
    a.push_back({i % 7 < 3 ? 3 : i % 7 == 3 ? 0 : i % 3, 3});
    b.push_back({i % 7 < 3 ? 3 : i % 7 == 3 ? 0 : i % 80 == 0 ? 3 : i % 3, 3});
  }
  double sum = 0, squares = 0, difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = static_cast<double>(a[i].k), y = static_cast<double>(b[i].k);
    sum += x + y;
    squares += x * x + y * y;
    difference += y - x;
  }
  const double m = 2 * 92'400.0;
  // Half the difference is what the dealt sum exceeds its mean by.
  const double sd = std::sqrt((squares / m - sum / m * sum / m) * m * m / 4 / (m - 1));
  const double normal = std::erfc((difference / 2 - 0.5) / sd / std::sqrt(2.0));
  CHECK(normal > 1e-6);
  CHECK(normal < 0.1);
  CHECK(std::abs(unpaired_exact(a, b) / normal - 1) < 2e-3);
}

TEST_CASE("the unpaired difference of single episodes is Newcombe's") {
  std::vector<StartCount> a, b;
  for (std::uint32_t i = 0; i < 70; ++i) a.push_back({{i < 56 ? 1 : 0, 1}, 0, i});
  for (std::uint32_t i = 0; i < 80; ++i) b.push_back({{i < 48 ? 1 : 0, 1}, 0, i});
  const Interval interval = unpaired_difference(a, b).interval;
  check_same(interval, unpaired_from(0.8, wilson({56, 70}), 0.6, wilson({48, 80})).interval);
}

}  // namespace probe::stats
