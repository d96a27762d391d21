#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

bool says(const test::Analysis& a, const std::string& text) {
  return a.said().find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("a number without its unit is reported with what the statement takes") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells spots = grid 2 x 2 at (-16, 0cm) spread (7cm, 7cm) }");
  CHECK(a->codes() == "P0302");
  CHECK(a->underlined() == "-16");
  const Diagnostic& said = a->diagnostics.items().front();
  CHECK(said.message == "expected a length, found a number");
  CHECK(said.primary_label == "`grid ... at` takes lengths");
  CHECK(said.helps.at(0) == "the surface is 100cm deep: did you mean `-16cm`?");
}

TEST_CASE("each statement wants its own dimension") {
  for (const char* text : {
           "object o like red { density 500 }",
           "object o like red { box 1cm x 1deg x 1cm }",
           "object o like red { rest yaw 90cm }",
           "object o like red { friction 0.5m }",
           "scene s like bench { surface 90deg area (0cm, 0cm) .. (1cm, 1cm) }",
           "scene s like bench { physics 500s friction 1 }",
           "layout l like pairs { drop 10s }",
           "layout l like pairs { drop 10cm settle 5cm }",
           "light l { ambient 0.3px }",
           "camera c like eye { lens 60, 60px, 32px, 24px }",
           "predicate p(a: object, d: length = 3s) = height(a) > d",
           "predicate p(a: object) = height(a) > 3",
           "predicate p(a: object) = height(a) + speed(a) > 3cm",
           "predicate p(a: object, d: length) = height(a) > d\nmetrics m { x = at end p(source, "
           "3deg) }",
           "scene s like bench { joints (0cm, 2cm, 2cm) }",
       }) {
    CAPTURE(text);
    const auto a = analyze_with_suite(text);
    CHECK_MESSAGE(a->codes() == "P0302", a->said());
  }
}

TEST_CASE("drives have the units of the joint they move") {
  const std::string head =
      "robot r { urdf \"arm/arm.urdf\"; tcp tool; fingers left opens +y, right opens -y; control "
      "ee_delta_pose 5Hz\n"
      "grip 1cm .. 4cm friction 2 patch 1cm\n";
  CHECK(analyze_with_suite(head + "drive waist stiffness 1N/m damping 1Ns/m limit 1N }")->codes() ==
        "P0302");
  CHECK(analyze_with_suite(head + "drive l stiffness 1Nm/rad damping 1Nms/rad limit 1Nm }")
            ->codes() == "P0302");
  CHECK(analyze_with_suite(head + "drive l stiffness 1N/m damping 1Nms/rad limit 1N }")->codes() ==
        "P0302");
  CHECK(analyze_with_suite(head + "drive t stiffness 1N/m damping 1Ns/m limit 1N }")->codes() ==
        "P0302");
  CHECK(analyze_with_suite(head + "drive elbow stiffness 1N/m damping 1Ns/m limit 1N }")->codes() ==
        "P0201");
  CHECK(analyze_with_suite(head +
                           "drive waist stiffness 1Nm/rad damping 1Nms/rad limit 1Nm\n"
                           "drive l, r stiffness 1N/m damping 1Ns/m limit 1N }")
            ->codes() == "");
}

TEST_CASE("values that cannot be are out of range") {
  CHECK(analyze_with_suite("object o like red { density 0kg/m3 }")->codes() == "P0304");
  CHECK(
      analyze_with_suite("object o like red { box (1cm, 0cm, 0cm) .. (0cm, 1cm, 1cm) }")->codes() ==
      "P0304");
  CHECK(analyze_with_suite("scene s like bench { joints (0rad, 2cm) }")->codes() == "P0304");
  CHECK(analyze_with_suite("object o like red { density 12345678901234567890123kg/m3 }")->codes() ==
        "P0304");
}

TEST_CASE("a number without a unit in a layout is answered with the surface it may mean") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells spots = grid 2 x 2 at (-16, 0cm) spread (10cm, 10cm) }");
  CHECK(a->codes() == "P0302");
  CHECK(says(*a, "the surface is 100cm deep: did you mean `-16cm`?"));
}
