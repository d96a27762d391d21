// The toy sink: pale blue plate with a large and a small basin, yellow dish rack in the small one,
// grey tap. A fixture with convex parts, its frame as it is placed in the scene, and the scene's
// backdrop in world coordinates: bench, pale table, tiled wall, navy cabinet. Paint is chosen for
// the sink's dim light: ambient 0.3 and a sun of 0.3 from above.
#include <algorithm>
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kUp = 0.395, kWall = 0.30;  // diffuse gains of the sink's light
constexpr double kShine = 0.002;
constexpr double kPlate = 97;  // top of the plate, mm in the fixture's frame

struct Basin {
  Vec2 centre, half;
  double floor;
};
constexpr double kDivider = -33;  // y between the basins
const Basin kLarge{{26, 79}, {82, 94}, 40}, kSmall{{19, -99}, {79, 51}, 47};

std::vector<Vec3> shifted(std::vector<Vec3> loop, const Vec2& by) {
  for (Vec3& p : loop) p.head<2>() += by;
  return loop;
}

// From the plate over the lip down to the middle of the floor.
Surface basin_surface(const Basin& basin) {
  const double depth = kPlate - basin.floor;
  const std::array<std::array<double, 2>, 10> rows{{{0, 0},
                                                    {1.2, 0.6},
                                                    {2.4, 3},
                                                    {5.5, depth * 0.5},
                                                    {8, depth - 14},
                                                    {10.5, depth - 6},
                                                    {15, depth - 1.6},
                                                    {21, depth},
                                                    {34, depth},
                                                    {0.98 * basin.half.minCoeff(), depth}}};
  std::vector<std::vector<Vec3>> loops;
  for (const auto& [inset, down] : rows) {
    const Vec2 half = basin.half - Vec2::Constant(inset);
    loops.push_back(shifted(outline({.half = half,
                                     .radius = std::max(1.0, std::min(20.0, half.minCoeff())),
                                     .steps = 5,
                                     .side_steps = 2},
                                    kPlate - down),
                            basin.centre));
  }
  loops.emplace_back(loops.back().size(), Vec3(basin.centre.x(), basin.centre.y(), basin.floor));
  // Loops that shrink inwards face down; seen from above they must run the other way.
  for (auto& loop : loops) std::reverse(loop.begin(), loop.end());
  return skin(loops, true, [&](const SheetPlace& at) {
    return Vec2(at.around, (kPlate - at.point.z()) / (depth * 1.02));
  });
}

// The flat plate round a basin, between y low and y high.
Surface cell_surface(const Basin& basin, double low, double high) {
  const RoundedRectangle hole{.half = basin.half, .radius = 20, .steps = 5, .side_steps = 2};
  const RoundedRectangle edge{
      .half = {120, (high - low) / 2}, .radius = 1e-3, .steps = 5, .side_steps = 2};
  return skin({shifted(outline(hole, kPlate), basin.centre),
               shifted(outline(edge, kPlate), {0.5, (low + high) / 2})},
              true, around_and_along);
}

// The plate's border: falls off to the edge, turns under and meets the dark base.
Surface border_surface() {
  constexpr double kInnerY = 182;
  std::vector<std::vector<Vec3>> loops;
  const auto add = [&](double grow, double radius, double z) {
    loops.push_back(shifted(
        outline(
            {.half = {120 + grow, kInnerY + grow}, .radius = radius, .steps = 5, .side_steps = 2},
            z),
        {0.5, -4}));
  };
  add(0, 1e-3, kPlate);
  add(10, 14, kPlate - 1.5);
  add(15, 20, kPlate - 5);
  add(17.5, 24, kPlate - 10);
  add(17.5, 24, kPlate - 22);
  add(14, 20, kPlate - 25);
  add(-2, 12, kPlate - 25);
  return skin(loops, true, around_and_along);
}

Surface disc(const Vec3& centre, double inner, double outer) {
  std::vector<std::vector<Vec3>> rows{circle(inner, 28, 0), circle(outer, 28, 0)};
  for (auto& row : rows) {
    for (Vec3& p : row) p += centre;
  }
  return skin(rows, true, around_and_along);
}

