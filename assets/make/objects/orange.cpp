// The orange: 3.5 x 3.5 x 3.4 cm, pores in the peel, a green stalk star on top. The collision shape
// has small facets, so that it stays where it is put.
#include <array>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

Surface peel_surface() {
  constexpr double kRadius = 17.5;
  std::vector<Vec2> profile{{0, 15.9}, {1.4, 16.0}, {2.8, 16.7}, {4.15, 17.0}};
  constexpr int kSteps = 20;
  for (int i = 1; i < kSteps; ++i) {
    const SinCos a = portable_sincos_deg(76.3 - 152.6 * i / kSteps);
    profile.emplace_back(kRadius * a.cos, kRadius * a.sin);
  }
  profile.emplace_back(4.15, -17.0);
  profile.emplace_back(1.5, -16.8);
  profile.emplace_back(0, -16.6);
  return lathe(profile, 44, around_and_along);
}

Surface star_surface() {
  std::vector<std::vector<Vec3>> rows(3);
  for (int c = 0; c < 20; ++c) {
    const SinCos a = portable_sincos_deg(18 * c);
    const double lobe = c % 4 == 0 ? 3.4 : (c % 4 == 2 ? 1.5 : 2.2);
    rows[0].emplace_back(0, 0, 16.95);
    rows[1].emplace_back(0.6 * lobe * a.cos, 0.6 * lobe * a.sin, 16.9);
    rows[2].emplace_back(lobe * a.cos, lobe * a.sin, 16.85);
  }
  return skin(rows, true, around_and_along);
}

Image peel_texture() {
  constexpr int kWidth = 256, kHeight = 128;
  const Colour orange = texel_for({255, 140, 20}, 1.0, 0.01);
  const Colour light = texel_for({255, 166, 56}, 1.0, 0.01);
  const Colour pore = texel_for({214, 100, 6}, 1.0, 0.01);
  const Colour crown = texel_for({206, 146, 36}, 1.0, 0.01);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) / kWidth, v = (row + 0.5) / kHeight;
      const double pores = value_noise(u * 120, v * 60, {.x = 120, .y = 64}, 121);
      const double broad = value_noise(u * 8, v * 5, {.x = 8, .y = 8}, 122);
      Colour c = mix(orange, light, 0.6 * smooth_step(0.4, 0.9, broad));
      c = mix(c, pore, 0.55 * smooth_step(0.70, 0.88, pores));
      c = mix(c, light, 0.3 * smooth_step(0.34, 0.14, pores));
      image.set(column, row, mix(c, crown, 0.8 * smooth_step(0.15, 0.09, v)));
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_orange() {
  Surface peel = peel_surface(), star = star_surface();
  Surface* both[] = {&peel, &star};
  fit_to_box(both, box_of({35, 35, 34}));
  smooth_normals(peel, 60);
  smooth_normals(star, 60);
  // The widest band's sides are flat and upright, a pair of them for the fingers.
  std::vector<Vec3> hull;
  for (const auto& [apothem, z] :
       {std::pair{6.0, 17.0}, std::pair{17.5, 4.6}, std::pair{17.5, -4.6}, std::pair{6.0, -17.0}}) {
    const std::vector<Vec3> ring = flat_sided(apothem, apothem < 7 ? 4 : 12, z);
    hull.insert(hull.end(), ring.begin(), ring.end());
  }
  return object_files("orange",
                      {painted_part(peel, "peel", peel_texture(), 0.55),
                       plain_part(star, "stalk", albedo_for({58, 104, 36}, kGainUp, 0.004), 0.9)},
                      {hull_mm(hull, "fruit")});
}

}  // namespace probe::make
