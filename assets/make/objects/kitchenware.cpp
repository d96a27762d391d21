// What a kitchen's tasks handle: a bowl, a mug with a handle, a bottle, a tray and a basket. Hollow
// things are felt as a base and a ring of convex segments.
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/lettering.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

constexpr double kGloss = 0.008;
constexpr double kSide = 0.62;  // gain between an upright wall's and a top's

Colour upright(const Colour& lit) { return albedo_for(lit, kSide, kGloss); }
Colour lying(const Colour& lit) { return albedo_for(lit, kGainUp, kGloss); }

// Turned about z; 72 columns: a multiple of 4, so that the box is met exactly.
Part turned(std::span<const Vec2> profile, const std::string& name, const Colour& colour,
            double roughness) {
  Surface surface = in_metres(lathe(profile, 72, around_and_along));
  smooth_normals(surface, 40);
  return plain_part(std::move(surface), name, colour, roughness);
}

// Boards lie along x; their grain is noise that is long where the board is.
Image wood_texture() {
  constexpr int kWidth = 512, kHeight = 352;
  const Colour light = texel_for({196, 150, 98}, kGainUp, 0.004);
  const Colour dark = texel_for({150, 104, 62}, kGainUp, 0.004);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double x = (column + 0.5) / kWidth * 260, y = (row + 0.5) / kHeight * 180;
      const double board = std::floor(y / 45);
      const double grain = value_noise(x / 60 + 7 * board, y / 2.2, {}, 71);
      const double cloud = value_noise(x / 90, y / 12 + 31 * board, {}, 72);
      const double seam = smooth_step(0.9, 0.3, std::abs(y - 45 * std::floor(y / 45 + 0.5)));
      Colour c = mix(light, dark, 0.55 * grain + 0.35 * cloud);
      image.set(column, row, mix(c, dark, 0.7 * seam));
    }
  }
  return image;
}

// A cream band that goes round the bottle, the word on it three times.
Image oil_label() {
  constexpr int kWidth = 512, kHeight = 128;
  constexpr double kFace = 54.5, kTall = 44;  // mm
  const Colour cream = texel_for({232, 222, 190}, kSide, kGloss);
  const Colour ink = texel_for({60, 74, 30}, kSide, kGloss);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double turn = (column + 0.5) / kWidth * 3;
      const Vec2 at((turn - std::floor(turn) - 0.5) * kFace, (0.5 - (row + 0.5) / kHeight) * kTall);
      const Vec2 size(26, 14), from = at + size / 2;
      const Vec2 place(from.x() / size.x() * text_width("OIL"), from.y() / size.y());
      const double word = smooth_step(0.145, 0.105, stroke_distance("OIL", place));
      const double line = smooth_step(0.9, 0.5, std::abs(std::abs(at.y()) - 17.5));
      image.set(column, row, mix(cream, ink, std::max(word, line)));
    }
  }
  return image;
}

// Bands of canes that go over and under one another.
Image wicker_texture() {
  constexpr int kSize = 256;
  constexpr double kAcross = 140, kBand = 10;  // mm
  const Colour light = texel_for({206, 162, 98}, kGainUp, 0.004);
  const Colour dark = texel_for({126, 84, 44}, kGainUp, 0.004);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double u = (column + 0.5) / kSize * kAcross / kBand;
      const double v = (row + 0.5) / kSize * kAcross / kBand;
      const bool along = (static_cast<int>(std::floor(u)) + static_cast<int>(std::floor(v))) % 2;
      const double across = along ? v - std::floor(v) : u - std::floor(u);
      // Four canes to a band, dark between them and towards its sides.
      const double cane = std::abs(4 * across - std::floor(4 * across) - 0.5);
      const double side = smooth_step(0.38, 0.5, std::abs(across - 0.5));
      image.set(column, row, mix(light, dark, std::max(smooth_step(0.25, 0.5, cane), side)));
    }
  }
  return image;
}

