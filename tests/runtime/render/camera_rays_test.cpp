#include <doctest/doctest.h>

#include "runtime/render/camera_rays.h"

namespace probe::render {
namespace {

TEST_CASE("the camera of the table scene looks where its published numbers say") {
  const Pose base{Vec3(0.147, 0.028, 0.870), Quat(0, 0, 0, 1)};
  const Vec3 position = base.apply(Vec3(0, -0.16, 0.36));
  const Result<Mat3> local = look_along(Vec3(1, 0.553, -1.085));
  REQUIRE(local.ok());
  const Mat3 axes = base.rotation.toRotationMatrix() * local.value();
  CHECK((position - Vec3(0.147, 0.188, 1.230)).norm() < 1e-3);
  CHECK((axes.col(0) - Vec3(-0.6346, -0.3509, -0.6886)).norm() < 1e-3);
  CHECK((-axes.col(1) - Vec3(-0.4839, 0.8751, 0)).norm() < 1e-3);
  CHECK((-axes.col(2) - Vec3(0.6026, 0.3332, -0.7252)).norm() < 1e-3);

  const Camera camera{position, axes, 640, 480, 623.588, 623.588, 319.501, 239.545};
  CameraRays rays;
  REQUIRE(make_camera_rays(camera, rays).ok());
  // Image point (162, 75) is the corner between pixels; its ray lies half a pixel before that of
  // pixel (162, 75).
  const Vec3 d = camera.forward_left_up *
                 Vec3(1, -(162 - camera.cx) / camera.fx, -(75 - camera.cy) / camera.fy);
  const Vec3 hit = position + (0.87 - position.z()) / d.z() * d;
  CHECK((hit - Vec3(-0.339, -0.290, 0.87)).norm() < 1e-3);

  // The stored ray of pixel (162, 75): tile (10, 4), offset (2, 11).
  std::size_t sample = 0;
  while (kTileOffsets[sample].x != 2 || kTileOffsets[sample].y != 11) ++sample;
  const std::size_t k = static_cast<std::size_t>(4 * rays.tiles_x + 10) * kTileSamples + sample;
  const Vec3 expected = (camera.forward_left_up *
                         Vec3(1, -(162.5 - camera.cx) / camera.fx, -(75.5 - camera.cy) / camera.fy))
                            .normalized();
  CHECK((Vec3(rays.dx[k], rays.dy[k], rays.dz[k]) - expected).norm() < 1e-6);
}

TEST_CASE(
    "a ray is the unit vector that the formula gives, to the last bit, wherever the camera is") {
  CameraRays rays;  // one for all sizes, as a camera that moves fills its own again
  for (int k = 0; k < 4; ++k) {
    Camera camera{Vec3(0.1 * k, -0.2, 1),
                  Mat3::Identity(),
                  40 - 9 * k,
                  24 + 8 * k,
                  31.25 + k,
                  29.5,
                  17.3,
                  11.9 - k};
    camera.forward_left_up = look_along(Vec3(1 + k, 0.3 - 0.4 * k, -1.1)).value();
    REQUIRE(make_camera_rays(camera, rays).ok());
    const Vec3 forward = camera.forward_left_up.col(0), right = -camera.forward_left_up.col(1),
               down = -camera.forward_left_up.col(2);
    int wrong = 0;
    for (int tile = 0; tile < rays.tiles(); ++tile) {
      for (std::size_t s = 0; s < kTileSamples; ++s) {
        const double x = tile % rays.tiles_x * kTileSide + kTileOffsets[s].x + 0.5;
        const double y = tile / rays.tiles_x * kTileSide + kTileOffsets[s].y + 0.5;
        const Vec3 d =
            (forward + (x - camera.cx) / camera.fx * right + (y - camera.cy) / camera.fy * down)
                .normalized();
        const std::size_t i = static_cast<std::size_t>(tile) * kTileSamples + s;
        wrong += rays.dx[i] != static_cast<float>(d.x()) || rays.dy[i] != static_cast<float>(d.y());
        wrong += rays.dz[i] != static_cast<float>(d.z()) ||
                 rays.cosine[i] != static_cast<float>(d.dot(forward));
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("eight samples in a row are four pixels by two and sixty-four are a block") {
  for (std::size_t first = 0; first < kTileSamples; first += 8) {
    for (std::size_t k = 0; k < 8; ++k) {
      CHECK(kTileOffsets[first + k].x / 4 == kTileOffsets[first].x / 4);
      CHECK(kTileOffsets[first + k].y / 2 == kTileOffsets[first].y / 2);
      CHECK(kTileOffsets[first + k].x / 8 == static_cast<int>(first / 64 % 2));
      CHECK(kTileOffsets[first + k].y / 8 == static_cast<int>(first / 128));
    }
  }
}

TEST_CASE("a camera that cannot see is refused") {
  CHECK_FALSE(look_along(Vec3(0, 0, -1)).ok());
  CHECK_FALSE(look_along(Vec3(0, 0, 0)).ok());
  Camera camera;
  CameraRays rays;
  camera.width = 0;
  CHECK_FALSE(make_camera_rays(camera, rays).ok());
  camera.width = 64;
  camera.fx = -1;
  CHECK_FALSE(make_camera_rays(camera, rays).ok());
  camera.fx = 1;
  camera.forward_left_up(0, 0) = 2;
  CHECK_FALSE(make_camera_rays(camera, rays).ok());
}

}  // namespace
}  // namespace probe::render
