// The kitchen's backdrop in world coordinates: a stone worktop at 0.90 m with cupboards under it, a
// tiled wall behind the robot and a floor. Seen from +x, as the cameras of the kitchen see it.
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

constexpr double kTop = 0.90, kThickness = 0.04;
constexpr double kBack = -0.46, kFront = 0.30;  // x
constexpr double kSide = 0.75;                  // y, to both sides
constexpr double kWall = -1.25;                 // x

// Dense specks of three greys; 0.45 m square, repeats.
Image stone_texture() {
  constexpr int kSize = 512;
  constexpr double kShine = 0.012;
  const Colour middle = texel_for({158, 152, 144}, kGainUp, kShine);
  const Colour dark = texel_for({104, 98, 94}, kGainUp, kShine);
  const Colour light = texel_for({192, 188, 180}, kGainUp, kShine);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = column, y = row;
      const double coarse = value_noise(x / 4, y / 4, {.x = kSize / 4, .y = kSize / 4}, 201);
      const double fine = value_noise(x / 2, y / 2, {.x = kSize / 2, .y = kSize / 2}, 202);
      const double cloud = value_noise(x / 64, y / 64, {.x = kSize / 64, .y = kSize / 64}, 203);
      Colour c = mix(middle, light, 0.25 * cloud + 0.6 * smooth_step(0.70, 0.90, fine));
      c = mix(c, dark, 0.55 * smooth_step(0.66, 0.86, coarse));
      image.set(column, row, c);
    }
  }
  return image;
}

// Square tiles with joints, four by four, each its own shade; repeats.
Image tile_texture(const Colour& lit, const Colour& joint, double gain, std::uint32_t seed) {
  constexpr int kSize = 256, kTiles = 4;
  constexpr double kShine = 0.01;
  const Colour grout = texel_for(joint, gain, kShine);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = (column + 0.5) / kSize * kTiles, y = (row + 0.5) / kSize * kTiles;
      const double shade =
          10 * (hash01(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed) - 0.5);
      const Colour tile = texel_for({lit[0] + shade, lit[1] + shade, lit[2] + shade}, gain, kShine);
      const double edge =
          std::min(std::abs(x - std::floor(x + 0.5)), std::abs(y - std::floor(y + 0.5)));
      image.set(column, row, mix(grout, tile, smooth_step(0.02, 0.05, edge)));
    }
  }
  return image;
}

// Doors side by side under the worktop, seen from the front.
void add_cupboards(Surface& doors, Surface& grips) {
  constexpr double kDoor = 0.375;
  for (double y = -kSide; y < kSide - 0.01; y += kDoor) {
    const Vec3 low(kFront - 0.05, y + 0.006, 0.10), high(kFront - 0.03, y + kDoor - 0.006, 0.84);
    add_faces(doors, convex_hull(box_points(low, high, 0.003), "door"));
    const Vec3 grip(kFront - 0.03, y + kDoor / 2 - 0.05, 0.79);
    add_faces(grips, convex_hull(box_points(grip, grip + Vec3(0.012, 0.10, 0.012), 0.002), "grip"));
  }
}

}  // namespace

std::vector<OutputFile> make_kitchen_scene() {
  constexpr double kStone = 0.45, kFloorTile = 1.2, kWallTile = 0.6;
  Surface top, edge, wall, floor, doors, grips, body;
  const double deep = kFront - kBack, wide = 2 * kSide;
  top = sheet({kBack, -kSide, kTop}, {deep, 0, 0}, {0, wide, 0}, {deep / kStone, wide / kStone});
  add_faces(edge, convex_hull(box_points({kBack, -kSide, kTop - kThickness},
                                         {kFront, kSide, kTop - 0.0005}, 0.002),
                              "edge"));
  add_faces(body, convex_hull(box_points({kBack + 0.02, -kSide, 0.05},
                                         {kFront - 0.05, kSide, kTop - kThickness}, 0),
                              "body"));
  add_cupboards(doors, grips);
  wall = sheet({kWall, -2, 0}, {0, 4, 0}, {0, 0, 2.6}, {4 / kWallTile, 2.6 / kWallTile});
  floor = sheet({kWall, -2, 0}, {3.25, 0, 0}, {0, 4, 0}, {3.25 / kFloorTile, 4 / kFloorTile});
  const auto plain = [](Surface surface, const char* name, const Colour& lit) {
    return plain_part(std::move(surface), name, albedo_for(lit, kGainPlusX, 0.004), 0.9);
  };
  return {{"scenes/kitchen/visual.glb",
           glb_bytes(
               "kitchen",
               {painted_part(std::move(top), "worktop", stone_texture(), 0.5),
                plain(std::move(edge), "edge", {146, 140, 132}),
                plain(std::move(body), "body", {96, 88, 78}),
                plain(std::move(doors), "doors", {176, 160, 134}),
                plain(std::move(grips), "grips", {120, 122, 126}),
                painted_part(std::move(wall), "wall",
                             tile_texture({206, 208, 204}, {168, 168, 164}, kGainPlusX, 204), 0.6),
                painted_part(std::move(floor), "floor",
                             tile_texture({148, 104, 82}, {110, 92, 80}, kGainUp, 205), 0.9)})}};
}

}  // namespace probe::make
