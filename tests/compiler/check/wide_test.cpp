// A source that is wider than the hand opens.
#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

// A hand that was measured: the arm under its name, with fingers that open by 37 mm.
std::string wide_of(const std::string& grip, const std::string& box) {
  std::string urdf = test::arm_urdf();
  urdf.replace(urdf.find("\"arm\""), 5, "\"wx250s\"");
  const std::string limit = "upper=\"1\"";
  for (std::size_t at = 0; (at = urdf.find(limit, at)) != std::string::npos;)
    urdf.replace(at, limit.size(), "upper=\"0.037\"");
  test::write_text(test::asset_root() + "/hand/hand.urdf", urdf);
  // A cube: what is felt is one convex part.
  test::write_text(test::asset_root() + "/objects/cube/visual.glb", "visual of cube");
  test::write_text(test::asset_root() + "/objects/cube/collision.obj",
                   "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv "
                   "-1 1 1\nf 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 "
                   "6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n");
  return test::analyze_with_suite("robot hand like arm { urdf \"hand/hand.urdf\"; grip " + grip +
                                  " }\nscene other like bench { robot hand at (50cm, 0cm) yaw "
                                  "180deg }\nobject brick like red { mesh \"cube\"; box " +
                                  box +
                                  "; name \"brick\" }\ntask t like red_on_tray { scene other; "
                                  "source brick }\n")
      ->said();
}

}  // namespace

TEST_CASE("a known hand that its grip does not open whole is judged by how far its fingers move") {
  const std::string small = "4.8cm x 4.8cm x 4.8cm", large = "9cm x 9cm x 9cm";
  CHECK_MESSAGE(wide_of("1cm .. 3.8cm", small).find("P1514") == std::string::npos,
                wide_of("1cm .. 3.8cm", small));
  CHECK_MESSAGE(wide_of("1cm .. 3.8cm", large).find("open to 5.2cm") != std::string::npos,
                wide_of("1cm .. 3.8cm", large));
  CHECK_MESSAGE(wide_of("1.5cm .. 2cm", small).find("move apart by 1cm") != std::string::npos,
                wide_of("1.5cm .. 2cm", small));
  CHECK(wide_of("1.5cm .. 2cm", large).find("open to") == std::string::npos);
}
