#include "runtime/base/trig.h"

#include <cmath>
#include <numbers>

#include "runtime/base/trig_reduce.h"

namespace probe {
namespace {

// Kernels after fdlibm's k_sin.c and k_cos.c: minimax polynomials on |r| <= pi/4, with the tail of
// the reduced argument carried along. Plain IEEE operations in a fixed order; compiled without
// contraction.
double sin_kernel(double r, double tail) {
  constexpr double kS1 = -1.66666666666666324348e-01, kS2 = 8.33333333332248946124e-03,
                   kS3 = -1.98412698298579493134e-04, kS4 = 2.75573137070700676789e-06,
                   kS5 = -2.50507602534068634195e-08, kS6 = 1.58969099521155010221e-10;
  const double z = r * r;
  const double v = z * r;
  const double p = kS2 + z * (kS3 + z * (kS4 + z * (kS5 + z * kS6)));
  return r - ((z * (0.5 * tail - v * p) - tail) - v * kS1);
}

double cos_kernel(double r, double tail) {
  constexpr double kC1 = 4.16666666666666019037e-02, kC2 = -1.38888888888741095749e-03,
                   kC3 = 2.48015872894767294178e-05, kC4 = -2.75573143513906633035e-07,
                   kC5 = 2.08757232129817482790e-09, kC6 = -1.13596475577881948265e-11;
  const double z = r * r;
  const double p = z * (kC1 + z * (kC2 + z * (kC3 + z * (kC4 + z * (kC5 + z * kC6)))));
  const double half = 0.5 * z;
  const double w = 1.0 - half;
  return w + (((1.0 - w) - half) + (z * p - r * tail));
}

// Arc tangent on [0, 1] by argument halving about fixed break points and fdlibm's polynomial
// (s_atan.c).
double atan_kernel(double x) {
  constexpr double kHi[] = {4.63647609000806093515e-01, 7.85398163397448278999e-01,
                            9.82793723247329054082e-01, 1.57079632679489655800e+00};
  constexpr double kLo[] = {2.26987774529616870924e-17, 3.06161699786838301793e-17,
                            1.39033110312309984516e-17, 6.12323399573676603587e-17};
  constexpr double kA[] = {
      3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
      -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
      6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
      -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  int part = -1;
  if (x >= 2.4375) {
    part = 3;
    x = -1.0 / x;
  } else if (x >= 1.1875) {
    part = 2;
    x = (x - 1.5) / (1.0 + 1.5 * x);
  } else if (x >= 0.6875) {
    part = 1;
    x = (x - 1.0) / (x + 1.0);
  } else if (x >= 0.4375) {
    part = 0;
    x = (2.0 * x - 1.0) / (2.0 + x);
  }
  const double z = x * x;
  const double w = z * z;
  const double s1 =
      z * (kA[0] + w * (kA[2] + w * (kA[4] + w * (kA[6] + w * (kA[8] + w * kA[10])))));
  const double s2 = w * (kA[1] + w * (kA[3] + w * (kA[5] + w * (kA[7] + w * kA[9]))));
  if (part < 0) return x - x * (s1 + s2);
  return kHi[part] - ((x * (s1 + s2) - kLo[part]) - x);
}

constexpr double kPi = std::numbers::pi;
// Pi less kPi.
constexpr double kPiLow = 1.2246467991473531772e-16;

SinCos from_quadrant(long long quadrant, double s, double c) {
  switch (quadrant & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace

SinCos portable_sincos(double x) {
  if (x == 0.0) return {x, 1.0};
  if (!std::isfinite(x)) return {std::nan(""), std::nan("")};
  // Beyond this the cheap reduction below is no longer exact.
  constexpr double kLargest = 1e6;
  if (std::fabs(x) > kLargest) {
    const Quarters q = reduce_large(x);
    return from_quadrant(q.quadrant, sin_kernel(q.r, q.tail), cos_kernel(q.r, q.tail));
  }
  // Cody-Waite: pi/2 in three parts of 33 bits; n * part is exact for |n| < 2^20.
  constexpr double kInvPio2 = 6.36619772367581382433e-01;
  constexpr double kPio2A = 1.57079632673412561417e+00, kPio2B = 6.07710050630396597660e-11,
                   kPio2C = 2.02226624871116645580e-21, kPio2CTail = 8.47842766036889956997e-32;
  const double n = std::nearbyint(x * kInvPio2);
  const double a = x - n * kPio2A;
  const double b_part = n * kPio2B;
  const double b = a - b_part;
  const double b_error = (a - b) - b_part;
  const double c_part = n * kPio2C;
  const double r_high = b - c_part;
  const double c_error = ((b - r_high) - c_part) + b_error - n * kPio2CTail;
  const double r = r_high + c_error;
  const double tail = (r_high - r) + c_error;
  return from_quadrant(static_cast<long long>(n), sin_kernel(r, tail), cos_kernel(r, tail));
}

double portable_sin(double x) { return portable_sincos(x).sin; }
double portable_cos(double x) { return portable_sincos(x).cos; }

double portable_atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return x + y;
  if (y == 0.0) return std::signbit(x) ? (std::signbit(y) ? -kPi : kPi) : y;
  if (x == 0.0) return y > 0.0 ? 0.5 * kPi : -0.5 * kPi;
  const double ay = std::fabs(y), ax = std::fabs(x);
  double angle;
  if (std::isinf(ax) || std::isinf(ay)) {
    angle = std::isinf(ax) ? (std::isinf(ay) ? 0.25 * kPi : 0.0) : 0.5 * kPi;
  } else {
    angle = atan_kernel(ay / ax);
  }
  if (x < 0.0) angle = kPi - (angle - kPiLow);
  return y < 0.0 ? -angle : angle;
}

double portable_asin(double x) { return portable_atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); }
double portable_acos(double x) { return portable_atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); }

SinCos portable_sincos_deg(double degrees) {
  if (!std::isfinite(degrees)) return {std::nan(""), std::nan("")};
  // fmod is exact by definition, and so are the two operations after it: everything is a multiple
  // of one ulp.
  const double within = std::fmod(degrees, 360.0);
  const double turns = std::nearbyint(within / 90.0);
  const double rest = within - turns * 90.0;
  const auto quadrant = static_cast<long long>(turns);
  if (rest == 0.0) {
    // Written out, so that no zero is negative.
    constexpr SinCos kQuarters[] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    return kQuarters[quadrant & 3];
  }
  const double r = rest / 180.0 * kPi;
  SinCos sc = {sin_kernel(r, 0.0), cos_kernel(r, 0.0)};
  if (rest == 30.0 || rest == -30.0) sc.sin = rest > 0.0 ? 0.5 : -0.5;
  return from_quadrant(quadrant, sc.sin, sc.cos);
}

}  // namespace probe
