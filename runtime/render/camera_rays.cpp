#include "runtime/render/camera_rays.h"

#include <algorithm>
#include <cmath>

namespace probe::render {
namespace {

Failure camera_failure(const std::string& message) {
  return {.code = "render", .message = message, .where = "camera"};
}

}  // namespace

Result<Mat3> look_along(const Vec3& direction) {
  const double length = direction.norm();
  if (!direction.allFinite() || !(length > 0)) {
    return camera_failure("the viewing direction must be finite and not zero");
  }
  const Vec3 forward = direction / length;
  const Vec3 across = Vec3::UnitZ().cross(forward);
  if (across.norm() < 1e-9) {
    return camera_failure(
        "a viewing direction parallel to z leaves left and up open; give a quaternion");
  }
  const Vec3 left = across.normalized();
  Mat3 axes;
  axes << forward, left, forward.cross(left);
  return axes;
}

Camera sample_camera(Camera camera, int samples) {
  camera.width *= samples;
  camera.height *= samples;
  camera.fx *= samples;
  camera.fy *= samples;
  camera.cx *= samples;
  camera.cy *= samples;
  return camera;
}

Result<CameraRays> make_camera_rays(const Camera& camera) {
  constexpr int kMaxSide = 8192;
  if (camera.width < 1 || camera.height < 1 || camera.width > kMaxSide ||
      camera.height > kMaxSide) {
    return camera_failure("a picture of " + std::to_string(camera.width) + " x " +
                          std::to_string(camera.height) + " pixels; sides are 1 to 8192");
  }
  const Mat3& axes = camera.forward_left_up;
  if (!std::isfinite(camera.fx) || !std::isfinite(camera.fy) || !(camera.fx > 0) ||
      !(camera.fy > 0) || !std::isfinite(camera.cx) || !std::isfinite(camera.cy)) {
    return camera_failure("focal lengths must be positive, the centre finite");
  }
  if (!camera.position.allFinite() || !axes.allFinite() ||
      (axes.transpose() * axes - Mat3::Identity()).norm() > 1e-6) {
    return camera_failure("the pose is not finite or its axes are not orthonormal");
  }

  CameraRays rays;
  rays.width = camera.width;
  rays.height = camera.height;
  rays.tiles_x = (camera.width + kTileSide - 1) / kTileSide;
  rays.tiles_y = (camera.height + kTileSide - 1) / kTileSide;
  for (int k = 0; k < 3; ++k) {
    rays.origin[static_cast<std::size_t>(k)] = static_cast<float>(camera.position[k]);
  }
  const std::size_t samples = static_cast<std::size_t>(rays.tiles()) * kTileSamples;
  rays.dx.resize(samples);
  rays.dy.resize(samples);
  rays.dz.resize(samples);
  rays.cosine.resize(samples);
  const Vec3 forward = axes.col(0), right = -axes.col(1), down = -axes.col(2);
  float least = 1;
  for (int ty = 0; ty < rays.tiles_y; ++ty) {
    for (int tx = 0; tx < rays.tiles_x; ++tx) {
      const std::size_t base = static_cast<std::size_t>(ty * rays.tiles_x + tx) * kTileSamples;
      for (std::size_t s = 0; s < kTileSamples; ++s) {
        const double x = tx * kTileSide + kTileOffsets[s].x + 0.5;
        const double y = ty * kTileSide + kTileOffsets[s].y + 0.5;
        const Vec3 d =
            (forward + (x - camera.cx) / camera.fx * right + (y - camera.cy) / camera.fy * down)
                .normalized();
        rays.dx[base + s] = static_cast<float>(d.x());
        rays.dy[base + s] = static_cast<float>(d.y());
        rays.dz[base + s] = static_cast<float>(d.z());
        rays.cosine[base + s] = static_cast<float>(d.dot(forward));
        least = std::min(least, rays.cosine[base + s]);
      }
    }
  }
  rays.nearest_depth = kNearest * least;
  return rays;
}

}  // namespace probe::render
