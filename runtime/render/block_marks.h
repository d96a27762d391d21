// Which 8 x 8 blocks the triangles of which instances can touch. Conservative, hence exact: a block
// that is not marked shows no moving surface, and one whose instances have not moved shows what it
// showed before.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/instance_set.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

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
  BlockSets tile_blocks(int tile_x, int tile_y) const;

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_x_) +
           static_cast<std::size_t>(x);
  }
  void mark_part(const MeshGeometry::Part& part, const float (&rows)[12], InstanceSet bit);
  void mark_rectangle(float min_x, float max_x, float min_y, float max_y, InstanceSet bit);
  void mark_clipped(const float (&corners)[3][3], InstanceSet bit);

  Camera camera_;  // of the samples
  float nearest_ = 0;
  float max_x_ = 0, max_y_ = 0;  // last pixel
  int blocks_x_ = 0, blocks_y_ = 0;
  std::vector<InstanceSet> marks_;
  std::vector<float> x_, y_, z_;  // projected vertices of one part: pixels, pixels, metres
};

}  // namespace probe::render
