// What moments of inertia a body can have: asked by the compiler of a text and by the verifier of a
// plan.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace probe::plan {

// What is wrong with moments and products xx yy zz xy xz yz about a centre of mass (kg m2, the
// tensor's own entries), or nothing. Principal moments of a real body are positive and none exceeds
// the sum of the others (x^2 + y^2 and so on are sums of squares); the tolerance, a thousandth,
// admits values that were rounded for printing.
std::optional<std::string> inertia_fault(const std::array<double, 6>& inertia);

}  // namespace probe::plan
