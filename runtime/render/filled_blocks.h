// The 8 x 8 blocks of a moving camera's picture that one static triangle fills with nothing near
// before it, as the table before a wrist does: every ray through them meets that triangle, so none
// need be traced. Conservative, hence exact: what is doubtful, also by rounding, is left to rays.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/hit_sheet.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

struct FilledBlock {
  bool filled = false;
  TriangleName name;  // of the triangle that fills it
};
// A tile's, in sample order.
using FilledBlocks = std::array<FilledBlock, 4>;

class BlockFills {
 public:
  // All triangles of `scene` as `camera` sees them; a scene of more than 512 has no filled blocks.
  void look(const TopScene& scene, const Camera& camera);
  FilledBlocks of_tile(int tile_x, int tile_y);
  // Draws what the tile that was last asked for shows in its other blocks; holds until the next
  // call.
  KnownTriangles draw_rest(int tile_x, int tile_y, const FilledBlocks& filled);

 private:
  // Pixels, both ends included.
  struct Rectangle {
    float x0, x1, y0, y1;
  };
  // Seen from the camera's place, a ray through pixel (x, y) meets the triangle where the three
  // values a x + b y + c, one an edge, are positive; their weighted sum is 1 / depth.
  struct Triangle {
    float a[3], b[3], c[3];
    Rectangle bounds;
    float closeness_a, closeness_b, closeness_c;
    float closest;  // 1 / the nearest corner's depth, infinite where that is behind the camera
    // Of a sample alone: how wrong the edges' values may be in Embree and here, and places, m.
    float touch[3], doubt;
    bool thin;  // rounding could turn it over
  };

  void add(const Vec3 (&corners)[3], double doubt, const Camera& camera);
  void draw_block(const Rectangle& block, int left, int top);
  FilledBlock find(const Rectangle& block) const;

  float farthest_ = 0;  // greatest depth whose points are all within reach of rays
  float longest_ = 1;   // ray, with a forward part of 1
  float across_ = 0;    // pixels a radian straight ahead
  float depth_doubt_ = 0;
  std::vector<Triangle> triangles_;
  std::vector<TriangleName> names_;  // of these
  // The edges' values and bounds again, an array a quantity, for the search by tile.
  std::array<std::vector<float>, 14> columns_;
  std::vector<std::uint8_t> outside_;
  std::vector<std::uint32_t> near_;  // those that can touch the tile
  HitSheet sheet_;                   // of one tile
  std::unique_ptr<TriangleBatch> batch_ = std::make_unique<TriangleBatch>();
};

}  // namespace probe::render
