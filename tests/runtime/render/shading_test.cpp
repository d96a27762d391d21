#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "runtime/render/encode.h"
#include "runtime/render/shading.h"

namespace probe::render {
namespace {

TEST_CASE("a display byte is the truncated power 1/2.2 of the light") {
  CHECK(to_display_byte(0) == 0);
  CHECK(to_display_byte(1) == 255);
  CHECK(to_display_byte(7) == 255);
  CHECK(to_display_byte(-1) == 0);
  CHECK(to_display_byte(std::nanf("")) == 0);
  CHECK(to_display_byte(0.5f) == 186);
  for (int k = 1; k < 256; ++k) {
    const float least = kDisplayThresholds[static_cast<std::size_t>(k)];
    CHECK(least == doctest::Approx(std::pow(k / 255.0, 2.2)).epsilon(1e-6));
    CHECK(to_display_byte(least) == k);
    CHECK(to_display_byte(std::nextafterf(least, 0)) == k - 1);
  }
}

// The law in README.md, read once more in double precision.
double law(const double (&n)[3], const double (&v)[3], double rho, double emission,
           double roughness, double f0, double metallic, double ambient,
           const std::vector<LightRay>& suns) {
  double c = emission + ambient * (1 - metallic) * rho;
  for (const LightRay& sun : suns) {
    const double l[3] = {sun.x, sun.y, sun.z};
    double h[3], length = 0;
    for (int k = 0; k < 3; ++k) {
      h[k] = l[k] + v[k];
      length += h[k] * h[k];
    }
    double noh = 0, voh = 0, nov = 0, nol = 0;
    for (int k = 0; k < 3; ++k) {
      h[k] /= std::sqrt(length);
      noh += n[k] * h[k];
      voh += v[k] * h[k];
      nov += n[k] * v[k];
      nol += n[k] * l[k];
    }
    noh = std::clamp(noh, 1e-6, 1.0);
    voh = std::clamp(voh, 1e-6, 1.0);
    nov = std::clamp(nov, 1e-6, 1.0);
    nol = std::clamp(nol, 0.0, 1.0);
    const double a = roughness * roughness, k = (a + 2 * roughness + 1) / 8;
    const double s = a * a /
                     std::clamp(4 * M_PI * std::pow(noh * noh * (a * a - 1) + 1, 2) *
                                    (nov * (1 - k) + k) * (nol * (1 - k) + k),
                                1e-6, 4 * M_PI);
    const double f = f0 * (1 - metallic) + rho * metallic;
    const double fresnel = f + (1 - f) * std::pow(1 - voh, 5);
    c += sun.irradiance * nol * (rho * (1 - metallic) / M_PI + s * fresnel);
  }
  return c;
}

TEST_CASE("ten thousand random inputs are shaded within one level of a double-precision reading") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<float> unit(0, 1);
  const auto direction = [&](double(&out)[3]) {
    double length = 0;
    for (double& x : out) {
      x = normal(random);
      length += x * x;
    }
    for (double& x : out) x = static_cast<float>(x / std::sqrt(length));
  };
  const auto input = std::make_unique<ShadeInput>();
  const auto output = std::make_unique<ShadeOutput>();
  int far = 0, mid_range = 0;
  for (int round = 0; round < 100; ++round) {
    LightTable lights{.ambient = unit(random), .suns = {}};
    for (int s = 0; s < 3; ++s) {
      double l[3];
      direction(l);
      lights.suns.push_back({static_cast<float>(l[0]), static_cast<float>(l[1]),
                             static_cast<float>(l[2]), 2 * unit(random)});
    }
    double n[100][3], v[100][3];
    for (std::size_t i = 0; i < 100; ++i) {
      direction(n[i]);
      direction(v[i]);
      double facing = 0;
      for (int k = 0; k < 3; ++k) facing += n[i][k] * v[i][k];
      if (facing < 0) {
        for (double& x : v[i]) x = -x;
      }
      input->nx[i] = static_cast<float>(n[i][0]);
      input->ny[i] = static_cast<float>(n[i][1]);
      input->nz[i] = static_cast<float>(n[i][2]);
      input->vx[i] = static_cast<float>(v[i][0]);
      input->vy[i] = static_cast<float>(v[i][1]);
      input->vz[i] = static_cast<float>(v[i][2]);
      input->albedo_r[i] = unit(random);
      input->albedo_g[i] = unit(random);
      input->albedo_b[i] = unit(random);
      input->emission_r[i] = 0.1f * unit(random);
      input->emission_g[i] = input->emission_b[i] = 0;
      input->roughness[i] = 0.1f + 0.9f * unit(random);
      input->f0[i] = 0.1f * unit(random);
      input->metallic[i] = i % 3 == 0 ? unit(random) : 0;
    }
    pad(*input, 100);
    shade(*input, 100, lights, {}, *output);
    for (std::size_t i = 0; i < 100; ++i) {
      const double red =
          law(n[i], v[i], input->albedo_r[i], input->emission_r[i], input->roughness[i],
              input->f0[i], input->metallic[i], lights.ambient, lights.suns);
      const double blue = law(n[i], v[i], input->albedo_b[i], 0, input->roughness[i], input->f0[i],
                              input->metallic[i], lights.ambient, lights.suns);
      for (const auto& [ours, theirs] : {std::pair{output->r[i], red}, {output->b[i], blue}}) {
        const int expected =
            static_cast<int>(255 * std::pow(std::clamp(theirs, 0.0, 1.0), 1 / 2.2));
        if (std::abs(to_display_byte(ours) - expected) > 1) ++far;
        if (expected > 20 && expected < 250) ++mid_range;
      }
    }
  }
  CHECK(far == 0);
  CHECK(mid_range > 5000);
}

TEST_CASE("a sun that is not seen adds nothing, and padding is harmless") {
  const auto input = std::make_unique<ShadeInput>();
  const auto output = std::make_unique<ShadeOutput>();
  pad(*input, 0);
  for (std::size_t i = 0; i < 16; ++i) {
    input->nz[i] = input->vz[i] = input->roughness[i] = 1;
    input->nx[i] = input->ny[i] = input->vx[i] = input->vy[i] = input->metallic[i] = 0;
    input->albedo_r[i] = input->albedo_g[i] = input->albedo_b[i] = 0.5f;
    input->emission_r[i] = input->emission_g[i] = input->emission_b[i] = input->f0[i] = 0;
  }
  const LightTable lights{.ambient = 0.3f, .suns = {{0, 0, 1, 2, true}}};
  std::array<float, kTileSamples> visible{};
  visible[1] = 1;
  shade(*input, 2, lights, {{visible.data()}, nullptr}, *output);
  CHECK(output->r[0] == doctest::Approx(0.15));
  CHECK(output->r[1] > 0.4f);
  pad(*input, 2);
  shade(*input, 2, lights, {{visible.data()}, nullptr}, *output);
  CHECK(output->r[5] == 0.0f);
}

}  // namespace
}  // namespace probe::render
