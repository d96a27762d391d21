#include "runtime/render/projected_part.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

PROBE_CLONES void project_all(const float* __restrict px, const float* __restrict py,
                              const float* __restrict pz, std::size_t count, const float* rows,
                              float* __restrict x, float* __restrict y, float* __restrict z,
                              float* __restrict w) {
  const float a0 = rows[0], a1 = rows[1], a2 = rows[2], a3 = rows[3];
  const float b0 = rows[4], b1 = rows[5], b2 = rows[6], b3 = rows[7];
  const float c0 = rows[8], c1 = rows[9], c2 = rows[10], c3 = rows[11];
  for (std::size_t i = 0; i < count; ++i) {
    const float depth = c0 * px[i] + c1 * py[i] + c2 * pz[i] + c3;
    const float inverse = 1.0f / depth;
    x[i] = (a0 * px[i] + a1 * py[i] + a2 * pz[i] + a3) * inverse;
    y[i] = (b0 * px[i] + b1 * py[i] + b2 * pz[i] + b3) * inverse;
    z[i] = depth;
    w[i] = inverse;
  }
}

}  // namespace

Projection projection_of(const Instance& instance, const Camera& camera) {
  const Vec3 forward = camera.forward_left_up.col(0);
  const Vec3 right = -camera.forward_left_up.col(1), down = -camera.forward_left_up.col(2);
  Mat3 lens;
  lens.row(0) = (camera.fx * right + camera.cx * forward).transpose();
  lens.row(1) = (camera.fy * down + camera.cy * forward).transpose();
  lens.row(2) = forward.transpose();
  Mat3 rotation;
  Vec3 translation;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) rotation(r, c) = instance.rotation[3 * r + c];
    translation[r] = instance.translation[r];
  }
  const Mat3 linear = lens * rotation;
  const Vec3 offset = lens * (translation - camera.position);
  Projection out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.rows[4 * r + c] = static_cast<float>(linear(r, c));
    out.rows[4 * r + 3] = static_cast<float>(offset[r]);
  }
  return out;
}

void ProjectedPart::project(const MeshGeometry::Part& part, const Projection& projection) {
  projection_ = projection;
  const std::size_t count = part.x.size();
  if (x_.size() < count) {
    for (auto* values : {&x_, &y_, &z_, &w_}) values->resize(count);
  }
  project_all(part.x.data(), part.y.data(), part.z.data(), count, projection.rows, x_.data(),
              y_.data(), z_.data(), w_.data());
}

// A triangle that crosses the nearest depth: the rectangle of what lies beyond.
bool ProjectedPart::cut_bounds(const MeshGeometry::Part& part, const std::uint32_t* vertices,
                               float nearest, PixelBounds& out) const {
  const float* rows = projection_.rows;
  float corners[3][3];  // (x z, y z, z)
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = vertices[k];
    for (int r = 0; r < 3; ++r) {
      corners[k][r] = rows[4 * r] * part.x[v] + rows[4 * r + 1] * part.y[v] +
                      rows[4 * r + 2] * part.z[v] + rows[4 * r + 3];
    }
  }
  out = {INFINITY, -INFINITY, INFINITY, -INFINITY};
  const auto add = [&out](float xz, float yz, float z) {
    out.min_x = std::min(out.min_x, xz / z);
    out.max_x = std::max(out.max_x, xz / z);
    out.min_y = std::min(out.min_y, yz / z);
    out.max_y = std::max(out.max_y, yz / z);
  };
  // Half the nearest depth leaves room for rounding: the cut is no nearer to the visible part than
  // that.
  const float cut = 0.5f * nearest;
  for (int k = 0; k < 3; ++k) {
    const float* a = corners[k];
    const float* b = corners[(k + 1) % 3];
    if (a[2] >= cut) add(a[0], a[1], a[2]);
    if ((a[2] >= cut) != (b[2] >= cut)) {
      const float s = (cut - a[2]) / (b[2] - a[2]);
      add(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), cut);
    }
  }
  return out.min_x <= out.max_x;
}

}  // namespace probe::render
