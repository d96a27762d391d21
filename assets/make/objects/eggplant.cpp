// The eggplant: 7.8 x 3.7 x 3.8 cm, thick end at +x, neck bent upwards, a green star of a calyx and
// a stub of stalk at -x. It lies on a level facet under its belly.
#include <algorithm>
#include <array>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

// The axis' height over the table side of the box, by x: the neck rises.
double bend(double x) {
  const double past = std::max(0.0, -4 - x);
  return 0.0072 * past * past;
}

Vec3 bent(const Vec3& p) { return {p.x(), p.y(), std::max(-18.6, p.z() + bend(p.x()))}; }

Surface skin_surface() {
  const std::vector<Vec2> profile{{0, 39},      {4.2, 38.4}, {8, 36.8},   {11.6, 34}, {14.6, 30},
                                  {16.8, 25},   {18.2, 19},  {18.7, 12},  {18.4, 5},  {17.3, -2},
                                  {15.6, -9},   {13.6, -16}, {11.6, -22}, {9.6, -27}, {6.8, -31},
                                  {3.0, -33.0}, {0, -33.4}};
  Surface surface = lathe(profile, 40, around_and_along);
  lay_along(surface, 0);
  move_points(surface, bent);
  return surface;
}

// A cap whose edge has five long teeth, lifted a little off the skin.
Surface calyx_surface() {
  constexpr int kColumns = 30;
  std::vector<std::vector<Vec3>> rows(6);
  for (int c = 0; c < kColumns; ++c) {
    const SinCos a = portable_sincos_deg(360.0 * c / kColumns);
    const double tooth = 0.5 + 0.5 * portable_sincos_deg(5 * 360.0 * c / kColumns).cos;
    const double edge = -25.5 + 8.5 * tooth;
    const auto add = [&](std::size_t row, double x, double radius) {
      rows[row].emplace_back(radius * a.cos, radius * a.sin, x);
    };
    const double edge_radius = 10.3 + 2.6 * tooth;
    add(0, edge, edge_radius - 0.8);
    add(1, edge, edge_radius + 0.5);
    add(2, (edge - 28.5) / 2, (edge_radius + 9.9) / 2 + 0.6);
    add(3, -29.5, 9.2);
    add(4, -33.2, 4.6);
    add(5, -34.4, 2.0);
  }
  Surface surface = skin(rows, true, around_and_along);
  lay_along(surface, 0);
  move_points(surface, bent);
  const std::array<Vec3, 4> path{Vec3(-32, 0, bend(-32)), Vec3(-35, 0, bend(-35) + 0.2),
                                 Vec3(-38, 0, bend(-38) + 1.2), Vec3(-39.2, 0, bend(-39.2) + 2)};
  const std::array<double, 4> radii{3.2, 2.3, 2.2, 2.9};
  append(surface, tapered_rod(path, radii, 10));
  return surface;
}

Image skin_texture() {
  constexpr int kWidth = 128, kHeight = 128;
  // Colours of the sink's light: ambient 0.3 and a sun of 0.3 from above.
  constexpr double kGain = 0.395;
  const Colour purple = texel_for({60, 11, 110}, kGain, 0.002);
  const Colour light = texel_for({86, 30, 138}, kGain, 0.002);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) / kWidth, v = (row + 0.5) / kHeight;
      const double streak = value_noise(u * 40, v * 4, {.x = 40, .y = 8}, 71);
      Colour c = mix(purple, light, 0.25 * smooth_step(0.5, 0.95, streak));
      image.set(column, row, mix(c, light, 0.8 * smooth_step(0.72, 0.86, v)));
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_eggplant() {
  Surface body = skin_surface(), calyx = calyx_surface();
  Surface* both[] = {&body, &calyx};
  fit_to_box(both, box_of({78.3, 37.4, 38}));
  smooth_normals(body, 60);
  smooth_normals(calyx, 50);
  std::vector<Vec3> hull;
  add_octagon(hull, {.x = -27, .half_width = 10.5, .bottom = -6, .top = 15});
  add_octagon(hull, {.x = -6, .half_width = 16.6, .bottom = -19, .top = 17.5});
  add_octagon(hull, {.x = 15, .half_width = 18.7, .bottom = -19, .top = 19});
  for (const double y : {-1.0, 1.0}) {
    hull.emplace_back(39.15, 5 * y, -5);
    hull.emplace_back(39.15, 5 * y, 6);
    hull.emplace_back(-39.15, 2.5 * y, 9);
    hull.emplace_back(-39.15, 2.5 * y, 14);
  }
  return object_files("eggplant",
                      {painted_part(body, "skin", skin_texture(), 0.35),
                       plain_part(calyx, "calyx", albedo_for({34, 82, 30}, 0.395, 0.002), 0.7)},
                      {hull_mm(hull, "fruit")});
}

}  // namespace probe::make
