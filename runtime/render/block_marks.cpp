#include "runtime/render/block_marks.h"

#include <algorithm>

namespace probe::render {

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
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const Projection projection = projection_of(instances[i], camera_);
    for (const MeshGeometry::Part& part : instances[i].geometry->parts) {
      part_.project(part, projection);
      PixelBounds bounds;
      for (std::size_t k = 0; k < part.indices.size(); k += 3) {
        if (part_.bounds(part, k, nearest_, bounds)) mark_rectangle(bounds, instance_bit(i));
      }
    }
  }
}

void BlockMarks::mark_rectangle(const PixelBounds& bounds, InstanceSet bit) {
  const auto& [min_x, max_x, min_y, max_y] = bounds;
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
