// Sponge, 7 x 10 x 3.6 cm, and half of it in every direction: yellow foam with a green scouring
// layer on top and a waist for the hand.
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kWaist = 0.11;  // of the half width, at y = 0

double narrowing(double y) {
  if (std::abs(y) > 34) return 1;
  return 1 - kWaist * (0.5 + 0.5 * portable_cos(kPi * y / 34));
}

Surface layer(double low, double high, double rim, const Mapping& uv) {
  Surface surface = cushion({.half = {35, 50, (high - low) / 2},
                             .corner = 8,
                             .rim = rim,
                             .corner_steps = 4,
                             .side_steps = 12,
                             .rim_steps = 2,
                             .rings = 1},
                            uv);
  move_points(surface, [&](const Vec3& p) {
    return Vec3(p.x() * narrowing(p.y()), p.y(), p.z() + (low + high) / 2);
  });
  return surface;
}

Image foam_texture() {
  constexpr int kWidth = 512, kHeight = 128;
  const Colour yellow = texel_for({214, 168, 50}, 0.43, 0.002);
  const Colour hole = texel_for({150, 104, 22}, 0.43, 0.002);
  const Colour pale = texel_for({232, 190, 80}, 0.43, 0.002);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) / kWidth, v = (row + 0.5) / kHeight;
      const double small = value_noise(u * 190, v * 56, {.x = 190, .y = 56}, 101);
      const double large = value_noise(u * 90, v * 26, {.x = 90, .y = 26}, 102);
      Colour c = mix(yellow, pale, smooth_step(0.3, 0.8, small));
      c = mix(c, hole, 0.75 * smooth_step(0.72, 0.84, large) + 0.5 * smooth_step(0.8, 0.9, small));
      image.set(column, row, c);
    }
  }
  return image;
}

Image scourer_texture() {
  constexpr int kWidth = 128, kHeight = 192;
  const Colour green = texel_for({42, 104, 62}, kGainUp, 0.002);
  const Colour light = texel_for({66, 134, 84}, kGainUp, 0.002);
  const Colour dark = texel_for({22, 72, 40}, kGainUp, 0.002);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double x = column, y = row;
      const double fibre =
          value_noise(x / 1.5, y / 5, {}, 103) + value_noise(x / 5, y / 1.5, {}, 104);
      const Colour c = mix(green, fibre > 1 ? light : dark, 1.2 * std::abs(fibre - 1));
      image.set(column, row, c);
    }
  }
  return image;
}

std::vector<OutputFile> make_sponge_of(const std::string& name, double scale) {
  Surface foam = layer(-18, 9.5, 1.5, around_and_along);
  Surface scourer = layer(9.5, 18, 1.8, seen_from_above({72, 102}));
  Surface* both[] = {&foam, &scourer};
  fit_to_box(both, box_of(Vec3(70, 100, 36) * scale));
  smooth_normals(foam, 50);
  smooth_normals(scourer, 50);
  // Two ends and a narrower middle.
  std::vector<Polyhedron> parts;
  const double waist = 35 * (1 - 0.75 * kWaist);
  const auto add = [&](const std::string& part, std::initializer_list<Vec2> corners) {
    std::vector<Vec3> points;
    for (const Vec2& at : corners) {
      for (const double z : {-18.0, 18.0}) {
        for (const double x : {-at.x(), at.x()}) points.push_back(scale * Vec3(x, at.y(), z));
      }
    }
    parts.push_back(hull_mm(points, part));
  };
  add("front", {{waist, -17}, {35, -34}, {35, -45}, {30, -50}});
  add("middle", {{waist, -17}, {waist, 17}});
  add("back", {{waist, 17}, {35, 34}, {35, 45}, {30, 50}});
  return object_files(name,
                      {painted_part(foam, "foam", foam_texture(), 1),
                       painted_part(scourer, "scourer", scourer_texture(), 1)},
                      parts);
}

}  // namespace

std::vector<OutputFile> make_sponge() { return make_sponge_of("sponge", 1); }
std::vector<OutputFile> make_half_sponge() { return make_sponge_of("half_sponge", 0.5); }

}  // namespace probe::make
