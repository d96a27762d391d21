// Plate, small plate and ramekin: lathes whose collision shape is a base that alone meets the table
// and a ring of convex segments on it.
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

// A mapping's texture for glazed ware: `step` is where the inner ring that says "plate" lies.
struct Glaze {
  double size;  // mm that the texture covers
  double step_low, step_high, edge;
};

Image glaze_texture(const Glaze& glaze) {
  constexpr int kSize = 256;
  const Colour middle = texel_for({230, 247, 167}, kGainUp, 0.006);
  const Colour ring = texel_for({216, 234, 153}, kGainUp, 0.006);
  const Colour edge = texel_for({222, 239, 158}, kGainUp, 0.006);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = ((column + 0.5) / kSize - 0.5) * glaze.size,
                   y = (0.5 - (row + 0.5) / kSize) * glaze.size;
      const double radius = std::sqrt(x * x + y * y);
      const double on_step = smooth_step(glaze.step_low, glaze.step_low + 1.5, radius) *
                             smooth_step(glaze.step_high, glaze.step_high - 2, radius);
      const double cloud = value_noise(x / 9 + 100, y / 9 + 100, {}, 41);
      Colour c = mix(middle, ring, 0.85 * on_step + 0.10 * (cloud - 0.5));
      c = mix(c, edge, smooth_step(glaze.edge, glaze.edge + 1, radius));
      image.set(column, row, c);
    }
  }
  return image;
}

// 72 columns: a multiple of 4, so that the box is met exactly.
Surface glazed(std::span<const Vec2> profile, double size) {
  Surface surface = in_metres(lathe(profile, 72, seen_from_above({size, size})));
  smooth_normals(surface, 40);
  return surface;
}

std::vector<Polyhedron> base_and_rim(double base_radius, Vec2 base_heights,
                                     std::span<const Vec2> rim) {
  constexpr int kSegments = 12;
  std::vector<Vec3> base;
  for (const Vec3& p : circle(base_radius, kSegments, 0)) {
    base.emplace_back(p.x(), p.y(), base_heights.x());
    base.emplace_back(p.x(), p.y(), base_heights.y());
  }
  std::vector<Polyhedron> parts{hull_mm(base, "base")};
  add_ring(parts, rim, kSegments, "rim");
  return parts;
}

// White, darker inside where less light comes, and in the grooves between the ribs.
Image ramekin_texture(int ribs) {
  constexpr int kWidth = 512, kHeight = 128;
  const Colour white = texel_for({243, 241, 236}, kGainUp, 0.006);
  const Colour shade = texel_for({205, 203, 200}, kGainUp, 0.006);
  const Colour groove = texel_for({196, 196, 196}, kGainUp, 0.006);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) / kWidth, v = (row + 0.5) / kHeight;
      const double phase = u * ribs - std::floor(u * ribs);
      const double valley = smooth_step(0.30, 0.0, phase) + smooth_step(0.70, 1.0, phase);
      Colour c = mix(white, shade, smooth_step(0.16, 0.24, v) * smooth_step(0.44, 0.33, v));
      const double outside = smooth_step(0.50, 0.51, v) * smooth_step(0.78, 0.77, v);
      image.set(column, row, mix(c, groove, 0.9 * valley * outside));
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_plate() {
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
  std::vector<Vec2> profile;
  for (const auto& [radius, height] : kProfile) profile.emplace_back(radius, height);
  const std::vector<Vec2> rim{{37, -0.5}, {48, -0.5}, {55, 1.8}, {55, 3.0}, {53.5, 3.0}, {41, 1.4}};
  const Glaze glaze{.size = 112, .step_low = 34.0, .step_high = 43.0, .edge = 53.8};
  return object_files(
      "plate", {painted_part(glazed(profile, glaze.size), "glaze", glaze_texture(glaze), 0.8)},
      base_and_rim(48, {-3.0, -0.5}, rim));
}

// A saucer: small, deep, with a broad round rim.
std::vector<OutputFile> make_small_plate() {
  const std::vector<Vec2> profile{{0, -3.6},   {12.5, -3.6}, {14.2, -2.8}, {15.4, -0.8},
                                  {17.0, 3.4}, {18.3, 5.2},  {20.2, 6.0},  {22.6, 5.8},
                                  {24.3, 4.8}, {25.0, 3.2},  {24.8, 2.0},  {23.4, 1.0},
                                  {20.0, 0.2}, {17.4, -4.6}, {15.8, -6.0}, {0, -6.0}};
  const std::vector<Vec2> rim{{13, -3.6}, {17.4, -3.6}, {25, 1.8},
                              {25, 4.0},  {22.6, 6.0},  {18.5, 6.0}};
  const Glaze glaze{.size = 51, .step_low = 12.3, .step_high = 18.5, .edge = 23.8};
  return object_files(
      "small_plate",
      {painted_part(glazed(profile, glaze.size), "glaze", glaze_texture(glaze), 0.8)},
      base_and_rim(15.8, {-6.0, -3.6}, rim));
}

std::vector<OutputFile> make_ramekin() {
  constexpr int kColumns = 104, kRibs = 26;
  constexpr double kDepth = 1.6;
  const Vec3 centre(0.625, -0.625, 1.25);
  const std::vector<Vec2> profile{{0, -20.5},  {41, -20.5}, {44.5, -17.5}, {47.8, 22}, {48.4, 26.4},
                                  {50, 27.5},  {54, 27.5},  {55.6, 26.2},  {55.6, 21}, {54.2, 20},
                                  {52.6, -21}, {51, -27.5}, {0, -27.5}};
  std::vector<std::vector<Vec3>> rows;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    std::vector<Vec3> loop = circle(profile[i].x(), kColumns, profile[i].y());
    if (i == 9 || i == 10) {
      for (int c = 0; c < kColumns; ++c) {
        // Rounded ribs: a cosine of four columns each.
        const double dent = (c % (kColumns / kRibs)) == 0 ? kDepth : 0;
        Vec3& p = loop[static_cast<std::size_t>(c)];
        p.head<2>() *= (profile[i].x() - dent) / profile[i].x();
      }
    }
    rows.push_back(std::move(loop));
  }
  Surface surface = skin(rows, true, around_and_along);
  Surface* all[] = {&surface};
  fit_to_box(all, box_of({111.25, 111.25, 55}, centre));
  smooth_normals(surface, 48);
  std::vector<Vec3> base;
  for (const auto& [radius, z] : {std::pair{51.0, -27.5}, std::pair{53.0, -20.5}}) {
    for (const Vec3& p : circle(radius, 12, z)) base.push_back(centre + p);
  }
  std::vector<Polyhedron> parts{hull_mm(base, "base")};
  const std::vector<Vec2> wall{{44, -20.5}, {53, -20.5}, {55.625, 22}, {55.625, 27.5}, {48, 27.5}};
  add_ring(parts, wall, 12, "wall", centre);
  return object_files("ramekin", {painted_part(surface, "porcelain", ramekin_texture(kRibs), 0.5)},
                      parts);
}

}  // namespace probe::make
