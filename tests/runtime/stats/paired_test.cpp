#include "runtime/stats/paired.h"

#include <doctest/doctest.h>

#include <vector>

namespace probe::stats {

namespace {

// Each pair a cluster of its own.
std::vector<Cluster> alone(const PairTable& pairs) {
  std::vector<Cluster> clusters(static_cast<std::size_t>(pairs.both), Cluster{.both = 1});
  clusters.insert(clusters.end(), static_cast<std::size_t>(pairs.only_a), Cluster{.only_a = 1});
  clusters.insert(clusters.end(), static_cast<std::size_t>(pairs.only_b), Cluster{.only_b = 1});
  clusters.insert(clusters.end(), static_cast<std::size_t>(pairs.neither), Cluster{.neither = 1});
  return clusters;
}

Difference newcombe(const PairTable& pairs) {
  return newcombe_paired(pairs, static_cast<double>(pairs.pairs()));
}

}  // namespace

// R 4.2.2: binom.test(3, 15)$p.value; the concordant pairs say nothing.
TEST_CASE(
    "clusters of one pair give McNemar's exact test, the binomial test of those that differ") {
  CHECK(clustered_exact(alone({.both = 5, .only_a = 3, .only_b = 12, .neither = 4})) ==
        doctest::Approx(0.03515625));
  CHECK(clustered_exact(alone({.both = 1, .only_a = 3, .only_b = 12})) ==
        doctest::Approx(0.03515625));
  CHECK(clustered_exact(alone({.both = 20, .neither = 4})) == 1);
  CHECK(clustered_exact(alone({.only_a = 4, .only_b = 4})) == 1);
}

// Three starts, all three seeds of each won by A: as pairs p = 2/2^9, but only 2 of the 2^3 sign
// flips of the starts are as extreme.
TEST_CASE("seeds that repeat a start are not independent evidence") {
  const std::vector<Cluster> clusters(3, Cluster{.only_a = 3});
  CHECK(clustered_exact(alone({.only_a = 9})) == doctest::Approx(2.0 / 512));
  CHECK(clustered_exact(clusters) == doctest::Approx(2.0 / 8));
}

// Sums of +-3 +-2 +-1: |s| >= 4 for 6, 4, -4, -6 (one flip each) = 4 of 8.
TEST_CASE("sign flips of unequal clusters are counted exactly") {
  const std::vector<Cluster> clusters{{.only_a = 3}, {.only_a = 2}, {.only_b = 1}};
  CHECK(clustered_exact(clusters) == doctest::Approx(4.0 / 8));
}

// Newcombe 1998 (Statistics in Medicine 17:873), table II, method 10: 56/70 against 48/80.
TEST_CASE("the unpaired difference equals Newcombe's published example") {
  const Difference d = unpaired_from(0.8, wilson({56, 70}), 0.6, wilson({48, 80}));
  CHECK(d.estimate == doctest::Approx(0.2));
  CHECK(d.interval.low == doctest::Approx(0.0524).epsilon(1e-3));
  CHECK(d.interval.high == doctest::Approx(0.3339).epsilon(1e-3));
}

// Airway hyper-responsiveness (Bentur et al. 2009), in Fagerland, Lydersen and Laake, Statistical
// Analysis of Contingency Tables, chapter 8: -0.286 (-0.507 to -0.026).
TEST_CASE("the paired difference equals a published example") {
  const Difference d = newcombe({.both = 1, .only_a = 1, .only_b = 7, .neither = 12});
  CHECK(d.estimate == doctest::Approx(-6.0 / 21));
  CHECK(d.interval.low == doctest::Approx(-0.507).epsilon(1e-3));
  CHECK(d.interval.high == doctest::Approx(-0.026).epsilon(0.02));
}

TEST_CASE("without a pair a difference may be anything") {
  CHECK(newcombe({}).interval.low == -1);
  CHECK(newcombe({}).interval.high == 1);
}

TEST_CASE("swapping the policies mirrors the difference") {
  const Difference ab = newcombe({.both = 9, .only_a = 2, .only_b = 6, .neither = 7});
  const Difference ba = newcombe({.both = 9, .only_a = 6, .only_b = 2, .neither = 7});
  CHECK(ab.estimate == doctest::Approx(-ba.estimate));
  CHECK(ab.interval.low == doctest::Approx(-ba.interval.high));
  CHECK(ab.interval.high == doctest::Approx(-ba.interval.low));
}

}  // namespace probe::stats
