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
  const auto travel =
      Travel::of(*a->model.scenes.begin(), *a->model.fixtures.begin(), test::asset_root());
  REQUIRE(travel);
  // The drawer's box of 10 cm slides by 20 cm along the world's y, for the chest is turned by 90
  // degrees.
  double low = 1, high = -1, last = -1, widest = 0;
  for (const PartBox& box : travel->everywhere().all()) {
    if (box.part != 1) continue;
    low = std::min(low, box.solid.centre.y());
    high = std::max(high, box.solid.centre.y());
    const double position = travel->joints_of(box)[0];
    if (last >= 0) widest = std::max(widest, position - last);
    last = position;
    CHECK(box.solid.centre.y() == doctest::Approx(0.3 + position));
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

TEST_CASE("what many joints carry is looked at in so many places, however many joints there are") {
  std::string links = "<link name=\"l0\"/>", joints;
  for (int i = 1; i <= 26; ++i) {
    const std::string n = std::to_string(i), above = std::to_string(i - 1);
    links += "<link name=\"l" + n +
             "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" "
             "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><box "
             "size=\"0.01 0.01 0.01\"/></geometry></collision></link>";
    joints += "<joint name=\"j" + n + "\" type=\"revolute\"><parent link=\"l" + above +
              "\"/><child link=\"l" + n +
              "\"/><origin xyz=\"0 0 0.01\"/><axis xyz=\"0 1 0\"/><limit lower=\"0\" "
              "upper=\"0.001\" effort=\"1\" velocity=\"1\"/></joint>";
  }
  test::write_text(std::filesystem::path(test::asset_root()) / "chain/chain.urdf",
                   "<robot name=\"chain\">" + links + joints + "</robot>");
  const auto a = test::analyze_with_suite(
      "fixture chain { urdf \"chain/chain.urdf\"; at (0cm, 30cm, 85cm) }\n"
      "scene room like bench { fixture chain }\n");
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  const auto travel =
      Travel::of(*a->model.scenes.begin(), *a->model.fixtures.begin(), test::asset_root());
  REQUIRE(travel);
  CHECK(travel->carriers(25).size() == 26);
  CHECK(travel->everywhere().all().size() < 26 * (2048 + 26 * 3));
}
