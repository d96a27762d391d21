#include "compiler/geometry/travel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/compiler/small_suite.h"

using namespace probe;
using namespace probe::sema;

TEST_CASE("a part fills all that its joint lets it reach, in steps of two millimetres") {
  const auto a = test::analyze_with_suite(test::kChest);
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  const auto travel = Travel::of(*a->model.fixtures.begin(), test::asset_root());
  REQUIRE(travel);
  // The drawer's box of 10 cm slides by 20 cm along the world's y, for the chest is turned by 90
  // degrees.
  double low = 1, high = -1, last = -1, widest = 0;
  for (const PartBox& box : travel->everywhere()) {
    if (box.part != 1) continue;
    low = std::min(low, box.solid.centre.y());
    high = std::max(high, box.solid.centre.y());
    if (last >= 0) widest = std::max(widest, box.position - last);
    last = box.position;
    CHECK(box.solid.centre.y() == doctest::Approx(0.3 + box.position));
    CHECK(box.half.x() == doctest::Approx(0.05));
  }
  CHECK(low == doctest::Approx(0.3));
  CHECK(high == doctest::Approx(0.5));
  CHECK(widest <= 0.002 + 1e-12);
  const double joints[] = {0.04, 0, 0};
  const auto begun = travel->at(joints);
  REQUIRE(begun.size() == 4);
  CHECK(begun[1].solid.centre.y() == doctest::Approx(0.34));
}
