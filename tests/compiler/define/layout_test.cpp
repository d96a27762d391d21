#include <doctest/doctest.h>

#include <cmath>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

// "red(-0.1,0.1) tray(...)" of one start.
std::string places(const test::Analysis& a, const sema::Task& task, std::size_t episode) {
  std::string text;
  for (const auto& placed : task.starts[episode].placed) {
    char part[96];
    std::snprintf(part, sizeof part, "%s%s(%.17g,%.17g)", text.empty() ? "" : " ",
                  a.model.objects[placed.object].name.c_str(), placed.x, placed.y);
    text += part;
  }
  return text;
}

}  // namespace

TEST_CASE("the first line of a layout varies slowest and the turn fastest") {
  const auto a = analyze_with_suite("");
  const sema::Task& task = a->task("red_on_tray");
  REQUIRE(task.starts.size() == 24);
  CHECK(places(*a, task, 0) ==
        "red(-0.10000000000000001,-0.10000000000000001) "
        "tray(-0.10000000000000001,0.10000000000000001)");
  CHECK(places(*a, task, 1) == places(*a, task, 0));
  CHECK(task.starts[0].placed[0].turn.rotation == std::array<double, 4>{1, 0, 0, 0});
  CHECK(task.starts[1].placed[0].turn.rotation[3] == doctest::Approx(std::sqrt(0.5)));
  CHECK(task.starts[2].placed[1].x == 0.1);
  CHECK(task.starts[2].placed[1].y == -0.1);
  CHECK(task.starts[6].placed[0].y == 0.1);
  CHECK(task.starts[6].placed[1].y == -0.1);
}

TEST_CASE("distractors fill the remaining cells in the order of their declaration") {
  const auto a = analyze_with_suite("variant v of red_on_tray { distractors blue, pale }");
  const sema::Task& task = a->task("v");
  REQUIRE(task.starts.size() == 24);
  CHECK(task.starts[0].placed.size() == 4);
  CHECK(task.starts[0].placed[2].x == 0.1);
  CHECK(task.starts[0].placed[2].y == -0.1);
  CHECK(task.starts[0].placed[3].y == 0.1);
}

TEST_CASE("two spreads are two grids in turn that never mix") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells spots = grid 2 x 2 at (-16cm, 0cm) spread (5cm, 5cm), (10cm, "
      "10cm)\n"
      "orient source yaw 0deg }\ntask t like red_on_tray { layout l }");
  const sema::Task& task = a->task("t");
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(task.starts.size() == 24);
  CHECK(task.starts[0].placed[0].x == -0.21);
  CHECK(task.starts[11].placed[0].x == -0.11);
  CHECK(task.starts[12].placed[0].x == -0.26);
}

