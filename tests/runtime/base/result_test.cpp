#include "runtime/base/result.h"

#include <doctest/doctest.h>

#include <memory>
#include <set>

namespace {

using probe::Failure;
using probe::Fault;
using probe::Result;
using probe::Status;

Result<int> half_of(int value) {
  if (value % 2 != 0)
    return Failure{Fault::kUsage, "an odd number has no half", std::to_string(value)};
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
  CHECK(failed.failure().code == Fault::kUsage);
  CHECK(probe::to_text(failed.failure()) == "3: an odd number has no half");
  CHECK(is_even(4).ok());
  CHECK(is_even(5).failure().where == "5");
  CHECK(probe::to_text(Failure{Fault::kIo, "no such file", ""}) == "no such file");
}

TEST_CASE("every fault has a word of its own for programs") {
  CHECK(probe::to_word(Fault::kUsage) == "usage");
  CHECK(probe::to_word(Fault::kInternal) == "internal");
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(Fault::kInternal); ++i) {
    CHECK(words.insert(probe::to_word(static_cast<Fault>(i))).second);
  }
}

TEST_CASE("what cannot be copied can be handed over") {
  Result<std::unique_ptr<int>> made = std::make_unique<int>(7);
  REQUIRE(made.ok());
  const std::unique_ptr<int> taken = std::move(made).value();
  CHECK(*taken == 7);
}
