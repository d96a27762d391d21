// Sine, cosine and their inverses as fixed sequences of IEEE operations in our own source. The C
// library's dispatch on the CPU (with and without FMA) and so differ in the last bit between
// machines; results and hashes depend on these.
#pragma once

namespace probe {

struct SinCos {
  double sin;
  double cos;
};

// Radians of any size, to 1 ulp; what is not finite gives no number.
SinCos portable_sincos(double x);
double portable_sin(double x);
double portable_cos(double x);
double portable_atan2(double y, double x);
double portable_asin(double x);
double portable_acos(double x);

// Degrees of any size, to 3 ulp, exact at multiples of 90 (no zero is negative) and 0.5 at 30: what
// quantities in source text are turned with.
SinCos portable_sincos_deg(double degrees);

}  // namespace probe
