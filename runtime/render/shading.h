// The shading law on arrays: one tile's hits, compacted. Formulas are in README.md; single
// precision, in the order written there. Knows nothing of rays, meshes or textures.
#pragma once

#include <array>
#include <vector>

#include "runtime/render/renderer.h"

namespace probe::render {

inline constexpr int kTileSamples = 256;

// Hits in sample order, one array a quantity. Counts are rounded up to 16, so the entries behind
// the last hit must hold harmless values (pad()).
struct alignas(64) ShadeInput {
  using Array = std::array<float, kTileSamples>;
  alignas(64) Array nx, ny, nz;  // unit normal, towards the viewer
  alignas(64) Array vx, vy, vz;  // unit direction to the viewer
  alignas(64) Array albedo_r, albedo_g, albedo_b;
  alignas(64) Array emission_r, emission_g, emission_b;
  alignas(64) Array roughness, f0, metallic;
};

struct ShadeOutput {
  using Array = ShadeInput::Array;
  alignas(64) Array r, g, b;  // linear, not clamped
};

// A sun as the law reads it: the unit direction towards it and its irradiance.
struct LightRay {
  float x = 0, y = 0, z = 1;
  float irradiance = 0;
  bool shadow = false;
};

struct LightTable {
  float ambient = 0;
  std::vector<LightRay> suns;
  std::array<float, 3> color{1, 1, 1};  // of all of it

  bool any_shadow() const;
};

// Fills entries count .. next multiple of 16.
void pad(ShadeInput& input, int count);
int padded(int count);

// Factors one a hit, null: all 1. `visible[s]`: of sun s, 0 in shadow; `open`: of the ambient
// light, the share of directions that nothing near closes.
struct LightFactors {
  std::vector<const float*> visible;
  const float* open = nullptr;
};
void shade(const ShadeInput& input, int count, const LightTable& lights,
           const LightFactors& factors, ShadeOutput& output);

}  // namespace probe::render
