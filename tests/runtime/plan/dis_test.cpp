#include "runtime/plan/dis.h"

#include <doctest/doctest.h>

#include "tests/plan/strip_sources.h"
#include "tests/runtime/plan/small_plan.h"

using namespace probe;
using namespace probe::plan;

TEST_CASE(
    "a program is listed with the names of bodies, constants and metrics and its source lines") {
  const auto plan = Plan::from_bytes(small_plan());
  REQUIRE(plan.ok());
  const std::string text = disassemble(*plan, 0);
  const std::string listing = text.substr(text.find("\n\n") + 2);
  CHECK(listing == R"(; suite/small.probe:2  near = once x
   0  POS     r0    carrot
   1  TCP     r1
   2  VSUB    r2    r0 r1
   3  VLEN    r3    r2
   4  KR      r4    0.05
   5  LT      r5    r3 r4
   6  ONCE    r6    r5 s0
   7  EMITB         r6 -> near
   8  OPEN    r7    left_finger
   9  KV      r8    (1, 2, 3)
  10  VDOT    r9    r7 r8
  11  EMITR         r9 -> spread
  12  IMP     r10   left_finger carrot
  13  LE      r11   r4 r10
  14  HOLD    r12   r11 s1 for 5 steps
  15  EMITB         r12 -> steady
  16  KB      r13   1
  17  AXIS    r14   carrot 2
  18  END
)");
}

TEST_CASE("a whole plan is listed once per program") {
  const auto plan = Plan::from_bytes(strip_sources(small_plan()));
  REQUIRE(plan.ok());
  const std::string text = disassemble(*plan);
  CHECK(text.find("program 0 of carrot_on_plate and 1 more") != std::string::npos);
  CHECK(text.find("without sources") != std::string::npos);
  CHECK(text.find("; ") == std::string::npos);
}