// Hollow and open above, with upright walls; millimetres, centred.
struct OpenBox {
  Vec3 half;
  double floor, wall;  // how thick
  Image seen_inside;   // lies on the floor
  Colour rim;
  double roughness;
};
std::vector<OutputFile> open_box(const std::string& name, const OpenBox& shape) {
  const double x = shape.half.x(), y = shape.half.y(), thick = shape.wall;
  const double low = -shape.half.z(), floor_top = low + shape.floor, top = shape.half.z();
  Surface floor =
      cushion({.half = {x - 1, y - 1, shape.floor / 2}, .corner = 2, .rim = 0.3, .rim_steps = 1},
              seen_from_above({2 * x, 2 * y}));
  move_points(floor,
              [&](const Vec3& p) { return Vec3(p.x(), p.y(), p.z() + low + shape.floor / 2); });
  floor = in_metres(std::move(floor));
  smooth_normals(floor, 30);
  struct Wall {
    const char* name;
    Vec3 low, high;
  };
  const std::array<Wall, 4> walls{
      {{"front", {-x, -y, floor_top}, {x, -y + thick, top}},
       {"back", {-x, y - thick, floor_top}, {x, y, top}},
       {"left", {-x, thick - y, floor_top}, {-x + thick, y - thick, top}},
       {"right", {x - thick, thick - y, floor_top}, {x, y - thick, top}}}};
  std::vector<Polyhedron> parts{hull_mm(box_points({-x, -y, low}, {x, y, floor_top}, 0), "floor")};
  Surface rim;
  for (const Wall& wall : walls) {
    parts.push_back(hull_mm(box_points(wall.low, wall.high, 0), wall.name));
    // Down to the foot, so that the floor's edge is not seen from the side.
    const Vec3 foot(wall.low.x(), wall.low.y(), low);
    add_faces(rim, convex_hull(box_points(foot, wall.high, 0.8), wall.name));
  }
  return object_files(name,
                      {painted_part(std::move(floor), "floor", shape.seen_inside, 0.8),
                       plain_part(in_metres(std::move(rim)), "rim", shape.rim, shape.roughness)},
                      parts);
}

}  // namespace

// 11 cm across and 5.5 cm tall: wider than a hand opens, so it is taken by its wall.
std::vector<OutputFile> make_bowl() {
  const std::vector<Vec2> inside{{0, -22},   {26, -22},  {33, -20.5},  {38, -15},   {46.5, 8},
                                 {50.2, 22}, {51, 26.2}, {52.4, 27.5}, {53.8, 27.2}};
  const std::vector<Vec2> outside{{53.8, 27.2}, {55, 25},    {54.4, 18},  {51.6, 0},
                                  {46, -14},    {40.5, -24}, {38, -27.5}, {0, -27.5}};
  const std::vector<Vec2> wall{{36, -22}, {41, -22}, {51.6, 0}, {55, 25}, {52.5, 27.5}, {51, 26}};
  std::vector<Vec3> base;
  for (const auto& [radius, z] : {std::pair{38.0, -27.5}, std::pair{41.0, -22.0}}) {
    for (const Vec3& p : circle(radius, 12, z)) base.push_back(p);
  }
  std::vector<Polyhedron> parts{hull_mm(base, "base")};
  add_ring(parts, wall, 12, "wall");
  return object_files("bowl",
                      {turned(inside, "inside", lying({236, 232, 222}), 0.5),
                       turned(outside, "outside", upright({52, 92, 160}), 0.5)},
                      parts);
}

