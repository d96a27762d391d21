// The juice carton, lying: 6.8 x 2.6 x 2.6 cm, a gable at +x with a ridge along z, a cap on one
// slope. Each of the four sides shows half an orange and the word JUICE, read from the gable down.
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/lettering.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kHalf = 13, kBase = -34, kShoulder = 15, kRidge = 30, kEnd = 34;
constexpr double kFin = 1.0;  // half thickness of the ridge
constexpr double kGain = 0.85, kShine = 0.004;

Surface flat(const std::vector<Vec3>& corners, const std::vector<Vec2>& uv) {
  Surface surface;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    Triangle t{.position = {corners[0], corners[i - 1], corners[i]},
               .normal = {},
               .uv = {uv[0], uv[i - 1], uv[i]}};
    t.normal.fill(
        (t.position[1] - t.position[0]).cross(t.position[2] - t.position[0]).normalized());
    surface.push_back(t);
  }
  return surface;
}

// The four sides: the texture's right is -x, from the gable to the base.
Surface sides() {
  Surface all;
  for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(0, 0, -1)}) {
    const Vec3 right(-1, 0, 0), up = normal.cross(right);
    const auto at = [&](double x, double side) {
      return Vec3(normal * kHalf + up * side * kHalf + Vec3(x, 0, 0));
    };
    append(all, flat({at(kShoulder, -1), at(kBase, -1), at(kBase, 1), at(kShoulder, 1)},
                     {{0, 1}, {1, 1}, {1, 0}, {0, 0}}));
  }
  return all;
}

Surface gable() {
  Surface all;
  const std::vector<Vec2> none(4, Vec2::Zero());
  for (const double y : {-1.0, 1.0}) {
    std::vector<Vec3> slope{{kShoulder, y * kHalf, -kHalf},
                            {kShoulder, y * kHalf, kHalf},
                            {kRidge, y * kFin, kHalf},
                            {kRidge, y * kFin, -kHalf}};
    std::vector<Vec3> fin{{kRidge, y * kFin, -kHalf},
                          {kRidge, y * kFin, kHalf},
                          {kEnd, y * kFin, kHalf},
                          {kEnd, y * kFin, -kHalf}};
    if (y < 0) {
      std::swap(slope[1], slope[3]);
      std::swap(fin[1], fin[3]);
    }
    append(all, flat(slope, none));
    append(all, flat(fin, none));
  }
  for (const double z : {-1.0, 1.0}) {
    // Folded in a little between the slopes, as real ones are.
    const Vec3 dent(kShoulder + 7, 0, z * (kHalf - 4));
    const std::array<Vec3, 4> rim{Vec3(kShoulder, -kHalf, z * kHalf),
                                  Vec3(kRidge, -kFin, z * kHalf), Vec3(kRidge, kFin, z * kHalf),
                                  Vec3(kShoulder, kHalf, z * kHalf)};
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<Vec3> face{rim[i], rim[(i + 1) % 4], dent};
      if (z > 0) std::swap(face[0], face[1]);
      append(all, flat(face, none));
    }
    append(all, flat({{kRidge, -z * kFin, z * kHalf},
                      {kEnd, -z * kFin, z * kHalf},
                      {kEnd, z * kFin, z * kHalf},
                      {kRidge, z * kFin, z * kHalf}},
                     none));
  }
  append(
      all,
      flat({{kEnd, -kFin, -kHalf}, {kEnd, kFin, -kHalf}, {kEnd, kFin, kHalf}, {kEnd, -kFin, kHalf}},
           none));
  append(all, flat({{kBase, -kHalf, -kHalf},
                    {kBase, -kHalf, kHalf},
                    {kBase, kHalf, kHalf},
                    {kBase, kHalf, -kHalf}},
                   none));
  return all;
}

// On the slope towards +y, square to it.
Surface cap() {
  const std::vector<Vec2> profile{{0, 2.6}, {3.6, 2.6}, {4.0, 2.2}, {4.0, -0.5}};
  Surface surface = lathe(profile, 20, around_and_along);
  const Vec3 along = Vec3(kRidge - kShoulder, kFin - kHalf, 0).normalized();
  const Vec3 out = Vec3(0, 0, 1).cross(along);
  move_points(surface, [&](const Vec3& p) -> Vec3 {
    return Vec3((kShoulder + kRidge) / 2 - 1.5, (kHalf + kFin) / 2 + 1.2, 0) + p.x() * along +
           p.y() * Vec3(0, 0, 1) + p.z() * out;
  });
  return surface;
}

Image side_texture() {
  constexpr int kWidth = 256, kHeight = 128;
  const Colour white = texel_for({244, 242, 236}, kGain, kShine);
  const Colour orange = texel_for({252, 138, 20}, kGain, kShine);
  const Colour flesh = texel_for({253, 172, 60}, kGain, kShine);
  const Colour deep = texel_for({222, 92, 6}, kGain, kShine);
  const Colour green = texel_for({40, 130, 52}, kGain, kShine);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      // mm from the gable's shoulder, and from the middle line.
      const Vec2 p((column + 0.5) / kWidth * 49, (0.5 - (row + 0.5) / kHeight) * 26);
      Colour c = mix(white, orange, smooth_step(3.2, 3.0, p.x()) + smooth_step(45.8, 46.0, p.x()));
      // Half an orange: peel, pith, segments.
      const Vec2 q = p - Vec2(13.5, 0);
      const double radius = q.norm();
      c = mix(c, orange, smooth_step(9.3, 8.9, radius));
      c = mix(c, white, smooth_step(8.2, 7.9, radius));
      double segment = 0;
      for (int i = 0; i < 4; ++i) {
        const SinCos a = portable_sincos_deg(45 * i + 22.5);
        segment =
            std::max(segment, smooth_step(0.65, 0.35, std::abs(q.x() * a.sin - q.y() * a.cos)));
      }
      c = mix(c, flesh, smooth_step(7.3, 7.0, radius) * (1 - segment));
      // A leaf beside it.
      const Vec2 leaf((q.x() - 6.5 + q.y() - 9) / 1.414, (q.y() - 9 - q.x() + 6.5) / 1.414);
      c = mix(c, green, smooth_step(1.1, 0.9, Vec2(leaf.x() / 3.4, leaf.y() / 1.5).norm()));
      constexpr double kTall = 7.2;
      const Vec2 origin(24.2, -kTall / 2 - 0.5);
      const Vec2 at((p.x() - origin.x()) / (kTall * 0.68), (p.y() - origin.y()) / kTall);
      c = mix(c, deep, smooth_step(0.19, 0.13, stroke_distance("JUICE", at)));
      image.set(column, row, c);
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_orange_juice() {
  Surface side = sides(), top = gable(), lid = cap();
  Surface* all[] = {&side, &top, &lid};
  fit_to_box(all, box_of({68, 26, 26}));
  smooth_normals(lid, 40);
  std::vector<Vec3> hull = box_points({kBase, -kHalf, -kHalf}, {kShoulder, kHalf, kHalf}, 0);
  for (const Vec3& p : box_points({kRidge, -kFin, -kHalf}, {kEnd, kFin, kHalf}, 0))
    hull.push_back(p);
  return object_files("orange_juice",
                      {painted_part(side, "side", side_texture(), 0.7),
                       plain_part(top, "gable", albedo_for({250, 140, 26}, kGain, kShine), 0.7),
                       plain_part(lid, "cap", albedo_for({240, 240, 236}, kGain, kShine), 0.5)},
                      {hull_mm(hull, "carton")});
}

}  // namespace probe::make
