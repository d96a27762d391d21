#include <doctest/doctest.h>

#include <filesystem>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

bool says(const test::Analysis& a, const std::string& text) {
  return a.said().find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("magnitudes that nobody means are doubted, with the unit that would fit") {
  const auto grid = analyze_with_suite("layout l like pairs { drop 50m }");
  CHECK(grid->codes() == "P0303");
  CHECK(says(*grid, "did you mean `50cm`?"));
  CHECK(analyze_with_suite("layout l like pairs { drop 10cm settle 45s }")->codes() == "P0303");
  CHECK(analyze_with_suite("object o like red { box 4m x 2cm x 2cm }")->codes() == "P0303");
  CHECK(analyze_with_suite("object o like red { density 1e6kg/m3 }")->codes() == "P0303");
  CHECK(analyze_with_suite("scene s like bench { surface 80cm area (-16m, -50cm) .. (50cm, 50cm) }")
            ->codes() == "P0303");
  CHECK(analyze_with_suite("@allow(unit_slip, \"a tower\")\nlayout l like pairs { drop 2m }")
            ->codes() == "");
}

TEST_CASE("a density in grams, a turn in radians and a focal length in metres are doubted") {
  const auto said = [](const std::string& declaration) {
    const auto a = analyze_with_suite(declaration);
    return a->codes() == "P0303" && a->diagnostics.items().front().helps.size() == 1
               ? a->diagnostics.items().front().helps.front()
               : a->codes();
  };
  CHECK(said("object o like red { density 0.7kg/m3 }") == "did you mean `700kg/m3`?");
  CHECK(said("object o like red { rest yaw 1.5708deg }") == "did you mean `1.5708rad`?");
  CHECK(said("variant v of red_on_tray { pose red yaw 90rad, yaw 0deg }") ==
        "did you mean `90deg`?");
  CHECK(said("layout l like pairs { orient source yaw 3.14deg }") == "did you mean `3.14rad`?");
  CHECK(analyze_with_suite("object o like red { friction 50 }")->codes() == "P0303");
  CHECK(analyze_with_suite("layout l like pairs { orient source yaw 45deg, yaw 2deg }")->codes() ==
        "");
}

TEST_CASE("fingers that turn open by an angle, which is no way of 34 m") {
  std::string text = test::arm_urdf();
  for (std::size_t at; (at = text.find("prismatic")) != std::string::npos;)
    text.replace(at, 9, "revolute");
  test::write_text(std::filesystem::path(test::asset_root()) / "arm/turning.urdf", text);
  const auto said = [](const std::string& grip) {
    return analyze_with_suite(
               "robot odd like arm { urdf \"arm/turning.urdf\"\n"
               "drive l, r stiffness 30Nm/rad damping 2Nms/rad limit 4Nm\n" +
               grip + " friction 2 patch 1cm }")
        ->said();
  };
  CHECK(said("grip 0deg .. 34deg") == "");
  CHECK(said("grip 0rad .. 0.6rad") == "");
  CHECK(said("grip 0deg .. 0.6deg") == "");
  CHECK(said("grip 0rad .. 34rad").find("did you mean `34deg`?") != std::string::npos);
}
