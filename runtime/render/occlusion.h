// Rays from surfaces towards light: is a sun blocked, how open is a point to its surroundings.
// Packets of eight, filled across a tile. Knows nothing of cameras or colours.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "runtime/render/shading.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

inline constexpr int kMaxOcclusionRays = 16;

// What stands in the way of light; either may be null.
struct Casters {
  const TopScene* dynamics = nullptr;
  const TopScene* statics = nullptr;
};

// The light that is traced for some surfaces.
struct Occlusion {
  Casters suns;     // of the suns that cast
  Casters ambient;  // of the ambient light
  int rays = 0;     // a hit, for the ambient light; 0: none is traced
};

// World points of a tile's hits and their unit face normals, towards the viewer.
struct SurfacePoints {
  using Array = std::array<float, kTileSamples>;
  alignas(64) Array px, py, pz, gx, gy, gz;
};

// Sets visible[i] to 0 for each of `count` hits with dot(n, sun) > 0 that turns its face away or
// lies behind a triangle of a caster, 1 elsewhere.
void test_sun(const Casters& casters, const LightRay& sun, const ShadeInput& input,
              const SurfacePoints& points, int count, std::array<float, kTileSamples>& visible);

// open[i] is the share of `rays` directions, cosine-weighted about the normal, that are free for
// 0.15 m. `seeds` names the directions: a hash of the sample's place in the picture.
void test_openness(const Casters& casters, const ShadeInput& input, const SurfacePoints& points,
                   std::span<const std::uint32_t> seeds, int rays,
                   std::array<float, kTileSamples>& open);

// A fixed hash of a sample's column and row.
std::uint32_t place_hash(std::uint32_t x, std::uint32_t y);

}  // namespace probe::render
