// The toy rabbit, sitting, looking along +x: 5 x 3.8 x 5 cm, white, long ears with pink insides,
// dark eyes, pink nose, round tail. Its frame is not in its middle.
#include <algorithm>
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

// About the middle of the box, mm.
double fur(const Vec3& at) {
  const Vec3 p(at.x(), std::abs(at.y()), at.z());
  double d = ellipsoid_distance(p, {-6, 0, -10.5}, {16.5, 14, 14.5});
  d = smooth_union(d, ellipsoid_distance(p, {4, 0, -9}, {10.5, 10, 13.5}), 5);
  d = smooth_union(d, ellipsoid_distance(p, {-6, 11, -15}, {10.5, 7.6, 9.5}), 2);
  d = smooth_union(d, ellipsoid_distance(p, {10, 0, 4.2}, {11, 9.8, 9.6}), 3.5);
  d = smooth_union(d, ellipsoid_distance(p, {18.5, 0, 1.6}, {5, 5.6, 4.4}), 2.5);
  d = smooth_union(d, ellipsoid_distance(p, {13.5, 6.0, 0.5}, {6.0, 4.6, 4.8}), 2);
  d = smooth_union(d, capsule_distance(p, {12, 5, -20}, {20, 5.2, -22}, 3.2), 2);
  d = smooth_union(d, capsule_distance(p, {-4, 12.5, -21.8}, {12, 13, -22}, 3.2), 1.5);
  // Ears lean back and apart; flattened along x.
  const Vec3 ear((p.x() - 5) * 1.35 + 5, p.y(), p.z());
  d = smooth_union(d, capsule_distance(ear, {5.5, 4.0, 11}, {3.0, 7.2, 21.6}, 3.5), 1.5);
  d = smooth_union(d, (p - Vec3(-21.0, 0, -14)).norm() - 5.2, 1.0);
  return std::max(d, -25 - at.z());
}

Surface ball(const Vec3& centre, const Vec3& radii) {
  std::vector<Vec2> profile;
  for (int i = 0; i <= 6; ++i) {
    const SinCos a = portable_sincos_deg(90 - 30 * i);
    profile.emplace_back(std::max(0.0, a.cos), a.sin);
  }
  Surface surface = lathe(profile, 12, around_and_along);
  move_points(surface, [&](const Vec3& p) { return Vec3(centre + p.cwiseProduct(radii)); });
  return surface;
}

// A pink leaf that lies in the ear's front.
Surface inner_ear(double side) {
  std::vector<Vec3> path;
  const std::array<double, 6> radii{0.4, 1.7, 2.2, 2.2, 1.6, 0.3};
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double t = static_cast<double>(i) / 5;
    path.emplace_back(0, side * (4.5 + 2.5 * t), 13 + 9 * t);
  }
  Surface surface = tapered_rod(path, radii, 10);
  move_points(surface, [](const Vec3& p) {
    return Vec3(0.45 * p.x() + 7.2 - 0.17 * (p.z() - 13), p.y(), p.z());
  });
  return surface;
}

std::vector<Polyhedron> collision_parts(const Vec3& centre) {
  std::vector<Vec3> body, head, ears;
  const auto add = [&](std::vector<Vec3>& points, const Vec3& low, const Vec3& high) {
    for (const Vec3& p : box_points(low, high, 0)) points.push_back(centre + p);
  };
  add(body, {-16, -14, -25}, {18, 14, -25});
  add(body, {-19, -19, -20}, {10, 19, -14});
  add(body, {-25, -4, -17}, {23, 6, -19});
  add(body, {-12, -8, -1}, {17, 8, -1});
  add(head, {-1, -7, -1}, {21, 7, -1});
  add(head, {1, -10, 3}, {18, 10, 7});
  add(head, {24, -3, 0}, {25, 3, 4});
  add(head, {3, -5, 13.5}, {13, 5, 13.5});
  add(ears, {3, -6, 13.5}, {7, 6, 13.5});
  add(ears, {0, -9.5, 24}, {5, 9.5, 25});
  return {hull_mm(body, "body"), hull_mm(head, "head"), hull_mm(ears, "ears")};
}

}  // namespace

std::vector<OutputFile> make_rabbit() {
  const Vec3 centre(5, 3, 6);
  Surface white = blob(fur, {{-30, -24, -29}, {30, 24, 30}}, 2.7);
  Surface dark, pink;
  for (const double side : {-1.0, 1.0}) {
    append(dark, ball({17.0, 7.0 * side, 6.8}, {1.7, 1.5, 1.9}));
    append(pink, inner_ear(side));
  }
  append(pink, ball({23.2, 0, 3.4}, {1.4, 1.9, 1.3}));
  // Normals of the fur are the field's: the fit changes shapes by less than they would show.
  Surface* all[] = {&white, &dark, &pink};
  fit_to_box(all, box_of({50, 38, 50}, centre));
  smooth_normals(dark, 80);
  smooth_normals(pink, 80);
  return object_files("rabbit",
                      {plain_part(white, "fur", albedo_for({246, 244, 240}, kGainUp, 0.002), 1),
                       plain_part(dark, "eye", albedo_for({24, 20, 20}, kGainUp, 0.01), 0.3),
                       plain_part(pink, "pink", albedo_for({244, 150, 160}, 0.8, 0.002), 0.9)},
                      collision_parts(centre));
}

}  // namespace probe::make
