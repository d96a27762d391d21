// What is loaded into somebody else's program: our functions, our own calls of `sin`, and a library
// that is not ours behind it.
#include <cmath>

#include "runtime/base/libm_binding.h"
#include "runtime/base/trig.h"

extern "C" {

double stranger_sine(double x);
double stranger_both(double x);

// How many entries of tables lead to ours now; -1 where that failed.
int bind_to_ours() {
  const std::string_view names[] = {"libprobe_test_stranger"};
  const auto bound = probe::bind_trigonometry(names);
  return bound.ok() ? bound->slots : -1;
}

double sine_here(double x) { return std::sin(x); }
double sine_of_stranger(double x) { return stranger_sine(x); }
double both_of_stranger(double x) { return stranger_both(x); }
double our_sine(double x) { return probe::portable_sin(x); }
double our_both(double x) { return probe::portable_sin(x) + 2 * probe::portable_cos(x); }
}
