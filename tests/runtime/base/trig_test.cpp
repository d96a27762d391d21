#include "runtime/base/trig.h"

#include <dlfcn.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace {

// The C library's own: `sin` of this program is ours, in all that is linked into it.
struct Libm {
  void* library = ::dlopen("libm.so.6", RTLD_NOW | RTLD_LOCAL);
  double (*sin)(double) = reinterpret_cast<double (*)(double)>(::dlsym(library, "sin"));
  double (*cos)(double) = reinterpret_cast<double (*)(double)>(::dlsym(library, "cos"));
};
const Libm libm;

double ulp_error(double got, double want) {
  const double scale = std::max(std::fabs(want), 1e-300);
  return std::fabs(got - want) / (std::nextafter(scale, 2 * scale) - scale);
}
}  // namespace

TEST_CASE("what is compared with is the C library's sine, which differs from ours in last bits") {
  REQUIRE((libm.sin != nullptr && libm.cos != nullptr));
  int differing = 0;
  for (int i = 0; i < 10000; ++i)
    differing += libm.sin(0.001 * i) != probe::portable_sin(0.001 * i) ? 1 : 0;
  CHECK(differing > 10);
  CHECK(differing < 2000);
}

TEST_CASE("sine and cosine agree with the C library to 1.5 ulp over many turns") {
  std::mt19937_64 draw(1);
  std::uniform_real_distribution<double> angle(-1000.0, 1000.0);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = angle(draw);
    const auto sc = probe::portable_sincos(x);
    worst = std::max(worst, ulp_error(sc.sin, libm.sin(x)));
    worst = std::max(worst, ulp_error(sc.cos, libm.cos(x)));
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

TEST_CASE("sine and cosine agree with the C library to 1.5 ulp at every size of angle") {
  std::mt19937_64 draw(3);
  double worst = 0.0;
  for (int i = 0; i < 500000; ++i) {
    const double x = std::bit_cast<double>(draw());
    if (!std::isfinite(x)) continue;
    const auto sc = probe::portable_sincos(x);
    worst = std::max(worst, ulp_error(sc.sin, libm.sin(x)));
    worst = std::max(worst, ulp_error(sc.cos, libm.cos(x)));
  }
  CHECK(worst <= 1.5);
}

TEST_CASE("next to quarter turns, where all but the reduction cancels, the digits are right too") {
  // Of all doubles the closest to a multiple of pi/2 (Muller, Elementary Functions, table 11.1).
  CHECK(probe::portable_cos(0x1.6ac5b262ca1ffp+849) == -0x1.14ae72e6ba22fp-61);
  std::mt19937_64 draw(4);
  double worst = 0.0;
  for (int i = 0; i < 100000; ++i) {
    // The quarter turn next to a number below 2^60, as exactly as a long double has it.
    const double about =
        std::ldexp(static_cast<double>(draw() >> 11), static_cast<int>(draw() % 8));
    const long double turns = std::nearbyintl(about / 1.57079632679489661923L);
    const auto x = static_cast<double>(turns * 1.57079632679489661923L);
    const auto sc = probe::portable_sincos(x);
    worst = std::max(worst, ulp_error(sc.sin, libm.sin(x)));
    worst = std::max(worst, ulp_error(sc.cos, libm.cos(x)));
  }
  CHECK(worst <= 1.5);
}

TEST_CASE("sine is odd and cosine even, and both meet where the reduction changes") {
  CHECK(std::fabs(probe::portable_sin(1e6) - libm.sin(1e6)) <= 2e-16);
  const double above = std::nextafter(1e6, 2e6);
  CHECK(std::fabs(probe::portable_sin(above) - libm.sin(above)) <= 2e-16);
  for (const double x : {0.1, 3.0, 1e5, 1e7, 1e22, 1e300, 0x1.fffffffffffffp+1023}) {
    CHECK(probe::portable_sin(-x) == -probe::portable_sin(x));
    CHECK(probe::portable_cos(-x) == probe::portable_cos(x));
  }
}

TEST_CASE("the arc functions agree with the C library over the whole range of their arguments") {
  std::mt19937_64 draw(5);
  double worst = 0.0;
  for (int i = 0; i < 500000; ++i) {
    const double y = std::bit_cast<double>(draw()), x = std::bit_cast<double>(draw());
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    worst = std::max(worst, ulp_error(probe::portable_atan2(y, x), std::atan2(y, x)));
    const double small = std::ldexp(y, -1024);
    if (std::fabs(small) > 1e-300)
      worst = std::max(worst, ulp_error(probe::portable_asin(small), std::asin(small)));
  }
  CHECK(worst <= 4);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kCorners[] = {0.0, -0.0, 1.0, -1.0, kInfinite, -kInfinite};
  for (const double y : kCorners) {
    for (const double x : kCorners) {
      CAPTURE(y);
      CAPTURE(x);
      const double got = probe::portable_atan2(y, x), want = std::atan2(y, x);
      CHECK(ulp_error(got, want) <= 1);
      CHECK(std::signbit(got) == std::signbit(want));
    }
  }
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
