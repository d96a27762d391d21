#include "runtime/base/percent.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

namespace probe {

TEST_CASE("halves of a percentage go away from zero") {
  CHECK(percent_text(63, 1200) == "5.3");
  CHECK(percent_text(54, 96) == "56.3");
  CHECK(percent_text(1, 3) == "33.3");
  CHECK(percent_text(24, 24) == "100.0");
  CHECK(percent_text(0, 0) == "0.0");
}

TEST_CASE("a rate as a number is rounded as its count is") {
  for (std::int64_t n = 1; n <= 400; ++n) {
    for (std::int64_t k = 0; k <= n; ++k) {
      const double rate = static_cast<double>(k) / static_cast<double>(n);
      if (decimal_text(100 * rate, 1) != percent_text(k, n)) FAIL(k << " of " << n);
    }
  }
  CHECK(decimal_text(-0.25, 1) == "-0.3");
  CHECK(decimal_text(-0.01, 1) == "0.0");
  CHECK(signed_text(0.25, 1) == "+0.3");
  CHECK(signed_text(-0.01, 1) == "+0.0");
}

TEST_CASE("a number is rounded as its text is") {
  CHECK(rounded(0.05245, 4) == 0.0525);
  CHECK(rounded(-0.00005, 4) == -0.0001);
  CHECK(!std::signbit(rounded(-0.00001, 4)));
  for (int i = -1000; i <= 1000; ++i)
    CHECK(fmt::format("{:.1f}", rounded(i / 40.0, 1)) == decimal_text(i / 40.0, 1));
}

TEST_CASE("an interval that has width shows it") {
  CHECK(percent_range(0.43, 0.79, "-") == "43-79");
  CHECK(percent_range(0.997, 1, "-") == "99.7-100.0");
  CHECK(percent_range(0, 0.003, "--") == "0.0--0.3");
  CHECK(percent_range(0.9997, 1, "-") == "99.97-100.00");
  CHECK(percent_range(1, 1, "-") == "100-100");
}

TEST_CASE("a percentage fits when some count rounds to it") {
  CHECK(nearest_counts(66.1, 1, 360).fits);  // 238 of 360
  CHECK(nearest_counts(66.1, 1, 360).below == 238);
  const NearestCounts no = nearest_counts(66.1, 1, 288);
  CHECK(!no.fits);
  CHECK(no.below == 190);
  CHECK(no.above == 191);
  CHECK(nearest_counts(100, 1, 7).fits);
  CHECK(nearest_counts(0, 0, 7).fits);
  CHECK(nearest_counts(14, 0, 7).fits);  // 14.29
  CHECK(!nearest_counts(14.0, 1, 7).fits);
  CHECK(nearest_counts(12.5, 1, 24).fits);
}

}  // namespace probe
