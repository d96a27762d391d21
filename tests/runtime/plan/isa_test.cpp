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

// The verifier and the judge know these operations by name; a new line of isa.def that needs their
// care lands here.
TEST_CASE("operations with immediates, constants and monitors are the ones that have rules") {
  std::vector<std::string_view> immediates, constants, monitors, emits;
  for (const OpInfo& op : all_ops()) {
    if (op.a == Kind::kImmediate || op.b == Kind::kImmediate) immediates.push_back(op.name);
    if (op.a == Kind::kConstant || op.b == Kind::kConstant) constants.push_back(op.name);
    if (op.is_monitor()) monitors.push_back(op.name);
    if (op.b == Kind::kMetric) emits.push_back(op.name);
  }
  using Names = std::vector<std::string_view>;
  CHECK(immediates == Names{"KB", "AXIS"});
  CHECK(constants == Names{"KR", "KV"});
  CHECK(monitors == Names{"ONCE", "ALWAYS", "HOLD", "COUNT", "FIRST", "MAXR", "MINR"});
  CHECK(emits == Names{"EMITB", "EMITR"});
}
