// How many quarter turns an angle has and what is left, for angles of any size.
#pragma once

namespace probe {

// x = (4 k + quadrant) * pi/2 + (r + tail) for some whole k, |r| <= pi/4; `tail` is what r was
// rounded by.
struct Quarters {
  int quadrant = 0;  // 0 .. 3
  double r = 0, tail = 0;
};

// For finite x with |x| >= 1; r + tail is right to 2^-65 of itself.
Quarters reduce_large(double x);

}  // namespace probe