// Wall colour down to the fillet, floor colour below; darker where they meet.
Image basin_texture() {
  constexpr int kWidth = 8, kHeight = 128;
  const Colour lip = texel_for({143, 152, 152}, kUp, kShine);
  const Colour wall = texel_for({112, 136, 141}, kWall, kShine);
  const Colour corner = texel_for({116, 134, 136}, kUp, kShine);
  const Colour floor = texel_for({136, 150, 151}, kUp, kShine);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    const double v = (row + 0.5) / kHeight;
    Colour c = mix(lip, wall, smooth_step(0.01, 0.12, v));
    c = mix(c, corner, smooth_step(0.70, 0.90, v));
    c = mix(c, floor, smooth_step(0.93, 0.975, v));
    for (int column = 0; column < kWidth; ++column) image.set(column, row, c);
  }
  return image;
}

Surface rack_surface() {
  const double x = kSmall.centre.x(), y = kSmall.centre.y();
  Rod rim{.path = {}, .radius = 5.5, .corners = 10, .ring = true};
  for (const Vec3& p : outline({.half = {86, 57}, .radius = 22, .steps = 5, .side_steps = 2}, 0)) {
    rim.path.push_back(p);
  }
  Surface all = rod(rim);
  move_points(all, [&](const Vec3& p) { return Vec3(p.x() + x, p.y() + y, 0.6 * p.z() + 100); });
  // Wires hang from the rim on one long side, run over the floor and up the other.
  for (int i = 0; i < 10; ++i) {
    const double at = x - 66 + 14.6 * i;
    append(all, rod({.path = {{at, y - 56, 101},
                              {at, y - 47, 96},
                              {at, y - 41, 62},
                              {at, y - 35, 50},
                              {at, y + 35, 50},
                              {at, y + 41, 62},
                              {at, y + 47, 96},
                              {at, y + 56, 101}},
                     .radius = 1.9}));
  }
  for (const double side : {-26.0, 0.0, 26.0}) {
    append(all, rod({.path = {{x - 84, y + side, 101},
                              {x - 72, y + side, 92},
                              {x - 66, y + side, 58},
                              {x - 60, y + side, 50},
                              {x + 60, y + side, 50},
                              {x + 68, y + side, 60},
                              {x + 72, y + side, 92},
                              {x + 84, y + side, 101}},
                     .radius = 1.9}));
  }
  // The solid panel at the far end and a row of plate holders along the middle.
  add_faces(all, convex_hull(box_points({x - 78, y - 44, 74}, {x - 74, y + 44, 101}, 0), "panel"));
  for (int i = 0; i < 5; ++i) {
    const double at = x - 44 + 14.6 * i;
    append(all, rod({.path = {{at, y + 20, 50},
                              {at, y + 22, 78},
                              {at, y + 26, 86},
                              {at, y + 30, 78},
                              {at, y + 32, 50}},
                     .radius = 1.7}));
  }
  return all;
}

Surface tap_surface() {
  Surface all =
      cushion({.half = {19, 40, 7}, .corner = 14, .rim = 4, .corner_steps = 4}, around_and_along);
  move_points(all, [](const Vec3& p) { return Vec3(p.x() - 90, p.y() + 122, p.z() + 103); });
  const std::vector<Vec3> column{{-92, 108, 108}, {-92, 108, 142}, {-92, 108, 143},
                                 {-92, 108, 200}, {-90, 108, 212}, {-80, 108, 221},
                                 {-62, 108, 223}, {-40, 108, 218}};
  append(all, tapered_rod(column, std::vector<double>{15, 15, 11.5, 10.5, 10.5, 10, 9.5, 9}, 20));
  append(all, tapered_rod(std::vector<Vec3>{{-92, 118, 132}, {-92, 136, 132}, {-92, 140, 132}},
                          std::vector<double>{9, 9, 6}, 14));
  append(all, tapered_rod(std::vector<Vec3>{{-92, 134, 134}, {-95, 139, 160}, {-98, 143, 178}},
                          std::vector<double>{3.5, 3, 4}, 10));
  return all;
}

struct Block {
  std::string name;
  Vec3 low, high;
};

