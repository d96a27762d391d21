#include "compiler/model/measures.h"

#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("the table of measures lists each name once") {
  for (const sema::MeasureInfo& a : sema::all_measures()) {
    CHECK_FALSE(a.meaning.empty());
    for (const sema::MeasureInfo& b : sema::all_measures())
      CHECK((a.measure == b.measure || a.name != b.name));
  }
}