TEST_CASE("a grid of four steps has the thirds of a spread, rounded once") {
  const auto a = analyze_with_suite(
      "layout l { cells patch = grid 2 x 4 at (-10.5cm, 20.6cm) spread (1cm, 1.5cm); place source "
      "in distinct patch\n"
      "place target at (-12.5cm, 2.5cm); orient source yaw 0deg, yaw 45deg, yaw -45deg; drop 50cm "
      "settle 1s; "
      "expect 24 episodes }\n"
      "task t like red_on_tray { layout l }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const sema::Task& task = a->task("t");
  REQUIRE(task.starts.size() == 24);
  CHECK(task.starts[0].placed[0].x == -0.115);
  CHECK(task.starts[0].placed[0].y == 0.191);
  CHECK(task.starts[3].placed[0].y == 0.201);
  CHECK(task.starts[6].placed[0].y == 0.211);
  CHECK(task.starts[12].placed[0].x == -0.095);
  CHECK(task.starts[12].placed[1].x == -0.125);
}

TEST_CASE("a pose of a task replaces the rest poses of that object only there") {
  const auto a = analyze_with_suite("variant v of red_on_tray { pose red yaw 0deg, yaw 0deg }");
  CHECK(a->task("v").starts[1].placed[0].turn == a->task("v").starts[0].placed[0].turn);
  CHECK_FALSE(a->task("red_on_tray").starts[1].placed[0].turn ==
              a->task("red_on_tray").starts[0].placed[0].turn);
  CHECK(a->task("v").axes == static_cast<std::uint32_t>(plan::Axis::kLayout));
}

TEST_CASE("turns are exact at multiples of ninety degrees and free of negative zeros") {
  const auto a = analyze_with_suite("object o like red { rest yaw 180deg, roll 90deg yaw 90deg }");
  const sema::Object& object = a->model.objects[static_cast<sema::ObjectId>(4)];
  CHECK(object.rest[0].rotation == std::array<double, 4>{0, 0, 0, 1});
  CHECK_FALSE(std::signbit(object.rest[0].rotation[0]));
  // Roll first, then yaw, about the world's axes: q = qz qx.
  for (const double part : object.rest[1].rotation) CHECK(part == doctest::Approx(0.5));
}

TEST_CASE("more objects than cells, unmet expectations and unplaced objects are reported") {
  CHECK(analyze_with_suite(
            "layout l like pairs { cells spots = grid 1 x 2 at (0cm, 0cm) spread (10cm, 10cm) }\n"
            "task t like red_on_tray { layout l; distractors blue }")
            ->codes() == "P0503");
  CHECK(analyze_with_suite(
            "layout l like pairs { expect 23 episodes }\ntask t like red_on_tray { layout l }")
            ->codes() == "P0504");
  CHECK(analyze_with_suite("layout l { place source at (0cm, 0cm); drop 1cm settle 1s }\ntask t "
                           "like red_on_tray { layout l }")
            ->codes() == "P0206");
  CHECK(analyze_with_suite("object o like red { rest yaw 0deg, yaw 1deg, yaw 2deg }\ntask t like "
                           "red_on_tray { source o }")
            ->codes() == "P0304");
}

TEST_CASE(
    "objects that overlap at the start are reported once for the task, with depth and episode") {
  const auto a = analyze_with_suite(
      "layout tight like pairs { cells spots = grid 2 x 2 at (0cm, 0cm) spread (2cm, 2cm) }\n"
      "variant v of red_on_tray { layout tight }");
  CHECK_MESSAGE(a->codes() == "P0501", a->said());
  CHECK(a->diagnostics.items().front().message ==
        "`red` and `tray` overlap by 1cm in `v`; 8 of 24 object pairs overlap in this task");
  // A block of 4cm x 2cm and a tray of 6cm square, side by side along the block: 2cm + 3cm apart.
  const Label& label = a->diagnostics.items().front().labels.front();
  CHECK(a->sources.text(label.span) == "(2cm, 2cm)");
  CHECK(label.text == "2.5cm is the least that fits these objects");
  CHECK(analyze_with_suite("layout fits like pairs { cells spots = grid 2 x 2 at (0cm, 0cm) spread "
                           "(2.5cm, 2.5cm) }\nvariant v of red_on_tray { layout fits }")
            ->codes() == "");
}

TEST_CASE("the advised spread keeps the shape of the grid, and there is none for fixed places") {
  const auto a = analyze_with_suite(
      "layout tight like pairs { cells spots = grid 2 x 2 at (0cm, 0cm) spread (2cm, 1cm) }\n"
      "variant v of red_on_tray { layout tight }");
  REQUIRE(a->codes() == "P0501");
  const std::string advice = a->diagnostics.items().front().labels.front().text;
  CHECK(advice == "(5cm, 2.5cm) is the least that fits these objects");
  const auto fixed = analyze_with_suite(
      "layout l { place source at (0cm, 0cm); place target at (1cm, 0cm); drop 1cm settle 1s }\n"
      "variant v of red_on_tray { layout l }");
  REQUIRE(fixed->codes() == "P0501");
  CHECK(fixed->diagnostics.items().front().labels.front().text == "the layout");
}

TEST_CASE("an object that the camera does not see is doubted once for the task") {
  const std::string narrow =
      "camera narrow like eye { lens 60px, 60px, 32px, 24px }\n"
      "variant v of red_on_tray { camera narrow }";
  const auto a = analyze_with_suite(narrow);
  REQUIRE_MESSAGE(a->codes() == "P0505", a->said());
  CHECK(a->diagnostics.items().front().severity == Severity::kWarning);
  const std::string said = a->diagnostics.items().front().message;
  CHECK_MESSAGE(said.find("the image of `narrow` in `v`; 12 of 48 objects") != said.npos, said);
  CHECK(analyze_with_suite("@allow(out_of_frame, \"why\")\n" + narrow)->diagnostics.has_errors() ==
        false);
  const auto away = analyze_with_suite(
      "camera away like eye { mount arm.base at (0cm, 0cm, 1m) look (-1, 0, -0.1) }\n"
      "variant v of red_on_tray { camera away }");
  REQUIRE_MESSAGE(away->codes() == "P0505", away->said());
  CHECK(away->diagnostics.items().front().message.find("lies behind `away`") != std::string::npos);
}

TEST_CASE("a camera that moves with the arm is not asked what it sees") {
  const auto a = analyze_with_suite(
      "camera hand like eye { mount arm.wrist at (0cm, 0cm, 1m) look (-1, 0, -0.1) }\n"
      "variant v of red_on_tray { camera hand }");
  CHECK_MESSAGE(a->codes() == "", a->said());
}

TEST_CASE("an object over the edge or out of reach is reported") {
  CHECK(
      analyze_with_suite("scene s like bench { surface 80cm area (-10cm, -10cm) .. (10cm, 10cm) }\n"
                         "task t like red_on_tray { scene s }")
          ->codes() == "P0505");
  const auto far = analyze_with_suite(
      "robot arm2 { urdf \"arm/arm.urdf\"; tcp tool; fingers left opens +y, right opens -y; "
      "control ee_delta_pose 5Hz; reach 1cm .. 30cm\n"
      "drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm; drive l, r stiffness 1000N/m "
      "damping 200Ns/m limit 60N\n"
      "grip 1cm .. 4cm friction 2 patch 1cm }\n"
      "camera eye2 like eye { mount arm2.base at (0cm, 0cm, 1m) look (1, 0, -1) }\n"
      "scene s like bench { robot arm2 at (50cm, 0cm) yaw 180deg; camera eye2 }\n"
      "task t like red_on_tray { scene s }");
  CHECK_MESSAGE(far->codes() == "P0502", far->said());
}

TEST_CASE("a start over the edge says where the surface ends, unmet starts say their factors") {
  const auto edge = analyze_with_suite(
      "scene s like bench { surface 80cm area (-10cm, -12cm) .. (10cm, 10cm) }\n"
      "task t like red_on_tray { scene s }");
  REQUIRE(edge->codes() == "P0505");
  CHECK(edge->diagnostics.items().front().labels.back().text ==
        "the surface is x -10cm .. 10cm, y -12cm .. 10cm");
  const auto unmet = analyze_with_suite(
      "layout l like pairs { expect 23 episodes }\ntask t like red_on_tray { layout l }");
  REQUIRE(unmet->codes() == "P0504");
  CHECK(unmet->diagnostics.items().front().message ==
        "`t` has 24 episodes (12 placements x 2 turns), not 23");
}
