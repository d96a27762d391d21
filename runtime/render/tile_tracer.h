// One tile: rays to hits, hits to shading inputs, shading to colours. Used alike by the static pass
// and by every frame, which is why cached and full frames agree bit for bit. Owns its buffers; one
// a thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "runtime/render/camera_rays.h"
#include "runtime/render/shading.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

// Nearest hits of a tile, compacted in sample order; after shade() with colours.
struct TileHits {
  int count = 0;
  std::array<std::uint8_t, kTileSamples> sample;
  std::array<std::uint32_t, kTileSamples> instance, part, primitive;
  alignas(64) std::array<float, kTileSamples> t, u, v;
};

class TileTracer {
 public:
  // Traces the blocks of `blocks` (bit b: samples 64 b .. 64 b + 63) up to `farthest[sample]`, then
  // recomputes t, u and v of every hit in our own code, so that only the choice of the triangle is
  // Embree's.
  void trace(const TopScene& scene, const CameraRays& rays, int tile, unsigned blocks,
             const float* farthest);
  // Attributes, textures and the shading law for all hits. `shadows`: suns marked so are tested
  // against `scene`.
  void shade(const TopScene& scene, const CameraRays& rays, int tile, const LightTable& lights,
             bool shadows);

  const TileHits& hits() const { return hits_; }
  const ShadeOutput& colors() const { return output_; }

 private:
  void gather(const TopScene& scene, const CameraRays& rays, int tile, bool points);
  void test_sun(const TopScene& scene, const LightRay& sun,
                std::array<float, kTileSamples>& visible);

  // World points and face normals of the hits, only where shadows are on.
  struct Points {
    alignas(64) std::array<float, kTileSamples> px, py, pz, gx, gy, gz;
  };

  TileHits hits_{};
  ShadeInput input_{};
  ShadeOutput output_{};
  Points points_{};
  std::vector<std::array<float, kTileSamples>> visible_;
  std::vector<const float*> visible_pointers_;
};

}  // namespace probe::render
