// The 8 x 8 blocks of a moving camera's picture that one static triangle fills with nothing near
// before it, as the table before a wrist does: every ray through them meets that triangle, so none
// need be traced. Conservative, hence exact: what is doubtful, also by rounding, is left to rays.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/cone_triangle.h"
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
  // At most so close is whatever the tile that was last asked for shows, or what rays end at.
  float closest(int tile_x, int tile_y) const;
  // Draws what it shows in its other blocks, but for those of which all packets are hidden; holds
  // until the next call.
  KnownTriangles draw_rest(int tile_x, int tile_y, const FilledBlocks& filled, PacketSet hidden);

 private:
  void draw_block(const PixelRectangle& block, int left, int top);
  FilledBlock find(const PixelRectangle& block) const;

  static PixelRectangle rectangle_of(int tile_x, int tile_y);

  float farthest_ = 0;  // greatest depth whose points are all within reach of rays
  ConeView view_;
  std::vector<ConeTriangle> triangles_;
  std::vector<TriangleName> names_;  // of these
  // The edges' values and bounds again, an array a quantity, for the search by tile.
  std::array<std::vector<float>, 14> columns_;
  std::vector<std::uint8_t> outside_;
  std::vector<std::uint32_t> near_;  // those that can touch the tile
  HitSheet sheet_;                   // of one tile
  std::unique_ptr<TriangleBatch> batch_ = std::make_unique<TriangleBatch>();
};

}  // namespace probe::render
