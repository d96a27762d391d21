#include "runtime/render/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

// __restrict: without it the compiler would have to compare nineteen arrays for overlap, and does
// not vectorise.

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kTiny = 1e-6f;

inline float clamp(float x, float low, float high) {
  const float above = x < low ? low : x;
  return above > high ? high : above;
}

// E + A (1-m) ao rho, the part of no light's direction.
PROBE_CLONES void shade_ambient(const ShadeInput& __restrict in, int count, float ambient,
                                const float* __restrict open, ShadeOutput& __restrict out) {
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const float diffuse = ambient * open[k] * (1 - in.metallic[k]);
    out.r[k] = in.emission_r[k] + diffuse * in.albedo_r[k];
    out.g[k] = in.emission_g[k] + diffuse * in.albedo_g[k];
    out.b[k] = in.emission_b[k] + diffuse * in.albedo_b[k];
  }
}

// One sun: vis e NoL (rho (1-m)/pi + S F), added.
PROBE_CLONES void shade_sun(const ShadeInput& __restrict in, int count, float lx, float ly,
                            float lz, float irradiance, const float* __restrict visible,
                            ShadeOutput& __restrict out) {
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const float nx = in.nx[k], ny = in.ny[k], nz = in.nz[k];
    const float vx = in.vx[k], vy = in.vy[k], vz = in.vz[k];
    const float sx = lx + vx, sy = ly + vy, sz = lz + vz;
    const float length2 = sx * sx + sy * sy + sz * sz;
    const float scale = 1.0f / std::sqrt(length2 < 1e-20f ? 1e-20f : length2);
    const float hx = sx * scale, hy = sy * scale, hz = sz * scale;

    const float noh = clamp(nx * hx + ny * hy + nz * hz, kTiny, 1);
    const float voh = clamp(vx * hx + vy * hy + vz * hz, kTiny, 1);
    const float nov = clamp(nx * vx + ny * vy + nz * vz, kTiny, 1);
    const float nol = clamp(nx * lx + ny * ly + nz * lz, 0, 1);

    const float r = in.roughness[k], m = in.metallic[k];
    const float a = r * r;
    const float kk = (a + 2 * r + 1) / 8;
    const float a2 = a * a;
    const float d = noh * noh * (a2 - 1) + 1;
    const float denominator = 4 * kPi * (d * d) * (nov * (1 - kk) + kk) * (nol * (1 - kk) + kk);
    const float s = a2 / clamp(denominator, kTiny, 4 * kPi);
    const float x = 1 - voh;
    const float x2 = x * x;
    const float fresnel = x2 * x2 * x;
    const float light = visible[k] * irradiance * nol;
    const float lambert = (1 - m) / kPi;
    const float dielectric = in.f0[k] * (1 - m);

    const float fr = dielectric + in.albedo_r[k] * m;
    const float fg = dielectric + in.albedo_g[k] * m;
    const float fb = dielectric + in.albedo_b[k] * m;
    out.r[k] += light * (in.albedo_r[k] * lambert + s * (fr + (1 - fr) * fresnel));
    out.g[k] += light * (in.albedo_g[k] * lambert + s * (fg + (1 - fg) * fresnel));
    out.b[k] += light * (in.albedo_b[k] * lambert + s * (fb + (1 - fb) * fresnel));
  }
}

// Of what is not emitted, the share that a light of that colour gives.
void tint(const ShadeInput::Array& emission, int count, float factor, ShadeInput::Array& out) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    out[k] = emission[k] + factor * (out[k] - emission[k]);
}

ShadeInput::Array make_ones() {
  ShadeInput::Array ones;
  ones.fill(1);
  return ones;
}

}  // namespace

int padded(int count) { return (count + 15) & ~15; }

void pad(ShadeInput& in, int count) {
  for (auto k = static_cast<std::size_t>(count); k < static_cast<std::size_t>(padded(count)); ++k) {
    in.nx[k] = in.ny[k] = in.vx[k] = in.vy[k] = 0;
    in.nz[k] = in.vz[k] = 1;
    in.albedo_r[k] = in.albedo_g[k] = in.albedo_b[k] = 0;
    in.emission_r[k] = in.emission_g[k] = in.emission_b[k] = 0;
    in.roughness[k] = 1;
    in.f0[k] = 0.04f;
    in.metallic[k] = 0;
  }
}

bool LightTable::any_shadow() const {
  return std::any_of(suns.begin(), suns.end(), [](const LightRay& sun) { return sun.shadow; });
}

void shade(const ShadeInput& input, int count, const LightTable& lights,
           const LightFactors& factors, ShadeOutput& output) {
  static const ShadeInput::Array kOnes = make_ones();
  const int n = padded(count);
  shade_ambient(input, n, lights.ambient, factors.open != nullptr ? factors.open : kOnes.data(),
                output);
  for (std::size_t s = 0; s < lights.suns.size(); ++s) {
    const LightRay& sun = lights.suns[s];
    const bool given = s < factors.visible.size() && factors.visible[s] != nullptr;
    shade_sun(input, n, sun.x, sun.y, sun.z, sun.irradiance,
              given ? factors.visible[s] : kOnes.data(), output);
  }
  // White light is left alone, to the bit.
  if (lights.color == std::array<float, 3>{1, 1, 1}) return;
  tint(input.emission_r, n, lights.color[0], output.r);
  tint(input.emission_g, n, lights.color[1], output.g);
  tint(input.emission_b, n, lights.color[2], output.b);
}

}  // namespace probe::render
