// What a design can see before a single episode is run: power and the minimum detectable difference
// of a paired comparison by clustered_exact on starts that count once each (McNemar's exact test).
#pragma once

#include <cstdint>
#include <optional>

namespace probe::stats {

// A comparison of two policies on `pairs` starts of which a share `discordance` (0..1) is expected
// to end differently; a test at two-sided level `alpha`.
struct PairedDesign {
  std::int64_t pairs = 0;
  double discordance = 0.3;
  double alpha = 0.05;
};

// The chance that the test's p is at most alpha when the true rates differ by `difference`
// (|difference| <= discordance): the binomial number of discordant pairs, and of those that A wins,
// summed exactly.
double power(const PairedDesign& design, double difference);

// The smallest difference that is found with at least `wanted_power`, to 1e-6; nothing when even
// the largest (the discordance itself, every discordant pair won by one side) is not.
std::optional<double> minimum_detectable_difference(const PairedDesign& design,
                                                    double wanted_power = 0.8);

// About how many pairs find `difference` (> 0) with `wanted_power` when a share `discordance` of
// them end differently, at two-sided level `alpha`; nothing when a million would not. By exact
// power from Connor's formula on (1987, Biometrics 43:207), which gives too few where pairs are
// few; beyond 5,000 pairs Connor's number itself.
std::optional<std::int64_t> pairs_needed(double difference, double discordance, double alpha = 0.05,
                                         double wanted_power = 0.8);

}  // namespace probe::stats
