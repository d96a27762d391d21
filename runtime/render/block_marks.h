// Which 8 x 8 blocks the triangles of which instances can touch. Conservative, hence exact: a block
// that is not marked shows no moving surface, and one whose instances have not moved shows what it
// showed before.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/instance_set.h"
#include "runtime/render/projected_part.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

// Of blocks, both ends included.
struct BlockRectangle {
  bool operator==(const BlockRectangle&) const = default;
  std::int16_t x0, x1, y0, y1;
};

class BlockMarks {
 public:
  // None is marked.
  BlockMarks() = default;
  BlockMarks(const Camera& camera, const CameraRays& rays);

  void clear();
  void mark_all();
  void mark_block(int x, int y) { marks_[at(x, y)] = kAllInstances; }
  // Marks the rectangle of pixels of every triangle of every instance, as placed, with its bit.
  void mark(const std::vector<Instance>& instances);

  int blocks_x() const { return blocks_x_; }
  int blocks_y() const { return blocks_y_; }
  InstanceSet touching(int x, int y) const { return marks_[at(x, y)]; }
  void unmark(int x, int y) { marks_[at(x, y)] = 0; }
  bool marked(int x, int y) const { return marks_[at(x, y)] != 0; }
  // Whether something of the instance's is in that rectangle of blocks, both ends included.
  bool any(int x0, int y0, int x1, int y1, InstanceSet bit) const {
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        if ((touching(x, y) & bit) != 0) return true;
      }
    }
    return false;
  }
  BlockSets tile_blocks(int tile_x, int tile_y) const;

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_x_) +
           static_cast<std::size_t>(x);
  }
  void mark_rectangle(const BlockRectangle& rectangle, InstanceSet bit);

  Camera camera_;  // of the samples
  float nearest_ = 0;
  float max_x_ = 0, max_y_ = 0;  // last pixel
  int blocks_x_ = 0, blocks_y_ = 0;
  std::vector<InstanceSet> marks_;
  ProjectedPart part_;
};

}  // namespace probe::render