std::vector<Polyhedron> collision_parts() {
  std::vector<Polyhedron> parts;
  const std::vector<Block> blocks{
      {"large_floor", {-52, -20, -1}, {99, 171, 40}},
      {"small_floor", {-60, -151, -1}, {99, -47, 47}},
      {"divider", {-60, -47, -1}, {99, -20, 97}},
      {"front", {99, -183, -1}, {118, 175, 97}},
      {"back_of_large", {-118, -20, -1}, {-52, 175, 99}},
      {"back_of_small", {-118, -183, -1}, {-60, -20, 99}},
      {"left", {-60, -183, -1}, {99, -151, 97}},
      {"right", {-52, 171, -1}, {99, 175, 96}},
  };
  for (const Block& block : blocks) {
    parts.push_back(hull_mm(box_points(block.low, block.high, 0), block.name));
  }
  // The border that slopes off round the plate.
  const auto lip = [&](const std::string& name, const std::array<Vec2, 2>& inner,
                       const std::array<Vec2, 2>& outer) {
    std::vector<Vec3> points;
    for (const Vec2& p : inner) {
      points.emplace_back(p.x(), p.y(), 72);
      points.emplace_back(p.x(), p.y(), 96.5);
    }
    for (const Vec2& p : outer) {
      points.emplace_back(p.x(), p.y(), 75);
      points.emplace_back(p.x(), p.y(), 88);
    }
    parts.push_back(hull_mm(points, name));
  };
  lip("front_lip", {{{118, -183}, {118, 175}}}, {{{138, -203}, {138, 195}}});
  lip("back_lip", {{{-118, -183}, {-118, 175}}}, {{{-137, -203}, {-137, 195}}});
  lip("left_lip", {{{-118, -183}, {118, -183}}}, {{{-137, -203}, {138, -203}}});
  lip("right_lip", {{{-118, 175}, {118, 175}}}, {{{-137, 195}, {138, 195}}});
  // The walls' feet lean towards the floor at the back.
  for (const auto& [name, x, y0, y1, z] : {std::tuple{"large_foot", -52.0, -20.0, 171.0, 40.0},
                                           std::tuple{"small_foot", -60.0, -151.0, -47.0, 47.0}}) {
    std::vector<Vec3> points;
    for (const double y : {y0, y1}) {
      points.emplace_back(x, y, z);
      points.emplace_back(x, y, z + 16);
      points.emplace_back(x + 14, y, z);
    }
    parts.push_back(hull_mm(points, name));
  }
  return parts;
}

Image bench_texture() {
  constexpr int kSize = 256;
  const Colour middle = texel_for({134, 97, 54}, kUp, kShine);
  const Colour dark = texel_for({112, 76, 38}, kUp, kShine);
  const Colour light = texel_for({148, 112, 68}, kUp, kShine);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = column, y = row;
      const double grain = value_noise(x / 3, y / 60, {.x = 86, .y = 4}, 141);
      const double fine = value_noise(x / 1.2, y / 20, {.x = 214, .y = 12}, 142);
      const Colour c = mix(middle, grain > 0.5 ? light : dark, 1.2 * std::abs(grain - 0.5));
      image.set(column, row, mix(c, dark, 0.4 * smooth_step(0.7, 0.95, fine)));
    }
  }
  return image;
}

