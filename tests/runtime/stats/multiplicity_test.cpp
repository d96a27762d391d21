#include "runtime/stats/multiplicity.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace probe::stats {
namespace {

const std::vector<double> kP{0.01, 0.04, 0.03, 0.005, 0.5, 0.04};

void check_all(const std::vector<double>& got, const std::vector<double>& wanted) {
  REQUIRE(got.size() == wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) CHECK(got[i] == doctest::Approx(wanted[i]));
}

}  // namespace

// R 4.2.2: p.adjust(p, "BH").
TEST_CASE("Benjamini and Hochberg's values equal R's p.adjust") {
  check_all(benjamini_hochberg(kP), {0.03, 0.048, 0.048, 0.03, 0.5, 0.048});
}

// R 4.2.2: p.adjust(p, "holm").
TEST_CASE("Holm's values equal R's p.adjust") {
  check_all(holm(kP), {0.05, 0.12, 0.12, 0.03, 0.5, 0.12});
}

TEST_CASE("a comparison that could not be tested neither counts nor changes the others") {
  std::vector<double> p = kP;
  p.insert(p.begin() + 2, std::numeric_limits<double>::quiet_NaN());
  const auto adjusted = benjamini_hochberg(p);
  CHECK(std::isnan(adjusted[2]));
  CHECK(adjusted[1] == doctest::Approx(0.048));
  CHECK(holm({}).empty());
}

}  // namespace probe::stats
