#include "runtime/inspect/top_view.h"

#include <cmath>

#include "runtime/inspect/ground_image.h"
#include "runtime/inspect/svg.h"
#include "tests/runtime/inspect/small_plan.h"

using namespace probe;
using namespace probe::inspect;

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

double area(const std::vector<Point>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point& a = outline[i];
    const Point& b = outline[(i + 1) % outline.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return twice / 2;
}

}  // namespace

TEST_CASE("the outline of a lying box is its rectangle, counter-clockwise") {
  const auto outline = box_outline({Vec3(0.3, 0, 0), Vec3(0, 0.2, 0), Vec3(0, 0, 0.1)});
  CHECK(outline == std::vector<Point>{{-0.3, -0.2}, {0.3, -0.2}, {0.3, 0.2}, {-0.3, 0.2}});
}

TEST_CASE("the outline of a box on its corner is a hexagon") {
  const Quat turn = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3::UnitZ());
  const auto outline =
      box_outline({turn * Vec3::UnitX(), turn * Vec3::UnitY(), turn * Vec3::UnitZ()});
  CHECK(outline.size() == 6);
  CHECK(area(outline) == doctest::Approx(4 * std::sqrt(3.0)));
}

TEST_CASE("a camera that looks straight down frames a rectangle of its lens") {
  Pinhole camera{
      .eye = {1, 2, 3}, .width = 640, .height = 480, .fx = 320, .fy = 320, .cx = 320, .cy = 240};
  camera.axes << Vec3(0, 0, -1), Vec3(0, 1, 0), Vec3(1, 0, 0);
  const auto frame = frame_on_plane(camera, 1, 20);
  REQUIRE(frame.size() == 4);
  CHECK((frame[0] - Vec3(2.5, 4, 1)).norm() < 1e-12);
  CHECK((frame[2] - Vec3(-0.5, 0, 1)).norm() < 1e-12);
}

TEST_CASE(
    "a camera that sees the horizon frames what is not too far; from below it frames nothing") {
  Pinhole camera{
      .eye = {0, 0, 1}, .width = 640, .height = 480, .fx = 320, .fy = 320, .cx = 320, .cy = 240};
  camera.axes = Mat3::Identity();
  const auto frame = frame_on_plane(camera, 0, 10);
  REQUIRE(frame.size() == 4);
  for (const Vec3& corner : frame) {
    CHECK(corner.z() == doctest::Approx(0).epsilon(1e-12));
    CHECK(corner.x() <= 10 + 1e-9);
  }
  CHECK(frame_on_plane(camera, 2, 10).empty());
}

TEST_CASE("a top view has every way in which things stand once, with its starts") {
  const auto view = top_view(test::small_plan(), test::task("crowded"), test::asset_root());
  REQUIRE(view.ok());
  CHECK(view->cells.size() == 4);
  std::size_t starts[3] = {0, 0, 0};
  for (const Footprint& print : view->footprints) {
    starts[static_cast<std::size_t>(print.role)] += print.starts.size();
    CHECK(area(print.outline) ==
          doctest::Approx(print.object == "plate" ? 0.11 * 0.11 : 0.115 * 0.032));
  }
  CHECK(starts[0] == 24);
  CHECK(starts[1] == 24);
  CHECK(starts[2] == 24);
  CHECK(view->base == Point{0.147, 0.028});
  CHECK(view->base_yaw_deg == 180);
  // The camera's mount is the base, which is turned by half a turn.
  REQUIRE(view->cameras.size() == 1);
  CHECK(view->cameras[0].eye.x == doctest::Approx(0.147));
  CHECK(view->cameras[0].eye.y == doctest::Approx(0.188));
  CHECK(view->cameras[0].image.size() == 4);
  // It looks along (1, 0.553, ..) of that base: its right is to the left of -x, along +y.
  CHECK(view->cameras[0].right.x == doctest::Approx(-0.553 / std::sqrt(1 + 0.553 * 0.553)));
  CHECK(view->cameras[0].right.y == doctest::Approx(1 / std::sqrt(1 + 0.553 * 0.553)));
}

TEST_CASE("the picture is the same every time, needs no other file and says what it shows") {
  const auto view = top_view(test::small_plan(), test::task("crowded"), test::asset_root());
  REQUIRE(view.ok());
  const std::string svg = to_svg(*view);
  CHECK(svg == to_svg(*view));
  CHECK(svg.substr(0, 39) == "<svg xmlns=\"http://www.w3.org/2000/svg\"");
  CHECK(svg.substr(svg.size() - 7) == "</svg>\n");
  CHECK(count_of(svg, "http") == 1);
  CHECK(count_of(svg, "fill-opacity=\"0.12\"") == view->footprints.size());
  CHECK(count_of(svg, "<g") == count_of(svg, "</g>"));
  CHECK(svg.find(">put carrot on plate</text>") != std::string::npos);
  CHECK(svg.find("<title>carrot at (-23.5, -7.5) cm, yaw 180 deg: starts ") != std::string::npos);
  CHECK(svg.find(">source: carrot<") != std::string::npos);
  CHECK(svg.find(">distractors: twig<") != std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
}

TEST_CASE("characters that mean something in SVG are written as text") {
  auto view = top_view(test::small_plan(), test::task("base"), test::asset_root());
  REQUIRE(view.ok());
  view->prompt = "put <a> & \"b\"";
  CHECK(to_svg(*view).find(">put &lt;a&gt; &amp; &quot;b&quot;</text>") != std::string::npos);
}

TEST_CASE("an arm that is not the plan's is named") {
  const auto view = top_view(test::small_plan(), test::task("base"), "/nowhere");
  REQUIRE_FALSE(view.ok());
  CHECK(view.failure().code == Fault::kAsset);
  CHECK(view.failure().where.find("wx250s.urdf") != std::string::npos);
}
