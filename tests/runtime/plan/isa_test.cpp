#include "runtime/plan/isa.h"

#include <doctest/doctest.h>

#include <vector>

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

TEST_CASE("operations with immediates, constants and monitors are the ones that have rules") {
  std::vector<std::string_view> immediates, constants, fingers, monitors, emits;
  for (const OpInfo& op : all_ops()) {
    if (op.a == Kind::kImmediate || op.b == Kind::kImmediate) immediates.push_back(op.name);
    if (op.a == Kind::kConstant || op.a == Kind::kThreeConstants) constants.push_back(op.name);
    if (op.a == Kind::kFinger || op.b == Kind::kFinger) fingers.push_back(op.name);
    if (op.is_monitor()) monitors.push_back(op.name);
    if (op.b == Kind::kMetric) emits.push_back(op.name);
  }
  using Names = std::vector<std::string_view>;
  CHECK(immediates == Names{"KB", "AXIS"});
  CHECK(constants == Names{"KR", "KV"});
  CHECK(fingers == Names{"OPEN"});
  CHECK(monitors == Names{"ONCE", "ALWAYS", "HOLD", "COUNT", "FIRST", "MAXR", "MINR"});
  CHECK(emits == Names{"EMITB", "EMITR"});
}

TEST_CASE("the start of an episode fixes constants and the measurements after settling") {
  std::vector<std::string_view> fixed;
  for (const OpInfo& op : all_ops()) {
    if (op.known == Known::kStart) fixed.push_back(op.name);
  }
  CHECK(fixed == std::vector<std::string_view>{"KR", "KB", "KV", "START", "HALF"});
}
