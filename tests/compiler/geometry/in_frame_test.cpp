#include "compiler/geometry/in_frame.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

// Each corner turned, set down and projected by itself.
std::optional<double> corner_by_corner(const sema::Object& object,
                                       const sema::Start::Placed& placed, const Pose& eye,
                                       const sema::Camera& camera, double surface_z) {
  const auto& q = placed.turn.rotation;
  const Quat turn(q[0], q[1], q[2], q[3]);
  std::vector<Vec3> corners;
  double lowest = 1e9, most = 0;
  for (const double x : {object.box_min[0], object.box_max[0]})
    for (const double y : {object.box_min[1], object.box_max[1]})
      for (const double z : {object.box_min[2], object.box_max[2]}) {
        corners.push_back(turn * Vec3(x, y, z));
        lowest = std::min(lowest, corners.back().z());
      }
  int outside = 0;
  for (const Vec3& corner : corners) {
    const Vec3 seen = eye.inverse().apply(corner + Vec3(placed.x, placed.y, surface_z - lowest));
    if (seen.x() < 1e-3) return std::nullopt;
    const double u = camera.cx - camera.fx * seen.y() / seen.x();
    const double v = camera.cy - camera.fy * seen.z() / seen.x();
    const double out = std::max({0.0, -u, u - camera.width, -v, v - camera.height});
    outside += out > 0;
    most = std::max(most, out);
  }
  return outside > 4 ? most : 0;
}

}  // namespace

TEST_CASE("how far a box lies outside of a picture is what its corners say one by one") {
  const auto a = test::analyze_text(test::kSmallSuite);
  const sema::Scene& scene = a->model.scenes[sema::SceneId{0}];
  const sema::Camera& camera = a->model.cameras[sema::CameraId{0}];
  const auto frustum = sema::Frustum::of(a->model, scene, camera);
  REQUIRE(frustum);
  // The arm stands at (50cm, 0cm), on the surface, turned by 180deg; the camera 1 m above its base
  // looks along (1, 0, -1).
  const double eighth = std::sqrt((1 + std::sqrt(0.5)) / 2),
               rest = std::sqrt((1 - std::sqrt(0.5)) / 2);
  const Pose base{{0.5, 0, scene.base_position[2]}, Quat(0, 0, 0, 1)};
  const Pose eye = base * Pose{{0, 0, 1}, Quat(eighth, 0, rest, 0)};
  sema::Object box = a->model.objects[sema::ObjectId{0}];
  box.box_min = {-0.07, -0.01, 0.02};
  box.box_max = {0.11, 0.05, 0.03};
  std::size_t inside = 0, outside = 0, behind = 0;
  for (int i = 0; i < 400; ++i) {
    const Quat turn =
        Quat(std::cos(i), std::sin(2.0 * i), std::sin(3.0 * i), std::cos(5.0 * i)).normalized();
    const sema::Start::Placed placed{sema::ObjectId{0},
                                     1.5 * std::sin(7.0 * i),
                                     1.2 * std::cos(11.0 * i),
                                     {{turn.w(), turn.x(), turn.y(), turn.z()}}};
    const auto wanted = corner_by_corner(box, placed, eye, camera, scene.surface_z);
    const auto found = frustum->outside(box, placed);
    CAPTURE(i);
    REQUIRE(found.has_value() == wanted.has_value());
    if (found) CHECK(*found == doctest::Approx(*wanted).epsilon(1e-9));
    ++(!wanted ? behind : *wanted > 0 ? outside : inside);
  }
  CHECK(inside > 20);
  CHECK(outside > 20);
  CHECK(behind > 20);
}
