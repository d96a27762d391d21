#include "runtime/base/result.h"

#include <doctest/doctest.h>

#include <memory>

namespace {

using probe::Failure;
using probe::Result;
using probe::Status;

Result<int> half_of(int value) {
  if (value % 2 != 0) return Failure{"usage", "an odd number has no half", std::to_string(value)};
  return value / 2;
}

Result<int> quarter_of(int value) {
  PROBE_ASSIGN(const int half, half_of(value));
  PROBE_ASSIGN(const int quarter, half_of(half));
  return quarter;
}

Status is_even(int value) {
  PROBE_TRY(half_of(value));
  return {};
}

}  // namespace

TEST_CASE("a failure travels up unchanged") {
  CHECK(quarter_of(12).value() == 3);
  const Result<int> failed = quarter_of(6);
  REQUIRE(!failed.ok());
  CHECK(failed.failure().code == "usage");
  CHECK(probe::to_text(failed.failure()) == "3: an odd number has no half");
  CHECK(is_even(4).ok());
  CHECK(is_even(5).failure().where == "5");
  CHECK(probe::to_text(Failure{"io", "no such file", ""}) == "no such file");
}

TEST_CASE("what cannot be copied can be handed over") {
  Result<std::unique_ptr<int>> made = std::make_unique<int>(7);
  REQUIRE(made.ok());
  const std::unique_ptr<int> taken = std::move(made).value();
  CHECK(*taken == 7);
}
