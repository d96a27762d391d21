// The table scene's backdrop in world coordinates: a red-brown wooden table with a rounded front
// edge, grey woven partitions behind and at the left, a dark blue cloth below the front edge.
// Albedos are chosen for the table's light.
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kTop = 0.87;
constexpr double kBack = -0.345, kFront = 0.03;  // x
constexpr double kLeft = -0.295, kRight = 0.45;  // y
constexpr double kThickness = 0.030, kRound = 0.015;

// The board's outline from the back over the top and round the front edge down to the underside,
// swept along y.
Surface table_surface() {
  std::vector<Vec2> outline{{kBack, kTop - kThickness}, {kBack, kTop}};
  constexpr int kSteps = 8;
  for (int i = 0; i <= 2 * kSteps; ++i) {
    const SinCos a = portable_sincos_deg(90 - 90.0 * i / kSteps);
    outline.emplace_back(kFront - kRound + kRound * a.cos, kTop - kRound + kRound * a.sin);
  }
  outline.emplace_back(kBack, kTop - kThickness);
  Grid grid{.rows = static_cast<int>(outline.size()),
            .columns = 2,
            .closed = false,
            .points = {},
            .uv = {}};
  double along = -kThickness;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (i > 0) along += (outline[i] - outline[i - 1]).norm();
    const double u = along / 0.40;  // 0 at the back edge of the top
    for (const double y : {kLeft, kRight}) {
      grid.points.emplace_back(outline[i].x(), y, outline[i].y());
      grid.uv.emplace_back(u, (y - kLeft) / (kRight - kLeft));
    }
  }
  Surface surface;
  add_grid(surface, grid);
  smooth_normals(surface, 30);
  // The two ends.
  for (const double y : {kLeft, kRight}) {
    for (std::size_t i = 1; i + 2 < outline.size(); ++i) {
      const auto point = [&](std::size_t k) { return Vec3(outline[k].x(), y, outline[k].y()); };
      Triangle t{.position = {point(0), point(i), point(i + 1)},
                 .normal = {},
                 .uv = {Vec2(0, 0), Vec2(0.1, 0), Vec2(0.1, 0.04)}};
      if (y == kLeft) std::swap(t.position[1], t.position[2]);
      t.normal.fill(Vec3(0, y == kLeft ? -1 : 1, 0));
      surface.push_back(t);
    }
  }
  return surface;
}

// u is the distance across the grain (0.40 m a texture), v along it (0.745 m).
Image wood_texture() {
  constexpr int kWidth = 512, kHeight = 512;
  constexpr double kShine = 0.030;
  const Colour middle = texel_for({170, 94, 63}, kGainUp, kShine);
  const Colour dark = texel_for({140, 66, 42}, kGainUp, kShine);
  const Colour light = texel_for({188, 114, 82}, kGainUp, kShine);
  const Colour pore = texel_for({124, 56, 36}, kGainUp, kShine);
  const Colour hazy = texel_for({196, 140, 122}, kGainUp, kShine);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double x = (column + 0.5) / kWidth * 400, y = (row + 0.5) / kHeight * 745;  // mm
      // Growth rings: bands across the grain, bent slowly along it, so that they run together into
      // flames.
      const double bend =
          34 * value_noise(x / 90 + 7, y / 220, {}, 51) + 7 * value_noise(x / 24, y / 70, {}, 52);
      const double rings = value_noise((x + bend) / 5, y / 500, {}, 53);
      const double streak = value_noise((x + 0.7 * bend) / 2.2, y / 60, {}, 57);
      const double fine = value_noise(x / 1.1, y / 34, {}, 54);
      const double broad = value_noise(x / 80, y / 160, {}, 55);
      const double fleck = value_noise(x / 0.9, y / 9, {}, 56);
      Colour c = mix(middle, dark, 0.50 * smooth_step(0.35, 0.9, rings));
      c = mix(c, light, 0.55 * smooth_step(0.4, 0.95, broad) * (1 - 0.5 * rings));
      c = mix(c, streak > 0.5 ? light : dark, 0.55 * std::abs(streak - 0.5));
      c = mix(c, fine > 0.5 ? light : dark, 0.50 * std::abs(fine - 0.5));
      c = mix(c, pore, 0.38 * smooth_step(0.80, 0.97, fleck));
      // The room's windows mirrored in the varnish at both ends, and less light close to the
      // partition.
      const double window = smooth_step(300, 90, y) * smooth_step(60, 160, x) +
                            0.8 * smooth_step(400, 570, y) * smooth_step(330, 180, x);
      c = mix(c, hazy, 0.75 * clamp01(window));
      c = mix(c, dark, 0.45 * smooth_step(70, 40, x) * smooth_step(120, 250, y));
      image.set(column, row, c);
    }
  }
  return image;
}

