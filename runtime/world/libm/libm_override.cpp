// sin, cos and sincos of the whole program. glibc picks versions with or without FMA at run time,
// whose last bits differ; Simbody's pin joints call them. An executable that links this object
// gives every library, shared ones too, ours. Compiled with -fno-builtin, or the compiler would
// turn the bodies into calls of themselves.
#include "runtime/base/trig.h"

extern "C" {

__attribute__((visibility("default"))) double sin(double x) noexcept {
  return probe::portable_sin(x);
}

__attribute__((visibility("default"))) double cos(double x) noexcept {
  return probe::portable_cos(x);
}

__attribute__((visibility("default"))) void sincos(double x, double* s, double* c) noexcept {
  const probe::SinCos both = probe::portable_sincos(x);
  *s = both.sin;
  *c = both.cos;
}
}
