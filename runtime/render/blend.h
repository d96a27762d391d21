// Tiles whose samples are averaged, or on whose statics shadows of moving things fall.
#pragma once

#include <array>

#include "runtime/render/static_picture.h"
#include "runtime/render/tile_tracer.h"

namespace probe::render {

// Owns its buffers; one a thread.
class TileBlender {
 public:
  // `tracer` has the hits of the tile's marked blocks on `dynamics`; it is used up.
  void draw(const StaticPicture& seen, const TopScene& dynamics, int occlusion_rays, int tile,
            const BlockSets& blocks, TileTracer& tracer, Picture& frame);

 private:
  void keep_color(const TileTracer& tracer, std::size_t hit, std::size_t sample);
  void shade_statics(const StaticPicture& seen, const TopScene& dynamics, int occlusion_rays,
                     int tile, const BlockSets& blocks, TileTracer& tracer);
  void write_means(const StaticPicture& seen, int tile, Picture& frame) const;

  std::array<bool, kTileSamples> covered_{}, changed_{};
  std::array<std::array<float, 3>, kTileSamples> color_{};
};

}  // namespace probe::render
