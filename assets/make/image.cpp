#include "assets/make/image.h"

#include <algorithm>
#include <cmath>

namespace probe::make {
namespace {

// Newton's method for the fifth root of x in [0, 1]; only IEEE operations, so every machine gets
// the same bits.
double fifth_root(double x) {
  if (x <= 0) return 0;
  double root = 1;
  for (int step = 0; step < 60; ++step) {
    const double fourth = root * root * root * root;
    root += (x / fourth - root) / 5;
  }
  return root;
}

double power_2_2(double x) { return x * x * fifth_root(x); }

double power_2_4(double x) {
  const double root = fifth_root(x);
  return x * x * root * root;
}

double srgb_to_linear(double byte) {
  const double s = byte / 255;
  return s <= 0.04045 ? s / 12.92 : power_2_4((s + 0.055) / 1.055);
}

// By bisection: the inverse needs a power we do not have.
double linear_to_srgb(double linear) {
  double low = 0, high = 255;
  for (int step = 0; step < 40; ++step) {
    const double middle = (low + high) / 2;
    (srgb_to_linear(middle) < linear ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

void Image::set(int column, int row, const Colour& colour) {
  const std::size_t at = (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(column)) *
                         3;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    rgb[at + channel] =
        static_cast<std::uint8_t>(std::floor(std::clamp(colour[channel], 0.0, 255.0) + 0.5));
  }
}

double hash01(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x9E3779B1u ^ (y * 0x85EBCA77u + 0x165667B1u) ^ seed * 0xC2B2AE3Du;
  h ^= h >> 16;
  h *= 0x7FEB352Du;
  h ^= h >> 15;
  h *= 0x846CA68Bu;
  h ^= h >> 16;
  return static_cast<double>(h >> 8) / 16777216.0;
}

double value_noise(double x, double y, Period period, std::uint32_t seed) {
  const double cell_x = std::floor(x), cell_y = std::floor(y);
  const double fx = x - cell_x, fy = y - cell_y;
  const double sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
  const auto wrap = [](double cell, int size) {
    const auto i = static_cast<long long>(cell) % size;
    return static_cast<std::uint32_t>(i < 0 ? i + size : i);
  };
  const std::uint32_t x0 = wrap(cell_x, period.x), x1 = wrap(cell_x + 1, period.x);
  const std::uint32_t y0 = wrap(cell_y, period.y), y1 = wrap(cell_y + 1, period.y);
  const double top = hash01(x0, y0, seed) * (1 - sx) + hash01(x1, y0, seed) * sx;
  const double bottom = hash01(x0, y1, seed) * (1 - sx) + hash01(x1, y1, seed) * sx;
  return top * (1 - sy) + bottom * sy;
}

Colour mix(const Colour& a, const Colour& b, double t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

double clamp01(double value) { return std::clamp(value, 0.0, 1.0); }

double smooth_step(double low, double high, double value) {
  const double t = clamp01((value - low) / (high - low));
  return t * t * (3 - 2 * t);
}

Colour albedo_for(const Colour& lit, double gain, double specular) {
  Colour albedo{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    // Half a level up, because the renderer truncates.
    const double shown = power_2_2(std::min(1.0, (lit[channel] + 0.5) / 255));
    albedo[channel] = clamp01((shown - specular) / gain);
  }
  return albedo;
}

Colour texel_for(const Colour& lit, double gain, double specular) {
  Colour texel = albedo_for(lit, gain, specular);
  for (double& channel : texel) channel = linear_to_srgb(channel);
  return texel;
}

void dim(Image& image, double factor) {
  std::array<std::uint8_t, 256> dimmed{};
  for (std::size_t byte = 0; byte < dimmed.size(); ++byte) {
    const double shown = linear_to_srgb(factor * srgb_to_linear(static_cast<double>(byte)));
    dimmed[byte] = static_cast<std::uint8_t>(shown + 0.5);
  }
  for (std::uint8_t& byte : image.rgb) byte = dimmed[byte];
}

}  // namespace probe::make
