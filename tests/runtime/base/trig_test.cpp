#include "runtime/base/trig.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {
double ulp_error(double got, double want) {
  const double scale = std::max(std::fabs(want), 1e-300);
  return std::fabs(got - want) / (std::nextafter(scale, 2 * scale) - scale);
}
}  // namespace

TEST_CASE("sine and cosine agree with the C library to 1.5 ulp over many turns") {
  std::mt19937_64 draw(1);
  std::uniform_real_distribution<double> angle(-1000.0, 1000.0);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = angle(draw);
    const auto sc = probe::portable_sincos(x);
    worst = std::max(worst, ulp_error(sc.sin, std::sin(x)));
    worst = std::max(worst, ulp_error(sc.cos, std::cos(x)));
  }
  CHECK(worst <= 1.5);
}

TEST_CASE("the arc functions agree with the C library to 3e-16") {
  std::mt19937_64 draw(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 200000; ++i) {
    const double y = unit(draw), x = unit(draw);
    REQUIRE(std::fabs(probe::portable_atan2(y, x) - std::atan2(y, x)) <= 9e-16);
    REQUIRE(std::fabs(probe::portable_asin(y) - std::asin(y)) <= 5e-16);
    REQUIRE(std::fabs(probe::portable_acos(y) - std::acos(y)) <= 9e-16);
  }
  CHECK(probe::portable_atan2(0.0, -1.0) == std::atan2(0.0, -1.0));
  CHECK(probe::portable_atan2(-0.0, -1.0) == std::atan2(-0.0, -1.0));
  CHECK(probe::portable_atan2(1.0, 0.0) == std::atan2(1.0, 0.0));
}

TEST_CASE("degrees are exact at quarter turns and at thirty") {
  CHECK(probe::portable_sincos_deg(90.0).sin == 1.0);
  CHECK(probe::portable_sincos_deg(90.0).cos == 0.0);
  CHECK(probe::portable_sincos_deg(-180.0).cos == -1.0);
  CHECK(probe::portable_sincos_deg(450.0).sin == 1.0);
  CHECK(probe::portable_sincos_deg(30.0).sin == 0.5);
  CHECK(probe::portable_sincos_deg(45.0).sin == doctest::Approx(std::sqrt(0.5)).epsilon(1e-15));
}

TEST_CASE("a number that is not finite gives a number that is not finite") {
  CHECK(std::isnan(probe::portable_sincos(INFINITY).sin));
  CHECK(std::isnan(probe::portable_sincos_deg(-INFINITY).cos));
  CHECK(std::isnan(probe::portable_sincos_deg(std::nan("")).sin));
  CHECK(std::isnan(probe::portable_asin(1.5)));
  CHECK(std::isnan(probe::portable_acos(-1.5)));
}

TEST_CASE("an angle too large to be reduced gives no number instead of a wrong one") {
  CHECK(std::isnan(probe::portable_sin(1e22)));
  CHECK(std::isnan(probe::portable_cos(-1e7)));
  CHECK(std::fabs(probe::portable_sin(1e6) - std::sin(1e6)) <= 2e-16);
}

TEST_CASE("large angles in degrees are reduced exactly") {
  CHECK(probe::portable_sincos_deg(1e17).sin == probe::portable_sincos_deg(280.0).sin);
  CHECK(probe::portable_sincos_deg(1e300).cos ==
        probe::portable_sincos_deg(std::fmod(1e300, 360.0)).cos);
  CHECK(probe::portable_sincos_deg(-3690.0).sin == -1.0);
}

TEST_CASE("no zero at a quarter turn is negative, and a small angle keeps its sign") {
  for (double turn = -4; turn <= 4; ++turn) {
    const auto sc = probe::portable_sincos_deg(90.0 * turn);
    CHECK(!(sc.sin == 0.0 && std::signbit(sc.sin)));
    CHECK(!(sc.cos == 0.0 && std::signbit(sc.cos)));
  }
  CHECK(std::signbit(probe::portable_sin(-0.0)));
  CHECK(probe::portable_sin(-1e-310) == -1e-310);
}
