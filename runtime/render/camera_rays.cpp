#include "runtime/render/camera_rays.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

Failure camera_failure(const std::string& message) {
  return {.code = Fault::kRender, .message = message, .where = "camera"};
}

// Of one tile, not yet of unit length.
struct Directions {
  alignas(64) std::array<double, kTileSamples> x, y, z;
};

PROBE_CLONES void normalise(const Directions& __restrict d, const double* __restrict axis,
                            float* __restrict dx, float* __restrict dy, float* __restrict dz,
                            float* __restrict cosine) {
  const double ax = axis[0], ay = axis[1], az = axis[2];
  for (std::size_t s = 0; s < kTileSamples; ++s) {
    const double x = d.x[s], y = d.y[s], z = d.z[s];
    const double length = std::sqrt(x * x + y * y + z * z);
    const double ux = x / length, uy = y / length, uz = z / length;
    dx[s] = static_cast<float>(ux);
    dy[s] = static_cast<float>(uy);
    dz[s] = static_cast<float>(uz);
    cosine[s] = static_cast<float>(ux * ax + uy * ay + uz * az);
  }
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

Status check_camera(const Camera& camera) {
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
  return {};
}

Status make_camera_rays(const Camera& camera, CameraRays& rays) {
  PROBE_TRY(check_camera(camera));
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

  // forward + (x - cx) / fx right is the same for a whole column, (y - cy) / fy down for a row.
  const Mat3& axes = camera.forward_left_up;
  const Vec3 forward = axes.col(0), right = -axes.col(1), down = -axes.col(2);
  std::vector<Vec3> columns(static_cast<std::size_t>(rays.tiles_x) * kTileSide);
  std::vector<Vec3> rows(static_cast<std::size_t>(rays.tiles_y) * kTileSide);
  for (std::size_t x = 0; x < columns.size(); ++x) {
    columns[x] = forward + (static_cast<double>(x) + 0.5 - camera.cx) / camera.fx * right;
  }
  for (std::size_t y = 0; y < rows.size(); ++y) {
    rows[y] = (static_cast<double>(y) + 0.5 - camera.cy) / camera.fy * down;
  }
  const double axis[3] = {forward.x(), forward.y(), forward.z()};
  Directions d;
  for (std::size_t tile = 0; tile < static_cast<std::size_t>(rays.tiles()); ++tile) {
    const Vec3* left = columns.data() + tile % static_cast<std::size_t>(rays.tiles_x) * kTileSide;
    const Vec3* top = rows.data() + tile / static_cast<std::size_t>(rays.tiles_x) * kTileSide;
    for (std::size_t s = 0; s < kTileSamples; ++s) {
      const Vec3& column = left[kTileOffsets[s].x];
      const Vec3& row = top[kTileOffsets[s].y];
      d.x[s] = column.x() + row.x();
      d.y[s] = column.y() + row.y();
      d.z[s] = column.z() + row.z();
    }
    const std::size_t base = tile * kTileSamples;
    normalise(d, axis, rays.dx.data() + base, rays.dy.data() + base, rays.dz.data() + base,
              rays.cosine.data() + base);
  }
  rays.nearest_depth =
      kNearest * std::min(1.0f, *std::min_element(rays.cosine.begin(), rays.cosine.end()));
  return {};
}

}  // namespace probe::render
