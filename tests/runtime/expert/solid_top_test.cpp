#include <doctest/doctest.h>

#include "runtime/expert/solid_top.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {

TEST_CASE("over a slope it is the slope that counts, not the solid's highest vertex") {
  // A wedge: 10 cm long, rising from 0 to 5 cm.
  const std::vector<Vec3> wedge = {{0, -0.1, 0},  {0, 0.1, 0},       {0.1, -0.1, 0},
                                   {0.1, 0.1, 0}, {0.1, -0.1, 0.05}, {0.1, 0.1, 0.05}};
  CHECK(top_over(wedge, {0.05, 0}).value() == doctest::Approx(0.025));
  CHECK(top_over(wedge, {0.1, 0.1}).value() == doctest::Approx(0.05));
  CHECK_FALSE(top_over(wedge, {0.11, 0}).has_value());
}

TEST_CASE("over a box it is its top, in the middle and on an edge") {
  const std::vector<Vec3> box = test::block({-0.1, -0.1, 0}, {0.1, 0.1, 0.2});
  CHECK(top_over(box, {0.03, -0.07}).value() == doctest::Approx(0.2));
  CHECK(top_over(box, {0.1, 0}).value() == doctest::Approx(0.2));
}

}  // namespace probe::expert
