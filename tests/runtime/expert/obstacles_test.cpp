#include "runtime/expert/obstacles.h"

#include <doctest/doctest.h>

#include "runtime/policy/policy.h"

namespace probe::expert {
namespace {

Prism block() {
  return make_prism({{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}}, 0.2, 0.3);
}

TEST_CASE("distances to a block are those of solid geometry") {
  const auto at = [](const Vec3& p) { return distance_to(block(), p).value; };
  CHECK(at({0, 0, 0.35}) == doctest::Approx(0.05));
  CHECK(at({0, 0, 0.1}) == doctest::Approx(0.1));
  CHECK(at({0.13, 0, 0.25}) == doctest::Approx(0.03));
  CHECK(at({0.13, 0.09, 0.25}) == doctest::Approx(0.05));
  CHECK(at({0.13, 0, 0.34}) == doctest::Approx(0.05));
  CHECK(at({0, 0, 0.25}) == doctest::Approx(-0.05));
  CHECK(at({0.09, 0, 0.25}) == doctest::Approx(-0.01));
  CHECK(at({0, 0, 0.29}) == doctest::Approx(-0.01));
}

TEST_CASE("the gradient is that of finite differences, inside and outside") {
  policy::Draws draws(11);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(0.4 * draws.uniform() - 0.2, 0.3 * draws.uniform() - 0.15,
                 0.1 + 0.3 * draws.uniform());
    const Distance d = distance_to(block(), p);
    CHECK(d.gradient.norm() == doctest::Approx(1));
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = kStep * Vec3::Unit(k);
      const double slope =
          (distance_to(block(), p + e).value - distance_to(block(), p - e).value) / (2 * kStep);
      CHECK(d.gradient[k] == doctest::Approx(slope).epsilon(1e-4));
    }
  }
}

TEST_CASE("the nearest of many counts, the floor too, as far as asked") {
  Obstacles obstacles;
  obstacles.floor = 0.1;
  obstacles.prisms = {block()};
  CHECK(obstacles.nearest({0, 0, 0.32}, 0.5).value == doctest::Approx(0.02));
  CHECK(obstacles.nearest({0.5, 0, 0.11}, 0.5).value == doctest::Approx(0.01));
  CHECK(obstacles.nearest({0.5, 0, 0.5}, 0.05).value == doctest::Approx(0.05));
  CHECK(obstacles.nearest({0, 0, 0.25}, 0.01).value == doctest::Approx(-0.05));
}

}  // namespace
}  // namespace probe::expert
