// Hex nut, 3.6 x 4 x 1.6 cm, flats across x, and toy wheel, 10.5 x 10.5 x 3 cm, lying flat.
#include <algorithm>
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kFlat = 18, kHole = 10;  // apothem of the hexagon, radius of the hole

// Corners at +-y.
double hexagon_radius(double angle_deg) {
  double off = angle_deg - 60 * std::floor(angle_deg / 60 + 0.5);
  return kFlat / portable_sincos_deg(off).cos;
}

Surface nut_body() {
  constexpr int kColumns = 72;
  std::vector<std::vector<Vec3>> rows(6);
  for (int c = 0; c < kColumns; ++c) {
    const double angle = 360.0 * c / kColumns;
    const SinCos a = portable_sincos_deg(angle);
    const double radius = hexagon_radius(angle), round = std::min(radius, 17.7);
    const double edge = 8 - 0.75 * (radius - round);  // the chamfer turned on the corners
    const auto add = [&](std::size_t row, double r, double z) {
      rows[row].emplace_back(r * a.cos, r * a.sin, z);
    };
    add(0, kHole + 1.4, 8);
    add(1, round, 8);
    add(2, radius, edge);
    add(3, radius, -edge);
    add(4, round, -8);
    add(5, kHole + 1.4, -8);
  }
  return skin(rows, true, seen_from_above({42, 42}));
}

// The bevel into the hole and a thread of ridges.
Surface nut_thread() {
  std::vector<Vec2> profile{{kHole + 1.4, -8}, {kHole, -6.8}};
  for (int ridge = 0; ridge < 7; ++ridge) {
    profile.emplace_back(kHole - 1.0, -6.8 + 1.94 * ridge + 0.97);
    profile.emplace_back(kHole, -6.8 + 1.94 * (ridge + 1));
  }
  profile.emplace_back(kHole + 1.4, 8);
  return lathe(profile, 36, around_and_along);
}

Image brushed_texture() {
  constexpr int kSize = 128;
  const Colour metal = texel_for({158, 161, 166}, kGainUp, 0.03);
  const Colour dark = texel_for({112, 115, 121}, kGainUp, 0.03);
  const Colour light = texel_for({208, 211, 215}, kGainUp, 0.03);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = ((column + 0.5) / kSize - 0.5) * 42, y = (0.5 - (row + 0.5) / kSize) * 42;
      const double radius = std::sqrt(x * x + y * y);
      const double turned = value_noise(radius * 2.2, 5, {}, 131);
      // A sheen as of a lamp mirrored in turned steel: two bright sectors.
      const double sheen = std::abs(x * y) / std::max(1.0, radius * radius) * 2;
      Colour c = mix(metal, turned > 0.5 ? light : dark, 0.5 * std::abs(turned - 0.5));
      image.set(column, row, mix(c, light, 0.6 * smooth_step(0.4, 1.0, sheen)));
    }
  }
  return image;
}

// Tread blocks round the tyre: two columns high, two low.
Surface tyre_surface() {
  constexpr int kColumns = 88;
  const std::vector<Vec2> profile{{36, 12.4},   {37.5, 14.6}, {40, 15},    {46.5, 15},
                                  {50.5, 13.6}, {52.5, 10},   {52.5, -10}, {50.5, -13.6},
                                  {46.5, -15},  {38, -15},    {36, -12}};
  std::vector<std::vector<Vec3>> rows;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    std::vector<Vec3> loop = circle(profile[i].x(), kColumns, profile[i].y());
    if (i >= 4 && i <= 7) {
      for (int c = 0; c < kColumns; ++c) {
        if ((c + 1) % 4 < 2) continue;
        loop[static_cast<std::size_t>(c)].head<2>() *= 1 - 2.4 / profile[i].x();
      }
    }
    rows.push_back(std::move(loop));
  }
  return skin(rows, true, around_and_along);
}

