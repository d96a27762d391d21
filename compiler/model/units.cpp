// Decimal arithmetic is exact; the only roundings are Decimal::to_double and the turn from degrees
// to radians.
#include "compiler/model/units.h"

#include <array>
#include <charconv>
#include <numbers>

namespace probe::sema {
namespace {

struct Unit {
  std::string_view spelling;
  int scale;
  Dimension dimension;
};

std::int8_t exponent(int value) { return static_cast<std::int8_t>(value); }

const Unit kUnits[] = {
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) \
  {text, scale, {length, time, angle, mass, pixel}},
#include "compiler/syntax/units.def"
};

const Unit* find_unit(std::string_view spelling) {
  for (const Unit& unit : kUnits) {
    if (unit.spelling == spelling) return &unit;
  }
  return nullptr;
}

// The mantissa at a lower exponent.
std::optional<Decimal::Wide> scaled(const Decimal& value, int to_exponent) {
  Decimal::Wide mantissa = value.mantissa;
  for (int e = value.exponent; e > to_exponent; --e) {
    if (__builtin_mul_overflow(mantissa, Decimal::Wide{10}, &mantissa)) return std::nullopt;
  }
  return mantissa;
}

std::string digits(Decimal::Wide value) {
  if (value == 0) return "0";
  const bool negative = value < 0;
  std::string text;
  while (value != 0) {
    const int digit = static_cast<int>(value % 10);
    text.insert(text.begin(), static_cast<char>('0' + (digit < 0 ? -digit : digit)));
    value /= 10;
  }
  return negative ? "-" + text : text;
}

}  // namespace

Dimension operator*(const Dimension& a, const Dimension& b) {
  return {exponent(a.length + b.length), exponent(a.time + b.time),
          exponent(a.angle + b.angle),   exponent(a.mass + b.mass),
          exponent(a.pixel + b.pixel),   exponent(a.travel + b.travel)};
}

Dimension operator/(const Dimension& a, const Dimension& b) {
  return {exponent(a.length - b.length), exponent(a.time - b.time),
          exponent(a.angle - b.angle),   exponent(a.mass - b.mass),
          exponent(a.pixel - b.pixel),   exponent(a.travel - b.travel)};
}

std::string name_of(const Dimension& dimension) {
  struct Named {
    Dimension dimension;
    const char* name;
  };
  static constexpr Named kNames[] = {
      {dim::kNumber, "a number"},
      {dim::kLength, "a length"},
      {dim::kTime, "a time"},
      {dim::kAngle, "an angle"},
      {dim::kRate, "a frequency"},
      {dim::kDensity, "a density"},
      {dim::kMass, "a mass"},
      {dim::kInertia, "a moment of inertia"},
      {dim::kViscosity, "a viscosity"},
      {dim::kImpulse, "an impulse"},
      {dim::kForce, "a force"},
      {dim::kTorque, "a torque"},
      {dim::kLinearStiffness, "a linear stiffness"},
      {dim::kLinearDamping, "a linear damping"},
      {dim::kAngularStiffness, "an angular stiffness"},
      {dim::kAngularDamping, "an angular damping"},
      {dim::kVelocity, "a speed"},
      {dim::kSpin, "an angular speed"},
      {dim::kPixel, "a pixel count"},
      {dim::kTravel, "a travel, which is a length or an angle"},
      {dim::kTravelRate, "the speed of a joint that slides or turns"},
  };
  for (const Named& named : kNames) {
    if (named.dimension == dimension) return named.name;
  }
  const std::array<std::pair<const char*, int>, 6> parts = {{{"m", dimension.length},
                                                             {"s", dimension.time},
                                                             {"rad", dimension.angle},
                                                             {"kg", dimension.mass},
                                                             {"px", dimension.pixel},
                                                             {"travel", dimension.travel}}};
  std::string text = "a quantity in";
  for (const auto& [unit, power] : parts) {
    if (power == 0) continue;
    text += std::string(" ") + unit;
    if (power != 1) text += "^" + std::to_string(power);
  }
  return text;
}

std::string_view usual_unit(const Dimension& dimension) {
  if (dimension == dim::kNumber) return {};
  if (dimension == dim::kLength) return "cm";
  if (dimension == dim::kAngle) return "deg";
  for (const Unit& unit : kUnits) {
    if (unit.dimension == dimension && unit.scale == 0) return unit.spelling;
  }
  return {};
}

double Decimal::to_double() const {
  const std::string text = digits(mantissa) + "e" + std::to_string(exponent);
  double value = 0;
  // from_chars rounds correctly; out-of-range exponents leave 0, and the parser bounds them before.
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::optional<Decimal> plus(const Decimal& a, const Decimal& b) {
  Decimal sum{0, a.exponent < b.exponent ? a.exponent : b.exponent};
  const auto left = scaled(a, sum.exponent), right = scaled(b, sum.exponent);
  if (!left || !right || __builtin_add_overflow(*left, *right, &sum.mantissa)) return std::nullopt;
  return sum;
}

std::optional<Decimal> times(const Decimal& a, int factor) {
  Decimal product{0, a.exponent};
  if (__builtin_mul_overflow(a.mantissa, Decimal::Wide{factor}, &product.mantissa))
    return std::nullopt;
  return product;
}

std::optional<Decimal> parse_decimal(std::string_view text) {
  Decimal value;
  bool negative = false;
  std::size_t at = 0;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) negative = text[at++] == '-';
  int kept = 0;
  bool seen_point = false;
  bool seen_digit = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '.' && !seen_point) {
      seen_point = true;
      continue;
    }
    if (c < '0' || c > '9') break;
    seen_digit = true;
    if (value.mantissa != 0 || c != '0') ++kept;
    if (kept > 18) return std::nullopt;
    value.mantissa = value.mantissa * 10 + (c - '0');
    if (seen_point) --value.exponent;
  }
  if (!seen_digit) return std::nullopt;
  if (at < text.size()) {
    if (text[at] != 'e' && text[at] != 'E') return std::nullopt;
    ++at;
    if (at < text.size() && text[at] == '+') ++at;
    int shift = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), shift);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    value.exponent += shift;
  }
  // Below 1e14 with a resolution of at least 1e-18 (1e-21 after the unit), so that two of them can
  // be added in 128 bits.
  if (value.mantissa == 0) value.exponent = 0;
  if (value.exponent < -18 || kept + value.exponent > 14) return std::nullopt;
  if (negative) value.mantissa = -value.mantissa;
  return value;
}

double Quantity::si() const {
  const double value = exact.to_double();
  return in_degrees ? value / 180.0 * std::numbers::pi : value;
}

SinCos Quantity::sincos_half() const {
  const double half = exact.to_double() / 2;
  return in_degrees ? portable_sincos_deg(half) : portable_sincos(half);
}

double Quantity::cosine() const {
  const double value = exact.to_double();
  return in_degrees ? portable_sincos_deg(value).cos : portable_cos(value);
}

std::optional<Quantity> make_quantity(std::string_view number, std::string_view unit) {
  const std::optional<Decimal> exact = parse_decimal(number);
  if (!exact) return std::nullopt;
  if (unit.empty()) return Quantity{*exact, dim::kNumber, false};
  const Unit* found = find_unit(unit);
  if (found == nullptr) return std::nullopt;
  Quantity quantity{*exact, found->dimension, unit == "deg"};
  if (quantity.exact.mantissa != 0) quantity.exact.exponent += found->scale;
  return quantity;
}

bool is_unit(std::string_view unit) { return find_unit(unit) != nullptr; }

}  // namespace probe::sema
