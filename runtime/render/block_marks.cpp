#include "runtime/render/block_marks.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

// Pixel coordinates and camera depth of `count` points; rows are those of the 3 x 4 matrix that
// gives (x z, y z, z).
PROBE_CLONES void project(const float* __restrict px, const float* __restrict py,
                          const float* __restrict pz, std::size_t count, const float* rows,
                          float* __restrict x, float* __restrict y, float* __restrict z) {
  const float a0 = rows[0], a1 = rows[1], a2 = rows[2], a3 = rows[3];
  const float b0 = rows[4], b1 = rows[5], b2 = rows[6], b3 = rows[7];
  const float c0 = rows[8], c1 = rows[9], c2 = rows[10], c3 = rows[11];
  for (std::size_t i = 0; i < count; ++i) {
    const float depth = c0 * px[i] + c1 * py[i] + c2 * pz[i] + c3;
    const float inverse = 1.0f / depth;  // behind the camera: not used by the caller
    x[i] = (a0 * px[i] + a1 * py[i] + a2 * pz[i] + a3) * inverse;
    y[i] = (b0 * px[i] + b1 * py[i] + b2 * pz[i] + b3) * inverse;
    z[i] = depth;
  }
}

}  // namespace

BlockMarks::BlockMarks(const Camera& camera, const CameraRays& rays)
    : camera_(camera),
      nearest_(0.99f * rays.nearest_depth),  // room for rounding
      max_x_(static_cast<float>(rays.width - 1)),
      max_y_(static_cast<float>(rays.height - 1)),
      blocks_x_(2 * rays.tiles_x),
      blocks_y_(2 * rays.tiles_y),
      marks_(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_y_), 0) {}

void BlockMarks::clear() { std::fill(marks_.begin(), marks_.end(), InstanceSet{0}); }
void BlockMarks::mark_all() { std::fill(marks_.begin(), marks_.end(), kAllInstances); }

BlockSets BlockMarks::tile_blocks(int tile_x, int tile_y) const {
  const InstanceSet* top = marks_.data() + at(2 * tile_x, 2 * tile_y);
  const InstanceSet* bottom = marks_.data() + at(2 * tile_x, 2 * tile_y + 1);
  return {top[0], top[1], bottom[0], bottom[1]};
}

void BlockMarks::mark(const std::vector<Instance>& instances) {
  const Vec3 forward = camera_.forward_left_up.col(0);
  const Vec3 right = -camera_.forward_left_up.col(1), down = -camera_.forward_left_up.col(2);
  Mat3 lens;
  lens.row(0) = (camera_.fx * right + camera_.cx * forward).transpose();
  lens.row(1) = (camera_.fy * down + camera_.cy * forward).transpose();
  lens.row(2) = forward.transpose();
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const Instance& instance = instances[i];
    // From the floats Embree was given, so that both see the same triangle.
    Mat3 rotation;
    Vec3 translation;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) rotation(r, c) = instance.rotation[3 * r + c];
      translation[r] = instance.translation[r];
    }
    const Mat3 linear = lens * rotation;
    const Vec3 offset = lens * (translation - camera_.position);
    float rows[12];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) rows[4 * r + c] = static_cast<float>(linear(r, c));
      rows[4 * r + 3] = static_cast<float>(offset[r]);
    }
    for (const MeshGeometry::Part& part : instance.geometry->parts) {
      mark_part(part, rows, instance_bit(i));
    }
  }
}

void BlockMarks::mark_part(const MeshGeometry::Part& part, const float (&rows)[12],
                           InstanceSet bit) {
  const std::size_t count = part.x.size();
  if (x_.size() < count) {
    x_.resize(count);
    y_.resize(count);
    z_.resize(count);
  }
  project(part.x.data(), part.y.data(), part.z.data(), count, rows, x_.data(), y_.data(),
          z_.data());
  const std::uint32_t* index = part.indices.data();
  for (std::size_t i = 0; i < part.indices.size(); i += 3) {
    const std::uint32_t a = index[i], b = index[i + 1], c = index[i + 2];
    const float nearest = std::min(std::min(z_[a], z_[b]), z_[c]);
    if (nearest > nearest_) {
      mark_rectangle(
          std::min(std::min(x_[a], x_[b]), x_[c]), std::max(std::max(x_[a], x_[b]), x_[c]),
          std::min(std::min(y_[a], y_[b]), y_[c]), std::max(std::max(y_[a], y_[b]), y_[c]), bit);
      continue;
    }
    if (std::max(std::max(z_[a], z_[b]), z_[c]) <= nearest_) continue;
    float corners[3][3];
    const std::uint32_t vertices[3] = {a, b, c};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = vertices[k];
      for (int r = 0; r < 3; ++r) {
        corners[k][r] = rows[4 * r] * part.x[v] + rows[4 * r + 1] * part.y[v] +
                        rows[4 * r + 2] * part.z[v] + rows[4 * r + 3];
      }
    }
    mark_clipped(corners, bit);
  }
}

// A triangle that crosses the nearest depth: the rectangle of what lies beyond. Corners are (x z, y
// z, z).
void BlockMarks::mark_clipped(const float (&corners)[3][3], InstanceSet bit) {
  float min_x = INFINITY, max_x = -INFINITY, min_y = INFINITY, max_y = -INFINITY;
  const auto add = [&](float xz, float yz, float z) {
    min_x = std::min(min_x, xz / z);
    max_x = std::max(max_x, xz / z);
    min_y = std::min(min_y, yz / z);
    max_y = std::max(max_y, yz / z);
  };
  // Half the nearest depth leaves room for rounding: the cut is no nearer to the visible part than
  // that.
  const float cut = 0.5f * nearest_;
  for (int k = 0; k < 3; ++k) {
    const float* a = corners[k];
    const float* b = corners[(k + 1) % 3];
    if (a[2] >= cut) add(a[0], a[1], a[2]);
    if ((a[2] >= cut) != (b[2] >= cut)) {
      const float s = (cut - a[2]) / (b[2] - a[2]);
      add(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), cut);
    }
  }
  if (min_x <= max_x) mark_rectangle(min_x, max_x, min_y, max_y, bit);
}

void BlockMarks::mark_rectangle(float min_x, float max_x, float min_y, float max_y,
                                InstanceSet bit) {
  // Clamped as floats: a far-away triangle's pixels do not fit an int.
  if (!(max_x >= -0.5f) || !(min_x <= max_x_ + 1.5f) || !(max_y >= -0.5f) ||
      !(min_y <= max_y_ + 1.5f)) {
    return;
  }
  const int x0 = static_cast<int>(std::clamp(min_x - 0.5f, 0.0f, max_x_)) / kBlockSide;
  const int x1 = static_cast<int>(std::clamp(max_x + 0.5f, 0.0f, max_x_)) / kBlockSide;
  const int y0 = static_cast<int>(std::clamp(min_y - 0.5f, 0.0f, max_y_)) / kBlockSide;
  const int y1 = static_cast<int>(std::clamp(max_y + 0.5f, 0.0f, max_y_)) / kBlockSide;
  for (int y = y0; y <= y1; ++y) {
    InstanceSet* row = marks_.data() + at(0, y);
    for (int x = x0; x <= x1; ++x) row[x] |= bit;
  }
}

}  // namespace probe::render
