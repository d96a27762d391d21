#include "runtime/render/block_marks.h"

#include <algorithm>
#include <array>

#include "runtime/render/clones.h"
#include "runtime/render/extremes.h"

namespace probe::render {
namespace {

constexpr std::size_t kBatch = 256;
constexpr std::int16_t kCrossing = -1;  // in x0: the triangle has to be cut first

struct PixelLimits {
  float nearest, max_x, max_y;
};


// Of the blocks that meet a rectangle of pixels, with room; y1 is less than y0 if none does.
inline BlockRectangle blocks_of(float min_x, float max_x, float min_y, float max_y,
                                const PixelLimits& limits) {
  // Clamped as floats: a far-away triangle's pixels do not fit an int.
  const auto block = [](float at, float last) {
    const float inside = least(greatest(at, 0.0f), last);
    return static_cast<std::int16_t>(static_cast<std::int32_t>(inside) / kBlockSide);
  };
  const int seen = (max_x >= -0.5f ? 1 : 0) & (min_x <= limits.max_x + 1.5f ? 1 : 0) &
                   (max_y >= -0.5f ? 1 : 0) & (min_y <= limits.max_y + 1.5f ? 1 : 0);
  const std::int16_t y0 = block(min_y - 0.5f, limits.max_y);
  const std::int16_t y1 = block(max_y + 0.5f, limits.max_y);
  return {block(min_x - 0.5f, limits.max_x), block(max_x + 0.5f, limits.max_x), y0,
          seen != 0 ? y1 : static_cast<std::int16_t>(-1)};
}

// Of `count` triangles whose vertices are `index`.
PROBE_CLONES void find_rectangles(const std::uint32_t* __restrict index, std::size_t count,
                                  const float* __restrict px, const float* __restrict py,
                                  const float* __restrict pz, const PixelLimits& given,
                                  BlockRectangle* __restrict out) {
  const PixelLimits limits = given;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = index[3 * i], b = index[3 * i + 1], c = index[3 * i + 2];
    const BlockRectangle all = blocks_of(
        least(least(px[a], px[b]), px[c]), greatest(greatest(px[a], px[b]), px[c]),
        least(least(py[a], py[b]), py[c]), greatest(greatest(py[a], py[b]), py[c]), limits);
    const bool beyond = least(least(pz[a], pz[b]), pz[c]) > limits.nearest;
    const bool before = !(greatest(greatest(pz[a], pz[b]), pz[c]) > limits.nearest);
    out[i].x0 = beyond ? all.x0 : kCrossing;
    out[i].x1 = all.x1;
    out[i].y0 = all.y0;
    out[i].y1 = all.y1;
    if (before) out[i] = {0, 0, 0, -1};
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
  std::array<BlockRectangle, kBatch> rectangles;
  const PixelLimits limits{nearest_, max_x_, max_y_};
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const Projection projection = projection_of(instances[i], camera_);
    const InstanceSet bit = instance_bit(i);
    for (const MeshGeometry::Part& part : instances[i].geometry->parts) {
      part_.project(part, projection);
      const std::size_t all = part.indices.size() / 3;
      for (std::size_t first = 0; first < all; first += kBatch) {
        const std::size_t count = std::min(all - first, kBatch);
        find_rectangles(part.indices.data() + 3 * first, count, part_.x(), part_.y(), part_.depth(),
                        limits, rectangles.data());
        for (std::size_t k = 0; k < count; ++k) {
          // Neighbours in a fine mesh touch the same blocks.
          if (k > 0 && rectangles[k].x0 != kCrossing && rectangles[k] == rectangles[k - 1])
            continue;
          PixelBounds bounds;
          if (rectangles[k].x0 != kCrossing) {
            mark_rectangle(rectangles[k], bit);
          } else if (part_.bounds(part, 3 * (first + k), nearest_, bounds)) {
            mark_rectangle(
                blocks_of(bounds.min_x, bounds.max_x, bounds.min_y, bounds.max_y, limits), bit);
          }
        }
      }
    }
  }
}

void BlockMarks::mark_rectangle(const BlockRectangle& rectangle, InstanceSet bit) {
  for (int y = rectangle.y0; y <= rectangle.y1; ++y) {
    InstanceSet* row = marks_.data() + at(0, y);
    for (int x = rectangle.x0; x <= rectangle.x1; ++x) row[x] |= bit;
  }
}

}  // namespace probe::render
