// Where the Google robot's camera sees the cabinet: its top's corners from the nine places of visual
// matching, against the pixels that the released setup gives (forward kinematics, of which the
// released frames of b0 and b1 agree to 4 px).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "compiler/emit/analyzed.h"
#include "compiler/geometry/camera_pose.h"
#include "tests/parity/published.h"

using namespace probe;

namespace {

// Front +y, front -y, back -y, back +y.
struct Seen {
  const char* place;
  double pixels[8];
};
constexpr Seen kSeen[] = {
    {"a0", {629.6, 217.0, 218.7, 225.8, 252.6, 61.6, 494.4, 58.6}},
    {"a1", {598.2, 173.0, 234.9, 177.8, 262.4, 44.3, 486.8, 42.5}},
    {"a2", {554.9, 130.9, 235.1, 141.2, 252.0, 30.0, 459.2, 25.8}},
    {"b0", {518.7, 219.9, 106.4, 220.7, 193.9, 59.8, 436.0, 59.5}},
    {"b1", {498.6, 180.9, 127.7, 181.5, 201.5, 45.7, 428.8, 45.5}},
    {"b2", {468.1, 149.4, 130.6, 149.9, 199.2, 33.4, 413.4, 33.2}},
    {"c0", {374.0, 214.6, -33.1, 215.3, 110.9, 58.0, 351.2, 57.7}},
    {"c1", {358.5, 176.0, -12.5, 181.9, 110.0, 45.9, 337.3, 43.7}},
    {"c2", {353.5, 145.0, 16.4, 149.9, 121.2, 33.5, 335.3, 31.5}},
};
// 63 x 61.5 cm about the cabinet's place, (-0.295, 0), 86.5 cm above its own floor at 1.7 cm.
constexpr double kFront = 0.02, kBack = -0.61, kSide = 0.3075, kTop = 0.882;

}  // namespace

TEST_CASE("the Google robot's camera sees the cabinet where the release does, from all nine places") {
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/google.probe";
  const auto analyzed = analyze_text(std::span<const std::string>(&file, 1),
                                     {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                                      .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE(analyzed.ok());
  const sema::Model& model = analyzed->model;
  double worst = 0;
  for (const Seen& seen : kSeen) {
    const auto scene = std::ranges::find(model.scenes, std::string(seen.place), &sema::Scene::name);
    REQUIRE(scene != model.scenes.end());
    const sema::Camera& camera = model.cameras[scene->views.front().camera];
    const auto pose = sema::camera_pose(model, *scene, camera);
    REQUIRE(pose.has_value());
    const Vec3 corners[] = {{kFront, kSide, kTop},
                            {kFront, -kSide, kTop},
                            {kBack, -kSide, kTop},
                            {kBack, kSide, kTop}};
    for (std::size_t i = 0; i < 4; ++i) {
      // Forward x, left y, up z.
      const Vec3 at = pose->rotation.conjugate() * (corners[i] - pose->position);
      const double u = camera.cx - camera.fx * at.y() / at.x();
      const double v = camera.cy - camera.fy * at.z() / at.x();
      const double off = std::hypot(u - seen.pixels[2 * i], v - seen.pixels[2 * i + 1]);
      CAPTURE(seen.place);
      CAPTURE(i);
      CHECK(off < 4);
      worst = std::max(worst, off);
    }
  }
  MESSAGE("36 corners, at most " << worst << " px from the released ones");
}
