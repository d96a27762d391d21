// The spoon: 14 x 3.5 x 2.6 cm, a light grey bowl at -x and a lime handle that is thickest near its
// end. It rests on the handle's belly and the bottom of the bowl.
#include <algorithm>
#include <array>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kGround = -13.02;
const Vec3 kBowl(-46, 0, 0);

// Inside from the middle out, over the lip, outside back to the middle.
Surface bowl_surface() {
  constexpr int kColumns = 40;
  constexpr std::array<double, 6> kShares{0.0, 0.3, 0.55, 0.77, 0.92, 1.0};
  std::vector<std::vector<Vec3>> rows;
  const auto add = [&](double share, double thickness, double grow) {
    std::vector<Vec3> loop;
    for (int c = 0; c < kColumns; ++c) {
      const SinCos a = portable_sincos_deg(360.0 * c / kColumns);
      // An egg: broad towards the handle, the tip longer and lifted.
      const double length = a.cos < 0 ? 24 : 20;
      const double x = (length + grow) * a.cos, y = (17.3 + grow) * a.sin * (1 + 0.06 * a.cos);
      const double rim = -3.5 + 5.0 * std::max(0.0, -a.cos) * std::max(0.0, -a.cos);
      const double floor = kGround + 1.2;
      const double rise = share * share * (0.7 + 0.3 * share * share);
      loop.push_back(kBowl + Vec3(share * x, share * y,
                                  std::max(kGround, floor + (rim - floor) * rise - thickness)));
    }
    rows.push_back(std::move(loop));
  };
  for (const double share : kShares) add(share, 0, -0.8);
  for (auto share = kShares.rbegin(); share != kShares.rend(); ++share) add(*share, 1.2, 0);
  return skin(rows, true, around_and_along);
}

Surface neck_surface() {
  const std::array<Vec3, 4> path{Vec3(-30, 0, -5.4), Vec3(-26, 0, -3.6), Vec3(-20, 0, -2.6),
                                 Vec3(-12, 0, -2.4)};
  const std::array<double, 4> radii{2.2, 3.4, 3.4, 3.6};
  return tapered_rod(path, radii, 12);
}

Surface handle_surface() {
  constexpr std::array<std::array<double, 2>, 11> kSections{{{-17, 4.6},
                                                             {-14, 5.6},
                                                             {-4, 7.4},
                                                             {8, 9.6},
                                                             {20, 11.4},
                                                             {32, 12.4},
                                                             {44, 12.6},
                                                             {54, 11.8},
                                                             {62, 9.4},
                                                             {67, 6.2},
                                                             {70, 2.6}}};
  std::vector<Vec3> path;
  std::vector<double> radii;
  for (const auto& [x, radius] : kSections) {
    path.emplace_back(x, 0, x < 8 ? -2.4 - (x + 17) * 0.04 : std::max(-3.42, kGround + radius));
    radii.push_back(radius);
  }
  for (std::size_t i = 8; i < path.size(); ++i) path[i].z() = -0.4;
  Surface surface = tapered_rod(path, radii, 28);
  move_points(surface, [](const Vec3& p) { return Vec3(p.x(), p.y(), std::max(kGround, p.z())); });
  return surface;
}

Image handle_texture() {
  constexpr int kWidth = 128, kHeight = 128;
  const Colour lime = texel_for({226, 246, 130}, kGainUp, 0.01);
  const Colour pale = texel_for({243, 254, 190}, kGainUp, 0.01);
  const Colour deep = texel_for({176, 214, 62}, kGainUp, 0.01);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) / kWidth, v = (row + 0.5) / kHeight;
      const double streak = value_noise(u * 24, v * 3, {.x = 24, .y = 8}, 81);
      Colour c = mix(lime, pale, 0.8 * smooth_step(0.4, 0.9, streak));
      c = mix(c, deep, 0.5 * smooth_step(0.6, 0.1, streak) + 0.5 * smooth_step(0.88, 0.97, v));
      image.set(column, row, mix(c, deep, 0.8 * smooth_step(0.08, 0.03, v)));
    }
  }
  return image;
}

std::vector<Polyhedron> collision_parts() {
  std::vector<Vec3> handle, bowl;
  add_octagon(handle, {.x = -26, .half_width = 3.6, .bottom = -7, .top = 0.8});
  add_octagon(handle, {.x = 14, .half_width = 10.2, .bottom = kGround, .top = 8});
  add_octagon(handle, {.x = 46, .half_width = 12.4, .bottom = kGround, .top = -kGround});
  add_octagon(handle, {.x = 70, .half_width = 3.0, .bottom = -4, .top = 3});
  for (int c = 0; c < 12; ++c) {
    const SinCos a = portable_sincos_deg(30 * c);
    const double length = a.cos < 0 ? 24 : 20;
    bowl.push_back(kBowl +
                   Vec3(length * a.cos, 17.3 * a.sin, a.cos < 0 ? -3.5 + 5 * a.cos * a.cos : -3.5));
    if (c % 2 == 0) bowl.push_back(kBowl + Vec3(9 * a.cos, 6.5 * a.sin, kGround));
  }
  return {hull_mm(handle, "handle"), hull_mm(bowl, "bowl")};
}

}  // namespace

std::vector<OutputFile> make_spoon() {
  Surface bowl = bowl_surface(), handle = handle_surface();
  append(bowl, neck_surface());
  Surface* both[] = {&bowl, &handle};
  fit_to_box(both, box_of({140, 34.6, 26.042}));
  smooth_normals(bowl, 50);
  smooth_normals(handle, 60);
  return object_files("spoon",
                      {plain_part(bowl, "metal", albedo_for({216, 216, 218}, kGainUp, 0.02), 0.4),
                       painted_part(handle, "handle", handle_texture(), 0.5)},
                      collision_parts());
}

}  // namespace probe::make
