#include "compiler/geometry/part_boxes.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace probe;
using namespace probe::sema;

TEST_CASE("what is near is found as by looking at all boxes, in their order") {
  // Parts on curved ways of different lengths, and one that is somewhere else between two others.
  std::vector<PartBox> boxes;
  const std::size_t lengths[] = {1, 31, 32, 33, 100, 1, 70};
  for (std::uint32_t part = 0; part < std::size(lengths); ++part) {
    for (std::size_t i = 0; i < lengths[part]; ++i) {
      const double way = 0.01 * static_cast<double>(i);
      const Vec3 low(0.3 * part, std::sin(way), 0.2 * std::cos(3 * way));
      PartBox box;
      box.part = part % 5;
      box.sample = static_cast<std::uint32_t>(boxes.size());
      box.solid = scene::upright_solid(low, low + Vec3(0.1, 0.02, 0.03));
      box.half = box.solid.half_extent();
      boxes.push_back(box);
    }
  }
  const PartBoxes known(boxes);
  REQUIRE(known.all().size() == boxes.size());
  std::size_t met = 0;
  for (double x = -0.2; x < 2.4; x += 0.07) {
    for (double y = -0.1; y < 1; y += 0.06) {
      const Vec3 centre(x, y, 0.1 * std::sin(7 * x)), half(0.04, 0.05, 0.03);
      std::vector<std::uint32_t> all, near;
      for (const PartBox& box : boxes) {
        if (may_overlap(box, centre, half)) all.push_back(box.sample);
      }
      known.each_near(centre, half, [&](const PartBox& box) { near.push_back(box.sample); });
      CHECK(near == all);
      met += all.size();
    }
  }
  CHECK(met > 100);
}

TEST_CASE("of no boxes none is near") {
  int met = 0;
  PartBoxes().each_near(Vec3::Zero(), Vec3::Ones(), [&](const PartBox&) { ++met; });
  CHECK(met == 0);
}
