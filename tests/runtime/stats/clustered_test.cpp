#include "runtime/stats/clustered.h"

#include <doctest/doctest.h>

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
             newcombe_paired({.only_a = 9, .only_b = 3, .neither = 12}).interval);
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
  const Interval pairs = newcombe_paired(pooled(spread)).interval;
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

TEST_CASE("the unpaired difference of single episodes is Newcombe's") {
  std::vector<StartCount> a, b;
  for (std::uint32_t i = 0; i < 70; ++i) a.push_back({{i < 56 ? 1 : 0, 1}, 0, i});
  for (std::uint32_t i = 0; i < 80; ++i) b.push_back({{i < 48 ? 1 : 0, 1}, 0, i});
  check_same(unpaired_difference(a, b).interval, newcombe_unpaired({56, 70}, {48, 80}).interval);
}

}  // namespace probe::stats