Surface rim_surface() {
  const std::vector<Vec2> ring{{32, -9}, {32.6, 9}, {34.4, 12.8}, {36.4, 12.8}, {36.4, -12}};
  Surface surface = lathe(ring, 48, around_and_along);
  for (int i = 0; i < 5; ++i) {
    const SinCos a = portable_sincos_deg(72 * i + 18);
    std::vector<Vec3> spoke;
    for (const auto& [along, half, top] : {std::tuple{9.0, 5.4, 8.6}, std::tuple{33.5, 3.6, 6.4}}) {
      for (const double side : {-1.0, 1.0}) {
        for (const auto& [inset, z] :
             {std::pair{0.0, -4.0}, std::pair{0.0, top - 1.2}, std::pair{1.2, top}}) {
          const double across = side * (half - inset);
          spoke.emplace_back(along * a.cos - across * a.sin, along * a.sin + across * a.cos, z);
        }
      }
    }
    add_faces(surface, convex_hull(spoke, "spoke"));
  }
  const std::vector<Vec2> hub{{4, 10.8}, {10.2, 10.8}, {11.4, 9.6}, {11.4, -8}, {0, -8}};
  append(surface, lathe(hub, 32, around_and_along));
  return surface;
}

}  // namespace

std::vector<OutputFile> make_nut() {
  Surface body = nut_body(), thread = nut_thread();
  Surface* both[] = {&body, &thread};
  fit_to_box(both, box_of({36, 40, 16}));
  smooth_normals(body, 24);
  smooth_normals(thread, 24);
  std::vector<Polyhedron> parts;
  const double squeeze = 40 / (2 * hexagon_radius(30));
  for (int side = 0; side < 6; ++side) {
    std::vector<Vec3> points;
    for (const int corner : {side, side + 1}) {
      const SinCos a = portable_sincos_deg(30 + 60 * corner);
      for (const double radius : {kHole + 0.6, hexagon_radius(30)}) {
        for (const double z : {-8.0, 8.0}) {
          points.emplace_back(radius * a.cos, radius * a.sin * squeeze, z);
        }
      }
    }
    parts.push_back(hull_mm(points, "side_" + std::to_string(side)));
  }
  return object_files("nut",
                      {painted_part(body, "steel", brushed_texture(), 0.35),
                       plain_part(thread, "thread", albedo_for({70, 72, 76}, 0.45, 0.004), 0.6)},
                      parts);
}

std::vector<OutputFile> make_wheel() {
  const Vec3 centre(0, 0, 3.75);
  Surface tyre = tyre_surface(), rim = rim_surface(), cap;
  append(cap, lathe(std::vector<Vec2>{{0, 12.2}, {2.6, 12.0}, {4, 10.8}}, 24, around_and_along));
  Surface* all[] = {&tyre, &rim, &cap};
  fit_to_box(all, box_of({105, 105, 30}, centre));
  for (Surface* surface : all) smooth_normals(*surface, 32);
  std::vector<Polyhedron> parts;
  const std::vector<Vec2> ring{{36, -15}, {48, -15}, {52.5, -10}, {52.5, 10}, {48, 15}, {36, 15}};
  add_ring(parts, ring, 12, "tyre", centre);
  // Spokes and gaps are one disc: nothing that is put on the wheel is small enough to fall through.
  std::vector<Vec3> disc;
  for (const double z : {-8.0, 8.0}) {
    for (const Vec3& p : circle(36, 12, z)) disc.push_back(centre + p);
  }
  parts.push_back(hull_mm(disc, "spokes"));
  const Colour light = albedo_for({212, 214, 218}, kGainUp, 0.01);
  return object_files("wheel",
                      {plain_part(tyre, "rubber", albedo_for({40, 40, 42}, kGainUp, 0.002), 0.95),
                       plain_part(rim, "rim", light, 0.5),
                       plain_part(cap, "cap", albedo_for({120, 30, 28}, kGainUp, 0.01), 0.5)},
                      parts);
}

}  // namespace probe::make