// The handle shows along +x; the body, 6.4 cm across, is centred.
std::vector<OutputFile> make_mug() {
  const std::vector<Vec2> inside{{0, -38}, {25, -38},    {27.4, -35.5},
                                 {28, 40}, {28.8, 42.1}, {30, 42.5}};
  const std::vector<Vec2> outside{{30, 42.5},  {31.4, 42},  {32, 40.4}, {32, -37.5},
                                  {30.6, -41}, {28, -42.5}, {0, -42.5}};
  const std::vector<Vec2> wall{{28, -38},    {32, -38},  {32, 40.5},
                               {30.5, 42.5}, {29, 42.5}, {28, 40}};
  std::vector<Vec3> base;
  for (const auto& [radius, z] : {std::pair{28.0, -42.5}, std::pair{32.0, -38.0}}) {
    for (const Vec3& p : circle(radius, 12, z)) base.push_back(p);
  }
  std::vector<Polyhedron> parts{hull_mm(base, "base")};
  add_ring(parts, wall, 12, "wall");
  parts.push_back(hull_mm(box_points({32, -4, 18}, {54, 4, 26}, 0), "handle_top"));
  parts.push_back(hull_mm(box_points({46, -4, -18}, {54, 4, 18}, 0), "handle_bar"));
  parts.push_back(hull_mm(box_points({32, -4, -26}, {54, 4, -18}, 0), "handle_low"));
  const std::vector<Vec3> bend{{29, 0, 22},  {42, 0, 22},    {48, 0, 19.5}, {50, 0, 13},
                               {50, 0, -13}, {48, 0, -19.5}, {42, 0, -22},  {29, 0, -22}};
  Surface handle = in_metres(rod({.path = bend, .radius = 4, .corners = 12}));
  smooth_normals(handle, 50);
  const Colour red = upright({186, 46, 40});
  return object_files(
      "mug",
      {turned(inside, "inside", lying({238, 234, 226}), 0.5), turned(outside, "outside", red, 0.5),
       plain_part(std::move(handle), "handle", red, 0.5)},
      parts);
}

// Stands on its foot, 5.2 cm across and 15 cm tall; held at the neck or around the body.
std::vector<OutputFile> make_bottle() {
  const std::vector<Vec2> cap{{0, 75},  {12, 75},   {12.8, 74.4}, {13, 73.5},
                              {13, 58}, {12.6, 57}, {10.5, 57}};
  const std::vector<Vec2> neck{{10.5, 57}, {10.5, 46}, {12, 41}, {19, 30}, {24.4, 22.5}, {26, 16}};
  const std::vector<Vec2> low{{26, -28}, {26, -70}, {25, -73.6}, {22.5, -75}, {0, -75}};
  const std::vector<Vec2> band{{26, 16}, {26, -28}};
  Surface label = in_metres(lathe(band, 72, around_and_along));
  smooth_normals(label, 40);
  std::vector<Vec3> body, top;
  for (const auto& [apothem, z, corners] :
       {std::tuple{26.0, -75.0, 12}, {26.0, 18.0, 12}, {11.0, 44.0, 8}}) {
    for (const Vec3& p : flat_sided(apothem, corners, z)) body.push_back(p);
  }
  for (const double z : {44.0, 75.0}) {
    for (const Vec3& p : flat_sided(13, 8, z)) top.push_back(p);
  }
  const Colour green = upright({74, 110, 46});
  return object_files(
      "bottle",
      {turned(cap, "cap", upright({70, 62, 54}), 0.5), turned(neck, "neck", green, 0.3),
       turned(low, "body", green, 0.3), painted_part(std::move(label), "label", oil_label(), 0.7)},
      {hull_mm(body, "body"), hull_mm(top, "neck")});
}

// 26 cm x 18 cm, its rim 2 cm high.
std::vector<OutputFile> make_tray() {
  return open_box("tray", {.half = {130, 90, 10},
                           .floor = 5,
                           .wall = 7,
                           .seen_inside = wood_texture(),
                           .rim = lying({150, 104, 62}),
                           .roughness = 0.7});
}

// 14 cm across and 4 cm tall: what lies in it has its middle below the rim.
std::vector<OutputFile> make_wicker_basket() {
  return open_box("wicker_basket", {.half = {70, 70, 20},
                                    .floor = 4,
                                    .wall = 5,
                                    .seen_inside = wicker_texture(),
                                    .rim = lying({176, 128, 72}),
                                    .roughness = 0.9});
}

}  // namespace probe::make
