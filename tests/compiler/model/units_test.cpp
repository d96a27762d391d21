#include "compiler/model/units.h"

#include <doctest/doctest.h>

#include "compiler/syntax/lexer.h"

#include <numbers>

#include "compiler/syntax/ast.h"

using namespace probe;
using namespace probe::sema;

namespace {
double si(std::string_view number, std::string_view unit) {
  return make_quantity(number, unit)->si();
}
}  // namespace

TEST_CASE("a length in any unit is bit-equal to the length in metres") {
  CHECK(si("20.6", "cm") == 0.206);
  CHECK(si("6", "mm") == 0.006);
  CHECK(si("-16", "cm") == -0.16);
  CHECK(si("3.00001", "mm") == 0.00300001);
  CHECK(si("87", "cm") == 0.87);
  CHECK(si("1e-6", "Ns") == 1e-6);
  CHECK(si("1169.789", "Nm/rad") == 1169.789);
  // What a product would give instead.
  CHECK(20.6 * 0.01 != 0.206);
}

TEST_CASE("degrees turn into radians with one rounding of the degrees") {
  CHECK(si("90", "deg") == std::numbers::pi / 2);
  CHECK(si("180", "deg") == std::numbers::pi);
  CHECK(si("-90", "deg") == -std::numbers::pi / 2);
  CHECK(make_quantity("60", "deg")->cosine() == 0.5);
  CHECK(make_quantity("180", "deg")->sincos_half().cos == 0.0);
  CHECK(make_quantity("180", "deg")->sincos_half().sin == 1.0);
}

TEST_CASE("sums of decimals are exact before they are rounded") {
  const Decimal a = *parse_decimal("-0.16");
  CHECK(plus(a, *parse_decimal("-0.05"))->to_double() == -0.21);
  CHECK(-0.16 - 0.05 != -0.21);
  CHECK(plus(a, *times(*parse_decimal("0.075"), 2))->to_double() == -0.01);
}

TEST_CASE("a sum or product that 128 bits do not hold is none") {
  const Decimal large = make_quantity("99999999999999", "m")->exact;
  const Decimal small = make_quantity("1e-18", "mm")->exact;
  REQUIRE(plus(large, small).has_value());
  CHECK_FALSE(times(*plus(large, small), 999'999).has_value());
  CHECK_FALSE(plus(Decimal{large.mantissa, 20}, small).has_value());
}

TEST_CASE("what is no plain decimal is refused") {
  for (const char* text : {"", ".", "-", "1.2.3", "1e", "0x10", "nan", "1e400",
                           "1234567890123456789", "1e-40", "1e14"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_decimal(text).has_value());
  }
  CHECK_FALSE(make_quantity("1", "furlong").has_value());
}

TEST_CASE("every unit of the grammar has a meaning") {
  const syntax::Unit units[] = {
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) syntax::Unit::id,
#include "compiler/syntax/units.def"
  };
  for (const syntax::Unit unit : units) {
    CAPTURE(syntax::to_text(unit));
    CHECK(is_unit(syntax::to_text(unit)));
    CHECK(syntax::unit_from_text(syntax::to_text(unit)) == unit);
  }
}

TEST_CASE("dimensions multiply and have names") {
  CHECK(dim::kLength / dim::kTime == dim::kVelocity);
  CHECK(dim::kForce * dim::kTime == dim::kImpulse);
  CHECK(name_of(dim::kLength) == "a length");
  CHECK(name_of(dim::kLength * dim::kLength) == "a quantity in m^2");
  CHECK(usual_unit(dim::kAngle) == "deg");
}