Image tile_texture() {
  constexpr int kSize = 128;
  const Colour tile = texel_for({93, 80, 68}, kWall, kShine);
  const Colour joint = texel_for({62, 54, 48}, kWall, kShine);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const bool edge = column < 2 || row < 2;
      const double cloud = value_noise(column / 16.0, row / 16.0, {.x = 8, .y = 8}, 143);
      image.set(column, row, edge ? joint : mix(tile, joint, 0.2 * cloud));
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_sink_fixture() {
  Surface basins = basin_surface(kLarge);
  append(basins, basin_surface(kSmall));
  Surface plate = cell_surface(kSmall, -186, kDivider);
  append(plate, cell_surface(kLarge, kDivider, 178));
  append(plate, border_surface());
  // Four round ridges at the back of the small basin.
  for (int i = 0; i < 4; ++i) {
    const double y = -142 + 24.0 * i;
    append(plate,
           tapered_rod(std::vector<Vec3>{{-118, y, 98}, {-112, y, 99}, {-82, y, 99}, {-76, y, 98}},
                       std::vector<double>{8, 15, 15, 8}, 16));
  }
  const RoundedRectangle foot{.half = {117.5, 178}, .radius = 14, .steps = 3};
  Surface base =
      skin({shifted(outline(foot, 72.5), {0.5, -4}), shifted(outline(foot, -10), {0.5, -4})}, true,
           around_and_along);
  Surface drains, rings, rack = rack_surface(), tap = tap_surface();
  const Vec3 large(kLarge.centre.x(), kLarge.centre.y(), kLarge.floor);
  const Vec3 small(kSmall.centre.x() - 15, kSmall.centre.y(), kSmall.floor);
  append(drains, disc(large + Vec3(0, 0, 0.7), 0, 8));
  append(drains, disc(small + Vec3(0, 0, 0.7), 0, 8));
  append(rings, disc(large + Vec3(0, 0, 0.4), 14, 15.5));
  append(rings, disc(large + Vec3(0, 0, 0.4), 23.5, 25));
  Surface* all[] = {&basins, &plate, &base, &drains, &rings, &rack, &tap};
  for (Surface* surface : all) {
    *surface = in_metres(*surface);
    smooth_normals(*surface, 45);
  }
  const std::vector<Part> parts{
      painted_part(basins, "basins", basin_texture(), 0.9),
      plain_part(plate, "plate", albedo_for({143, 152, 152}, kUp, kShine), 0.9),
      plain_part(base, "base", albedo_for({26, 28, 36}, kWall, kShine), 0.9),
      plain_part(drains, "drains", albedo_for({10, 14, 20}, kUp, 0), 1),
      plain_part(rings, "rings", albedo_for({118, 132, 134}, kUp, kShine), 1),
      plain_part(rack, "rack", albedo_for({164, 144, 86}, kUp, kShine), 0.9),
      plain_part(tap, "tap", albedo_for({104, 97, 92}, kUp, kShine), 0.8)};
  return {{"fixtures/sink/visual.glb", glb_bytes("sink", parts)},
          {"fixtures/sink/collision.obj", obj_bytes(collision_parts())}};
}

std::vector<OutputFile> make_sink_scene() {
  constexpr double kBench = 0.869;
  const Surface bench = sheet({-0.33, -0.42, kBench}, {0.62, 0, 0}, {0, 1.3, 0}, {2.5, 3});
  const Surface table = sheet({-1.6, -0.42, kBench - 0.002}, {1.27, 0, 0}, {0, 2.2, 0}, {1, 1});
  const Surface ground = sheet({0.28, -0.42, 0.70}, {0.7, 0, 0}, {0, 1.6, 0}, {1, 1});
  // Turned to +y and +x.
  Surface tiles = sheet({1.0, -0.42, 0.45}, {-2.6, 0, 0}, {0, 0, 1.5}, {13, 7.5});
  append(tiles, sheet({-1.6, -0.42, 0.45}, {0, 2.2, 0}, {0, 0, 1.5}, {11, 7.5}));
  Surface cabinet, grille;
  // An open-fronted navy case behind the large basin and a post behind the rack.
  for (const auto& [low, high] :
       {std::pair{Vec3(-0.345, 0.070, 0.972), Vec3(-0.335, 0.205, 1.5)},
        std::pair{Vec3(-0.335, 0.070, 0.972), Vec3(-0.275, 0.080, 1.5)},
        std::pair{Vec3(-0.335, 0.195, 0.972), Vec3(-0.275, 0.205, 1.5)},
        std::pair{Vec3(-0.335, 0.080, 0.972), Vec3(-0.275, 0.195, 0.982)},
        std::pair{Vec3(-0.345, -0.090, 0.972), Vec3(-0.315, -0.062, 1.5)}}) {
    add_faces(cabinet, convex_hull(box_points(low, high, 0), "board"));
  }
  add_faces(grille,
            convex_hull(box_points({-0.50, -0.34, kBench}, {-0.31, -0.10, 0.885}, 0), "mat"));
  return {{"scenes/sink/visual.glb",
           glb_bytes("sink_scene",
                     {painted_part(bench, "bench", bench_texture(), 0.8),
                      plain_part(table, "table", albedo_for({155, 139, 131}, kUp, kShine), 1),
                      plain_part(ground, "ground", albedo_for({150, 140, 134}, kUp, kShine), 1),
                      painted_part(tiles, "tiles", tile_texture(), 0.9),
                      plain_part(cabinet, "cabinet", albedo_for({10, 26, 58}, kWall, 0.001), 0.9),
                      plain_part(grille, "mat", albedo_for({50, 44, 40}, kUp, kShine), 1)})}};
}

}  // namespace probe::make
