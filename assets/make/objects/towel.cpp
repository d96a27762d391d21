// The towel: 10 x 10 x 1 cm, folded in three layers with soft corners; the +x edge is a fold, the
// others show the layers.
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

Surface layers() {
  Surface all;
  for (int layer = 0; layer < 3; ++layer) {
    // The lower layers peep out by their own uneven amounts.
    const double inset = layer == 2 ? 0.6 : 0.0, middle = -3.3 + 3.3 * layer;
    Surface slab = cushion({.half = {50 - inset, 50 - inset, 1.75},
                            .corner = 7,
                            .rim = 1.7,
                            .corner_steps = 3,
                            .side_steps = 9,
                            .rim_steps = 2,
                            .rings = layer == 2 ? 5 : 1},
                           seen_from_above({104, 104}));
    const auto seed = static_cast<std::uint32_t>(90 + layer);
    move_points(slab, [&](const Vec3& p) {
      const double wave = value_noise(p.x() / 22 + 50, p.y() / 22 + 50, {}, seed) - 0.5;
      const double edge = value_noise(p.x() / 13 + 80, p.y() / 13 + 80, {}, seed + 3) - 0.5;
      const double share = std::sqrt(p.x() * p.x() + p.y() * p.y()) / 50;
      return Vec3(p.x() * (1 - 0.02 * (0.5 + edge)), p.y() * (1 - 0.02 * (0.5 - edge)),
                  p.z() + middle + (layer == 2 ? 1.1 * wave - 0.8 * share * share : 0.3 * wave));
    });
    append(all, slab);
  }
  // The fold: a thick round edge round the two upper layers.
  append(all, tapered_rod(std::vector<Vec3>{{46.4, -48.5, 1.4},
                                            {46.6, -44, 1.6},
                                            {46.4, -15, 1.5},
                                            {46.7, 15, 1.7},
                                            {46.4, 44, 1.6},
                                            {46.2, 48.5, 1.4}},
                          std::vector<double>{2.2, 3.3, 3.4, 3.3, 3.4, 2.2}, 12));
  return all;
}

Image terry_texture() {
  constexpr int kSize = 256;
  const Colour blue = texel_for({187, 223, 239}, kGainUp, 0.002);
  const Colour light = texel_for({212, 238, 248}, kGainUp, 0.002);
  const Colour deep = texel_for({146, 192, 217}, kGainUp, 0.002);
  const Colour hem = texel_for({112, 168, 208}, kGainUp, 0.002);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = (column + 0.5) / kSize * 104 - 52, y = 52 - (row + 0.5) / kSize * 104;
      const double loops = value_noise(x / 0.9 + 200, y / 0.9 + 200, {}, 95);
      const double pile = value_noise(x / 3 + 200, y / 3 + 200, {}, 96);
      const double broad = value_noise(x / 18 + 200, y / 18 + 200, {}, 97);
      Colour c = mix(blue, loops > 0.5 ? light : deep, 1.1 * std::abs(loops - 0.5));
      c = mix(c, deep, 0.35 * smooth_step(0.55, 0.95, pile) + 0.15 * smooth_step(0.4, 0.9, broad));
      // Two woven stripes along the hems at both ends.
      const double from_edge = 50 - std::abs(y);
      for (const double stripe : {7.0, 11.0}) {
        c = mix(c, hem, 0.85 * smooth_step(1.2, 0.8, std::abs(from_edge - stripe)));
      }
      image.set(column, row, c);
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_towel() {
  Surface surface = layers();
  Surface* all[] = {&surface};
  fit_to_box(all, box_of({100, 100, 10}));
  smooth_normals(surface, 50);
  std::vector<Vec3> hull;
  for (const auto& [inset, z] :
       {std::pair{1.5, -5.0}, std::pair{0.0, -3.0}, std::pair{0.0, 2.5}, std::pair{2.5, 5.0}}) {
    const std::vector<Vec3> loop =
        outline({.half = Vec2::Constant(50 - inset), .radius = 6, .steps = 1, .side_steps = 1}, z);
    hull.insert(hull.end(), loop.begin(), loop.end());
  }
  return object_files("towel", {painted_part(surface, "terry", terry_texture(), 1)},
                      {hull_mm(hull, "folded")});
}

}  // namespace probe::make
