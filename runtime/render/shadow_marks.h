// Which 8 x 8 blocks the shadows of moving triangles can reach on statics. Conservative: seen along
// each sun, triangles set cells of a coarse grid, and a block whose static points lie in a set cell
// is marked.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/render/block_marks.h"
#include "runtime/render/shading.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

// Two axes square to a sun's direction; along them its shadows keep their place.
struct LightPlane {
  std::array<float, 3> a{}, b{}, origin{};
};

struct CellRectangle {
  std::uint16_t x0 = 1, y0 = 1, x1 = 0, y1 = 0;  // empty when x1 < x0
};

// The static half, fixed with the camera: per casting sun the rectangle of every block's points.
struct ShadowReceivers {
  struct Sun {
    LightPlane plane;
    std::vector<CellRectangle> blocks;  // raster order of BlockMarks
  };
  std::vector<Sun> suns;

  // For every sun of `lights` that casts; `centre` is where the scene is.
  void prepare(const LightTable& lights, const std::array<float, 3>& centre, std::size_t blocks);
  void add(std::size_t block, const std::array<float, 3>& point);
};

class ShadowMarks {
 public:
  // Marks the blocks on which a shadow of the instances, as placed, can fall.
  void mark(const ShadowReceivers& receivers, const std::vector<Instance>& instances,
            BlockMarks& marks);

 private:
  void draw(const LightPlane& plane, const std::vector<Instance>& instances);

  std::vector<std::uint8_t> cells_;
  std::vector<float> x_, y_;
};

}  // namespace probe::render
