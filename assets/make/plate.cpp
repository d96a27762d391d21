// The plate: 11 x 11 x 0.6 cm, a flat well and a low sloping rim. In the collision shape only the
// base meets the table; the rim is a ring of convex segments on top of it.
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Radius and height, mm, from the middle of the top round the edge to the middle of the bottom.
constexpr std::array<std::array<double, 2>, 15> kProfile{{{0, -0.5},
                                                          {34.5, -0.5},
                                                          {36.5, -0.35},
                                                          {38.0, 0.2},
                                                          {39.5, 0.95},
                                                          {41.0, 1.35},
                                                          {43.5, 1.65},
                                                          {53.4, 2.95},
                                                          {54.4, 3.0},
                                                          {55.0, 2.5},
                                                          {55.0, 1.8},
                                                          {53.8, 1.3},
                                                          {48.6, -2.4},
                                                          {47.6, -3.0},
                                                          {0, -3.0}}};

Surface plate_surface() {
  constexpr int kColumns = 72;  // a multiple of 4, so that the box is met exactly
  Grid grid{.rows = static_cast<int>(kProfile.size()),
            .columns = kColumns,
            .closed = true,
            .points = {},
            .uv = {}};
  for (const auto& [radius, height] : kProfile) {
    for (int column = 0; column <= kColumns; ++column) {
      const SinCos a = portable_sincos_deg(360.0 * column / kColumns);
      const Vec2 flat(radius * a.cos, radius * a.sin);
      grid.uv.emplace_back(0.5 + flat.x() / 112, 0.5 - flat.y() / 112);
      if (column == kColumns) continue;
      grid.points.emplace_back(flat.x() / 1000, flat.y() / 1000, height / 1000);
    }
  }
  Surface surface;
  add_grid(surface, grid);
  smooth_normals(surface, 40);
  return surface;
}

Image plate_texture() {
  constexpr int kSize = 256;
  const Colour glaze = texel_for({230, 247, 167}, kGainUp, 0.006);
  const Colour ring = texel_for({216, 234, 153}, kGainUp, 0.006);
  const Colour edge = texel_for({222, 239, 158}, kGainUp, 0.006);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = ((column + 0.5) / kSize - 0.5) * 112, y = (0.5 - (row + 0.5) / kSize) * 112;
      const double radius = std::sqrt(x * x + y * y);
      // The step into the well is the inner ring that says "plate" in a picture.
      const double on_step = smooth_step(34.0, 35.5, radius) * smooth_step(43.0, 41.0, radius);
      const double cloud = value_noise(x / 9 + 100, y / 9 + 100, {}, 41);
      Colour c = mix(glaze, ring, 0.85 * on_step + 0.10 * (cloud - 0.5));
      c = mix(c, edge, smooth_step(53.8, 54.8, radius));
      image.set(column, row, c);
    }
  }
  return image;
}

std::vector<Polyhedron> collision_parts() {
  constexpr int kSegments = 12;
  constexpr std::array<std::array<double, 2>, 6> kRim{
      {{37, -0.5}, {48, -0.5}, {55, 1.8}, {55, 3.0}, {53.5, 3.0}, {41, 1.4}}};
  std::vector<Vec3> base;
  std::vector<Polyhedron> parts;
  const auto at = [](double radius, double height, int corner) {
    const SinCos a = portable_sincos_deg(360.0 * corner / kSegments);
    return Vec3(radius * a.cos / 1000, radius * a.sin / 1000, height / 1000);
  };
  for (int i = 0; i < kSegments; ++i) {
    base.push_back(at(48, -3.0, i));
    base.push_back(at(48, -0.5, i));
  }
  parts.push_back(convex_hull(base, "base"));
  for (int i = 0; i < kSegments; ++i) {
    std::vector<Vec3> rim;
    for (const auto& [radius, height] : kRim) {
      rim.push_back(at(radius, height, i));
      rim.push_back(at(radius, height, i + 1));
    }
    parts.push_back(convex_hull(rim, "rim_" + std::to_string(i)));
  }
  return parts;
}

}  // namespace

std::vector<OutputFile> make_plate() {
  std::vector<Part> parts;
  parts.push_back(
      {plate_surface(), {.name = "glaze", .texture = plate_texture(), .roughness = 0.8}});
  return {{"objects/plate/visual.glb", glb_bytes("plate", parts)},
          {"objects/plate/collision.obj", obj_bytes(collision_parts())}};
}

}  // namespace probe::make