// Woven cloth: short threads across and along, one texture is 0.30 m square and repeats.
Image weave_texture(const Colour& lit, double gain, double contrast) {
  constexpr int kSize = 256;
  const auto texel = [&](double shift) {
    return texel_for({lit[0] + shift, lit[1] + shift, lit[2] + shift}, gain, 0.002);
  };
  const Colour dark = texel(-contrast), light = texel(contrast);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = column, y = row;
      const double across = value_noise(x / 4, y / 1.0, {.x = kSize / 4, .y = kSize}, 61);
      const double along = value_noise(x / 1.0, y / 4, {.x = kSize, .y = kSize / 4}, 62);
      const double broad = value_noise(x / 32, y / 64, {.x = kSize / 32, .y = kSize / 64}, 63);
      const double grain =
          hash01(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), 64);
      image.set(column, row,
                mix(dark, light, 0.38 * across + 0.36 * along + 0.08 * broad + 0.18 * grain));
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_table_scene() {
  constexpr double kTile = 0.30;
  Surface behind, left, cloth, seam, stand;
  // Behind: the plane x = -0.36 turned to +x. Left: the plane y = -0.31 turned to +y. They meet in
  // a corner.
  behind = sheet({-0.36, -0.31, 0.55}, {0, 2.0, 0}, {0, 0, 1.25}, {2.0 / kTile, 1.25 / kTile});
  left = sheet({1.2, -0.31, 0.55}, {-1.56, 0, 0}, {0, 0, 1.25}, {1.56 / kTile, 1.25 / kTile});
  seam = sheet({-0.3585, -0.310, 0.55}, {0, 0.006, 0}, {0, 0, 1.25}, {1, 1});
  cloth = sheet({-0.36, -0.31, 0.72}, {1.56, 0, 0}, {0, 2.0, 0}, {1.56 / kTile, 2.0 / kTile});
  // Under the robot's base, outside the bench camera's picture: without it other views show the arm
  // in mid-air.
  add_faces(stand, convex_hull(box_points({0.085, -0.02, 0.72}, {0.295, 0.076, kTop}, 0), "stand"));
  std::vector<Part> parts;
  parts.push_back({table_surface(), {.name = "wood", .texture = wood_texture(), .roughness = 0.6}});
  parts.push_back({behind,
                   {.name = "partition_behind",
                    .texture = weave_texture({110, 110, 114}, kGainPlusX, 30),
                    .roughness = 1}});
  parts.push_back({left,
                   {.name = "partition_left",
                    .texture = weave_texture({122, 126, 132}, kGainPlusY, 24),
                    .roughness = 1}});
  parts.push_back({seam,
                   {.name = "seam",
                    .base_color = albedo_for({78, 78, 82}, kGainPlusX, 0.002),
                    .texture = std::nullopt,
                    .roughness = 1}});
  parts.push_back(
      {cloth,
       {.name = "cloth", .texture = weave_texture({47, 52, 62}, kGainUp, 9), .roughness = 1}});
  parts.push_back({stand,
                   {.name = "stand",
                    .base_color = albedo_for({96, 98, 102}, kGainPlusX, 0.002),
                    .texture = std::nullopt,
                    .roughness = 1}});
  return {{"scenes/table/visual.glb", glb_bytes("table", parts)}};
}

}  // namespace probe::make
