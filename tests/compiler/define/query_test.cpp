#include "compiler/define/query.h"

#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("queries follow Kleene's logic") {
  using sema::Truth;
  sema::Object object;
  object.values = {{}, {1}};
  object.facts = {Truth::kYes, Truth::kUnknown, Truth::kNo};
  const sema::QueryOp unknown{sema::QueryOp::kValue, 0, 0}, yes{sema::QueryOp::kFact, 0, 0},
      no{sema::QueryOp::kFact, 2, 0};
  const sema::QueryOp conjunction{sema::QueryOp::kAnd}, disjunction{sema::QueryOp::kOr},
      negation{sema::QueryOp::kNot};
  CHECK(evaluate({unknown}, object) == Truth::kUnknown);
  CHECK(evaluate({unknown, no, conjunction}, object) == Truth::kNo);
  CHECK(evaluate({unknown, yes, conjunction}, object) == Truth::kUnknown);
  CHECK(evaluate({unknown, yes, disjunction}, object) == Truth::kYes);
  CHECK(evaluate({unknown, negation}, object) == Truth::kUnknown);
  CHECK(evaluate({no, negation}, object) == Truth::kYes);
  CHECK(evaluate({{sema::QueryOp::kValue, 1, 1}}, object) == Truth::kYes);
}
