// One ray a sample, in tile order: 16 x 16 tiles, Morton order within, so that 8 samples are 4 x 2
// of them and 64 are an 8 x 8 block. A picture with s x s samples a pixel is one of s times the
// size.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/render/renderer.h"
#include "runtime/render/shading.h"

namespace probe::render {

inline constexpr int kTileSide = 16;
inline constexpr int kBlockSide = 8;
inline constexpr float kNearest = 0.01f;   // m along the ray
inline constexpr float kFarthest = 10.0f;  // m along the ray

// Pixel of a sample within its tile.
struct TileOffset {
  std::uint8_t x, y;
};
constexpr std::array<TileOffset, kTileSamples> make_tile_offsets() {
  std::array<TileOffset, kTileSamples> table{};
  for (unsigned i = 0; i < kTileSamples; ++i) {
    unsigned x = 0, y = 0;
    for (unsigned bit = 0; bit < 4; ++bit) {
      x |= ((i >> (2 * bit)) & 1u) << bit;
      y |= ((i >> (2 * bit + 1)) & 1u) << bit;
    }
    table[i] = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y)};
  }
  return table;
}
inline constexpr std::array<TileOffset, kTileSamples> kTileOffsets = make_tile_offsets();

struct CameraRays {
  int width = 0, height = 0;
  int tiles_x = 0, tiles_y = 0;
  std::array<float, 3> origin{};
  // Per sample, in tile order (tiles row by row); samples beyond the image's edge are ordinary rays
  // never shown.
  std::vector<float> dx, dy, dz;
  std::vector<float> cosine;  // dot(d, forward): depth = t cosine
  float nearest_depth = 0;    // 0.01 times the least cosine: nothing nearer can be hit
  bool is_tile = false;       // the arrays hold one tile, that which was made last

  int tiles() const { return tiles_x * tiles_y; }
  // Where a tile's samples begin.
  std::size_t base(int tile) const {
    return is_tile ? 0 : static_cast<std::size_t>(tile) * kTileSamples;
  }
};

// Directions not yet of unit length, in the order of a tile's samples.
struct Directions {
  alignas(64) std::array<double, kTileSamples> x, y, z;

  void set(std::size_t s, const Vec3& d) {
    x[s] = d.x();
    y[s] = d.y();
    z[s] = d.z();
  }
};

// Rays of a camera that moves are needed once, tile by tile, and stay near the processor.
class TileRays {
 public:
  // `rays` gets what a tile does not change. Fails as check_camera does.
  Status look(const Camera& camera, CameraRays& rays);
  // Fills it with a tile's.
  void make(int tile, CameraRays& rays);

 private:
  friend Status make_camera_rays(const Camera& camera, CameraRays& rays);
  Status begin(const Camera& camera, CameraRays& rays);
  void make(int tile, CameraRays& rays, std::array<float, kTileSamples>& least);

  Camera camera_;
  std::vector<Directions> columns_;
  Directions row_;
  int row_at_ = -1;  // of tiles, whose directions those are
};

// The camera whose pixels are the samples of this one's.
Camera sample_camera(Camera camera, int samples);

// Fails (kRender) on sizes outside 1 .. 8192, focal lengths that are not positive, numbers
// that are not finite or axes that are not orthonormal.
Status check_camera(const Camera& camera);

// Fills `rays` anew, in the memory that it has. Fails as check_camera does.
Status make_camera_rays(const Camera& camera, CameraRays& rays);

}  // namespace probe::render
