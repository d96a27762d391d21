// A picture's buffers, and how hits become its pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/render/tile_tracer.h"

namespace probe::render {

// Raster order, row 0 on top; see FrameView.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth;
  std::vector<std::uint16_t> segmentation;

  // Another size, all of it black, without depth and id.
  void clear(int new_width, int new_height);
  // Another size; what it shows is nobody's.
  void resize(int new_width, int new_height);
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

// Of a picture with one sample a pixel: depth and id of every hit in `tile`, and with `colors` not
// null their light.
void show_hits(const TileHits& hits, const TopScene& scene, const CameraRays& rays, int tile,
               const ShadeOutput* colors, Picture& picture);

// Copies what both show of an 8 x 8 block of samples, `samples` a side of a pixel.
void restore_block(const Picture& from, int block_x, int block_y, int samples, Picture& to);

}  // namespace probe::render
