// Pictures made by number: integer hash noise, colours and PNG bytes. The same bytes on every
// machine: no libm, no random device, no clock. Knows nothing of meshes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace probe::make {

// sRGB-encoded red, green, blue, 0..255 before rounding.
using Colour = std::array<double, 3>;

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 bytes a pixel, row 0 on top

  Image(int w, int h)
      : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3) {}
  void set(int column, int row, const Colour& colour);  // rounds and clamps
};

// A fixed integer hash of a lattice point, uniform in [0, 1).
double hash01(std::uint32_t x, std::uint32_t y, std::uint32_t seed);

// Smooth noise in [0, 1) on a lattice of unit cells that repeats every (period_x, period_y) cells.
struct Period {
  int x = 1 << 16, y = 1 << 16;
};
double value_noise(double x, double y, Period period, std::uint32_t seed);

Colour mix(const Colour& a, const Colour& b, double t);
double clamp01(double value);
// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double value);

// The texture colour that shows as `lit` (display bytes) where the renderer's diffuse light is
// `gain` times the linear albedo, after `specular` (linear) has been added on top. Values that
// cannot be reached are clamped.
Colour texel_for(const Colour& lit, double gain, double specular);
// The same as a linear albedo.
Colour albedo_for(const Colour& lit, double gain, double specular);

// Every pixel shows `factor` of its light.
void dim(Image& image, double factor);

// Diffuse gains of the table's light (ambient 0.3; suns (0,0,-1) 2.2, (-1,-0.5,-1) 0.7, (1,1,-1)
// 0.7).
inline constexpr double kGainUp = 1.2775;     // a face turned up
inline constexpr double kGainPlusX = 0.4485;  // a wall facing +x
inline constexpr double kGainPlusY = 0.3743;  // a wall facing +y
// Between a wall's and a top's, for what has its light baked in.
inline constexpr double kGainBaked = 0.62;

}  // namespace probe::make
