#include "runtime/plan/isa.h"

#include <doctest/doctest.h>

#include <vector>

#include "runtime/plan/readouts.h"

using namespace probe::plan;

TEST_CASE("every operation is found by its code and no other code is one") {
  std::size_t found = 0;
  for (int code = 0; code < 256; ++code) {
    const OpInfo* info = find_op(static_cast<std::uint8_t>(code));
    if (info == nullptr) continue;
    CHECK(static_cast<int>(info->op) == code);
    ++found;
  }
  CHECK(found == all_ops().size());
}

TEST_CASE(
    "an immediate has a limit, constants have a place, and a monitor remembers for a read-out, a "
    "`for` or a `latest`") {
  std::size_t emits = 0;
  for (const OpInfo& op : all_ops()) {
    CAPTURE(op.name);
    const bool is_immediate = op.a == Kind::kImmediate || op.b == Kind::kImmediate;
    CHECK(is_immediate == (op.limit != 0));
    if (op.a == Kind::kConstant) CHECK(op.result == Kind::kReal);
    if (op.a == Kind::kThreeConstants) CHECK(op.result == Kind::kVector);
    // Of a finger, only its opening is known that other bodies do not have.
    if (op.a == Kind::kFinger || op.b == Kind::kFinger) CHECK(op.result == Kind::kVector);
    const bool is_of_latest = op.op == Op::kKEPT;
    CHECK(op.is_monitor() ==
          (readout_of(op.op) != nullptr || op.b == Kind::kTimedState || is_of_latest));
    if (op.b != Kind::kMetric) continue;
    ++emits;
    CHECK(op.result == Kind::kUnused);
    CHECK((op.a == Kind::kBool || op.a == Kind::kReal));
  }
  CHECK(emits == 2);  // a truth and a number
}

TEST_CASE("the start of an episode fixes constants and the measurements after settling") {
  std::vector<std::string_view> fixed;
  for (const OpInfo& op : all_ops()) {
    if (op.known == Known::kStart) fixed.push_back(op.name);
  }
  CHECK(fixed == std::vector<std::string_view>{"KR", "KB", "KV", "START", "HALF"});
}
