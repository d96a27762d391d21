#include "runtime/stats/design.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "runtime/stats/paired.h"

namespace probe::stats {

// Six discordant pairs of six reject only when one side wins all: 2 * (1/2)^6 = 0.03125.
TEST_CASE("power without a difference is the exact size of the test") {
  CHECK(power({.pairs = 6, .discordance = 1}, 0) == doctest::Approx(0.03125));
  CHECK(power({.pairs = 5, .discordance = 1}, 0) == 0);
}

TEST_CASE("power equals the sum over all tables of those that the test rejects") {
  const int n = 12;
  const double only_a = 0.45, only_b = 0.15;
  double rejected = 0;
  for (int a = 0; a <= n; ++a) {
    for (int b = 0; a + b <= n; ++b) {
      double chance = 1;  // multinomial
      for (int i = 1; i <= a; ++i) chance *= (n - a + i) / static_cast<double>(i) * only_a;
      for (int i = 1; i <= b; ++i) chance *= (n - a - b + i) / static_cast<double>(i) * only_b;
      for (int i = 0; i < n - a - b; ++i) chance *= 1 - only_a - only_b;
      std::vector<Cluster> clusters(static_cast<std::size_t>(a), Cluster{.only_a = 1});
      clusters.insert(clusters.end(), static_cast<std::size_t>(b), Cluster{.only_b = 1});
      if (clustered_exact(clusters) <= 0.05) rejected += chance;
    }
  }
  CHECK(power({.pairs = n, .discordance = only_a + only_b}, only_a - only_b) ==
        doctest::Approx(rejected));
}

TEST_CASE("24 starts see large differences only, 1,200 see small ones") {
  const auto few = minimum_detectable_difference({.pairs = 24, .discordance = 0.5});
  const auto many = minimum_detectable_difference({.pairs = 1200, .discordance = 0.5});
  REQUIRE(few);
  REQUIRE(many);
  CHECK(*few > 0.35);
  CHECK(*many < 0.06);
  CHECK(power({.pairs = 1200, .discordance = 0.5}, *many) == doctest::Approx(0.8).epsilon(1e-3));
}

TEST_CASE("a design that cannot find even the largest difference says so") {
  CHECK_FALSE(minimum_detectable_difference({.pairs = 5, .discordance = 1}));
}

TEST_CASE("as many pairs as are needed find the difference, and a tenth fewer do not") {
  for (const auto& [difference, discordance, alpha] :
       {std::array{0.1, 0.3, 0.05}, {0.5, 0.6, 0.05}, {0.25, 0.25, 0.01}, {0.05, 0.1, 0.005}}) {
    CAPTURE(difference);
    const auto n = pairs_needed(difference, discordance, alpha);
    REQUIRE(n);
    CHECK(power({*n, discordance, alpha}, difference) >= 0.8);
    CHECK(power({*n * 9 / 10, discordance, alpha}, difference) < 0.8);
  }
  CHECK_FALSE(pairs_needed(0, 0.3));
  CHECK_FALSE(pairs_needed(0.4, 0.3));
  CHECK_FALSE(pairs_needed(1e-4, 0.5));
}

// All won: 2 / 2^6 = 0.031 suffices at 5 %, and 2 / 2^8 at a sixth of that.
TEST_CASE("where every pair is won, only their number is missing") {
  CHECK(pairs_needed(1, 1) == 6);
  CHECK(pairs_needed(1, 1, 0.05 / 6) == 8);
}

}  // namespace probe::stats
