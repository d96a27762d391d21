#include "runtime/render/camera_rays.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

Failure camera_failure(const std::string& message) {
  return {.code = Fault::kRender, .message = message, .where = "camera"};
}

// Directions not yet of unit length, in the order of a tile's samples.
struct Directions {
  alignas(64) std::array<double, kTileSamples> x, y, z;

  void set(std::size_t s, const Vec3& d) {
    x[s] = d.x();
    y[s] = d.y();
    z[s] = d.z();
  }
};

// A tile's directions are the sum of its column's part and its row's. `least`: the least cosine of
// each place in a tile so far.
PROBE_CLONES void normalise(const Directions& __restrict across, const Directions& __restrict down,
                            const double* __restrict axis, float* __restrict dx,
                            float* __restrict dy, float* __restrict dz, float* __restrict cosine,
                            float* __restrict least) {
  const double ax = axis[0], ay = axis[1], az = axis[2];
  for (std::size_t s = 0; s < kTileSamples; ++s) {
    const double x = across.x[s] + down.x[s], y = across.y[s] + down.y[s],
                 z = across.z[s] + down.z[s];
    const double length = std::sqrt(x * x + y * y + z * z);
    const double ux = x / length, uy = y / length, uz = z / length;
    dx[s] = static_cast<float>(ux);
    dy[s] = static_cast<float>(uy);
    dz[s] = static_cast<float>(uz);
    const auto c = static_cast<float>(ux * ax + uy * ay + uz * az);
    cosine[s] = c;
    least[s] = c < least[s] ? c : least[s];
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
  std::vector<Directions> columns(static_cast<std::size_t>(rays.tiles_x));
  for (std::size_t tile = 0; tile < columns.size(); ++tile) {
    std::array<Vec3, kTileSide> steps;
    for (std::size_t k = 0; k < kTileSide; ++k) {
      const auto x = static_cast<double>(tile * kTileSide + k);
      steps[k] = forward + (x + 0.5 - camera.cx) / camera.fx * right;
    }
    for (std::size_t s = 0; s < kTileSamples; ++s) columns[tile].set(s, steps[kTileOffsets[s].x]);
  }
  const double axis[3] = {forward.x(), forward.y(), forward.z()};
  std::array<float, kTileSamples> least;
  least.fill(1.0f);
  Directions row;
  for (std::size_t ty = 0; ty < static_cast<std::size_t>(rays.tiles_y); ++ty) {
    std::array<Vec3, kTileSide> steps;
    for (std::size_t k = 0; k < kTileSide; ++k) {
      const auto y = static_cast<double>(ty * kTileSide + k);
      steps[k] = (y + 0.5 - camera.cy) / camera.fy * down;
    }
    for (std::size_t s = 0; s < kTileSamples; ++s) row.set(s, steps[kTileOffsets[s].y]);
    for (std::size_t tx = 0; tx < columns.size(); ++tx) {
      const std::size_t base = (ty * columns.size() + tx) * kTileSamples;
      normalise(columns[tx], row, axis, rays.dx.data() + base, rays.dy.data() + base,
                rays.dz.data() + base, rays.cosine.data() + base, least.data());
    }
  }
  rays.nearest_depth = kNearest * *std::min_element(least.begin(), least.end());
  return {};
}

}  // namespace probe::render
