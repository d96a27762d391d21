#include "runtime/stats/design.h"

#include <doctest/doctest.h>

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

}  // namespace probe::stats
