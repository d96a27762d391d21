#include "runtime/render/camera_rays.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

Failure camera_failure(const std::string& message) {
  return {.code = Fault::kRender, .message = message, .where = "camera"};
}

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

Status TileRays::begin(const Camera& camera, CameraRays& rays) {
  PROBE_TRY(check_camera(camera));
  camera_ = camera;
  row_at_ = -1;
  rays.width = camera.width;
  rays.height = camera.height;
  rays.tiles_x = (camera.width + kTileSide - 1) / kTileSide;
  rays.tiles_y = (camera.height + kTileSide - 1) / kTileSide;
  for (int k = 0; k < 3; ++k) {
    rays.origin[static_cast<std::size_t>(k)] = static_cast<float>(camera.position[k]);
  }
  const std::size_t samples =
      (rays.is_tile ? std::size_t{1} : static_cast<std::size_t>(rays.tiles())) * kTileSamples;
  for (auto* array : {&rays.dx, &rays.dy, &rays.dz, &rays.cosine}) array->resize(samples);

  // forward + (x - cx) / fx right is the same for a whole column, (y - cy) / fy down for a row.
  const Vec3 forward = camera.forward_left_up.col(0), right = -camera.forward_left_up.col(1);
  columns_.resize(static_cast<std::size_t>(rays.tiles_x));
  for (std::size_t tile = 0; tile < columns_.size(); ++tile) {
    std::array<Vec3, kTileSide> steps;
    for (std::size_t k = 0; k < kTileSide; ++k) {
      const auto x = static_cast<double>(tile * kTileSide + k);
      steps[k] = forward + (x + 0.5 - camera.cx) / camera.fx * right;
    }
    for (std::size_t s = 0; s < kTileSamples; ++s) columns_[tile].set(s, steps[kTileOffsets[s].x]);
  }
  return {};
}

void TileRays::make(int tile, CameraRays& rays, std::array<float, kTileSamples>& least) {
  const int row = tile / rays.tiles_x;
  if (row != row_at_) {
    row_at_ = row;
    const Vec3 down = -camera_.forward_left_up.col(2);
    std::array<Vec3, kTileSide> steps;
    for (std::size_t k = 0; k < kTileSide; ++k) {
      const auto y = static_cast<double>(row * kTileSide) + static_cast<double>(k);
      steps[k] = (y + 0.5 - camera_.cy) / camera_.fy * down;
    }
    for (std::size_t s = 0; s < kTileSamples; ++s) row_.set(s, steps[kTileOffsets[s].y]);
  }
  const Vec3 forward = camera_.forward_left_up.col(0);
  const double axis[3] = {forward.x(), forward.y(), forward.z()};
  const std::size_t base = rays.base(tile);
  normalise(columns_[static_cast<std::size_t>(tile % rays.tiles_x)], row_, axis,
            rays.dx.data() + base, rays.dy.data() + base, rays.dz.data() + base,
            rays.cosine.data() + base, least.data());
}

void TileRays::make(int tile, CameraRays& rays) {
  std::array<float, kTileSamples> least;
  least.fill(1.0f);
  make(tile, rays, least);
}

Status TileRays::look(const Camera& camera, CameraRays& rays) {
  rays.is_tile = true;
  PROBE_TRY(begin(camera, rays));
  // A picture's outermost ray ends in a corner.
  std::array<float, kTileSamples> least;
  least.fill(1.0f);
  const int right = rays.tiles_x - 1, last = rays.tiles() - 1;
  for (const int corner : {0, right, last - right, last}) make(corner, rays, least);
  rays.nearest_depth = kNearest * *std::min_element(least.begin(), least.end());
  return {};
}

Status make_camera_rays(const Camera& camera, CameraRays& rays) {
  rays.is_tile = false;
  TileRays by_tile;
  PROBE_TRY(by_tile.begin(camera, rays));
  std::array<float, kTileSamples> least;
  least.fill(1.0f);
  for (int tile = 0; tile < rays.tiles(); ++tile) by_tile.make(tile, rays, least);
  rays.nearest_depth = kNearest * *std::min_element(least.begin(), least.end());
  return {};
}

}  // namespace probe::render
