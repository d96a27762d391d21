// A library that is not ours and calls the sine of whoever provides one, as Simbody does.
#include <cmath>

extern "C" double stranger_sine(double x) { return std::sin(x); }
extern "C" double stranger_both(double x) { return std::sin(x) + 2 * std::cos(x); }
