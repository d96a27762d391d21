// Quantities: exact decimals with a dimension, rounded to binary once. Knows nothing of statements;
// who wants which dimension is decided where the statement is read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/base/trig.h"

namespace probe::sema {

// Exponents of metre, second, radian, kilogram and pixel. A pure number has all zero and converts
// to nothing.
struct Dimension {
  std::int8_t length = 0;
  std::int8_t time = 0;
  std::int8_t angle = 0;
  std::int8_t mass = 0;
  std::int8_t pixel = 0;
  std::int8_t travel = 0;  // metre or radian, as the joint goes that is not known yet
  bool operator==(const Dimension&) const = default;
};

namespace dim {
inline constexpr Dimension kNumber{};
inline constexpr Dimension kLength{.length = 1};
inline constexpr Dimension kTime{.time = 1};
inline constexpr Dimension kAngle{.angle = 1};
inline constexpr Dimension kRate{.time = -1};
inline constexpr Dimension kDensity{.length = -3, .mass = 1};
inline constexpr Dimension kMass{.mass = 1};
inline constexpr Dimension kInertia{.length = 2, .mass = 1};
inline constexpr Dimension kViscosity{.length = -1, .time = -1, .mass = 1};
inline constexpr Dimension kImpulse{.length = 1, .time = -1, .mass = 1};
inline constexpr Dimension kForce{.length = 1, .time = -2, .mass = 1};
inline constexpr Dimension kTorque{.length = 2, .time = -2, .mass = 1};
inline constexpr Dimension kLinearStiffness{.time = -2, .mass = 1};
inline constexpr Dimension kLinearDamping{.time = -1, .mass = 1};
inline constexpr Dimension kAngularStiffness{.length = 2, .time = -2, .angle = -1, .mass = 1};
inline constexpr Dimension kAngularDamping{.length = 2, .time = -1, .angle = -1, .mass = 1};
inline constexpr Dimension kVelocity{.length = 1, .time = -1};
inline constexpr Dimension kSpin{.time = -1, .angle = 1};
inline constexpr Dimension kPixel{.pixel = 1};
inline constexpr Dimension kTravel{.travel = 1};
inline constexpr Dimension kTravelRate{.time = -1, .travel = 1};
}  // namespace dim

Dimension operator*(const Dimension& a, const Dimension& b);
Dimension operator/(const Dimension& a, const Dimension& b);

// "a length", "an angle", "a number"; for compounds the SI unit: "a quantity in kg m/s2".
std::string name_of(const Dimension& dimension);
// A unit people would write for it: "cm", "deg", "Nm/rad"; empty for a number.
std::string_view usual_unit(const Dimension& dimension);

// mantissa * 10^exponent, exact.
struct Decimal {
  __extension__ typedef __int128 Wide;
  Wide mantissa = 0;
  int exponent = 0;

  // The nearest double; correctly rounded.
  double to_double() const;
};

// Exact; nothing where 128 bits do not hold the result.
std::optional<Decimal> plus(const Decimal& a, const Decimal& b);
std::optional<Decimal> times(const Decimal& a, int factor);

// Of "20.6", "1e-6", "-3"; nothing when the text is no decimal number or has more than 30
// significant digits.
std::optional<Decimal> parse_decimal(std::string_view text);

// A literal. Angles keep their degrees, because sines and cosines of whole degrees are exact only
// from those.
struct Quantity {
  Decimal exact;  // SI, except: degrees when `in_degrees`
  Dimension dimension;
  bool in_degrees = false;

  double si() const;           // rounded once; degrees as (d / 180) * pi
  SinCos sincos_half() const;  // of half the angle: what a quaternion needs
  double cosine() const;
};

// `unit` may be empty. Nothing when the unit is unknown or the number is none.
std::optional<Quantity> make_quantity(std::string_view number, std::string_view unit);
bool is_unit(std::string_view unit);

}  // namespace probe::sema
