// The carrot: 11.5 x 3.2 x 3.8 cm, thin end at -x, green stub at +x. It lies on a level line along
// its bottom, so that it neither rolls nor rocks when it is let go; both sides are upright facets
// for parallel fingers.
#include <algorithm>
#include <array>
#include <cmath>

#include "assets/make/generators.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kPi = 3.14159265358979323846;
const Vec3 kHalf(0.0575, 0.016, 0.019);

// A cross-section of the root, millimetres.
struct Section {
  double x, half_width, bottom, top;
};

// The thin end first. Between -44 and 22 the bottom is level.
constexpr std::array<Section, 15> kSections{{{-57.5, 0.0, -13.0, -13.0},
                                             {-57.0, 2.4, -15.8, -10.2},
                                             {-55.5, 3.8, -17.1, -8.4},
                                             {-51.0, 5.8, -18.5, -5.4},
                                             {-44.0, 8.0, -19.0, -1.6},
                                             {-34.0, 10.4, -19.0, 3.6},
                                             {-22.0, 12.9, -19.0, 9.0},
                                             {-8.0, 15.0, -19.0, 14.6},
                                             {6.0, 15.9, -19.0, 17.9},
                                             {17.0, 16.0, -19.0, 19.0},
                                             {24.0, 15.2, -18.6, 18.4},
                                             {29.0, 13.2, -16.6, 16.2},
                                             {32.5, 10.2, -12.8, 12.8},
                                             {34.5, 7.0, -8.4, 9.2},
                                             {34.8, 3.0, -3.4, 4.4}}};

// Catmull-Rom through the sections; `s` counts them.
Section section_at(double s) {
  const int last = static_cast<int>(kSections.size()) - 1;
  const int i = std::min(static_cast<int>(s), last - 1);
  const double t = s - i;
  const auto knot = [&](int k) {
    return kSections[static_cast<std::size_t>(std::clamp(k, 0, last))];
  };
  const Section a = knot(i - 1), b = knot(i), c = knot(i + 1), d = knot(i + 2);
  const auto blend = [&](double p, double q, double r, double w) {
    return q + 0.5 * t * (r - p + t * (2 * p - 5 * q + 4 * r - w + t * (3 * (q - r) + w - p)));
  };
  return {blend(a.x, b.x, c.x, d.x), blend(a.half_width, b.half_width, c.half_width, d.half_width),
          std::max(-19.0, blend(a.bottom, b.bottom, c.bottom, d.bottom)),
          blend(a.top, b.top, c.top, d.top)};
}

Surface root_surface() {
  constexpr int kSteps = 3, kColumns = 30;
  Grid grid{.rows = static_cast<int>(kSections.size() - 1) * kSteps + 1,
            .columns = kColumns,
            .closed = true,
            .points = {},
            .uv = {}};
  for (int row = 0; row < grid.rows; ++row) {
    const Section s = section_at(static_cast<double>(row) / kSteps);
    const double middle = (s.bottom + s.top) / 2, half_height = (s.top - s.bottom) / 2;
    for (int column = 0; column <= kColumns; ++column) {
      const double turn = static_cast<double>(column) / kColumns;
      grid.uv.emplace_back((s.x + 57.5) / 115, turn);
      if (column == kColumns) continue;
      const SinCos a = portable_sincos(2 * kPi * turn);
      // An ellipse above; below, part of the way to a squarer curve, so that it visibly lies on its
      // belly.
      const double fourth = a.cos * a.cos * a.cos * a.cos + a.sin * a.sin * a.sin * a.sin;
      const double square = 0.08 + 0.36 * smooth_step(0.3, -0.6, a.sin);
      const double out = 1 - square + square / std::sqrt(std::sqrt(fourth));
      const double rough = value_noise(s.x / 5, turn * 9, {.x = 64, .y = 9}, 11) - 0.5;
      const double dent = 1 + 0.022 * rough;
      grid.points.emplace_back(s.x / 1000, s.half_width * a.cos * out * dent / 1000,
                               std::max(-19.0, middle + half_height * a.sin * out * dent) / 1000);
    }
  }
  Surface surface;
  add_grid(surface, grid);
  return surface;
}

// What is left of the leaves: five stalks grown together, wider at the cut.
Surface stub_surface() {
  constexpr int kColumns = 25;
  constexpr std::array<std::array<double, 2>, 10> kProfile{{{30.0, 5.2},
                                                            {35.0, 5.0},
                                                            {38.0, 4.7},
                                                            {43.0, 5.2},
                                                            {48.0, 6.1},
                                                            {53.0, 7.2},
                                                            {56.0, 7.5},
                                                            {57.2, 7.0},
                                                            {57.5, 5.8},
                                                            {57.0, 0.0}}};
  Grid grid{.rows = static_cast<int>(kProfile.size()),
            .columns = kColumns,
            .closed = true,
            .points = {},
            .uv = {}};
  for (const auto& [x, radius] : kProfile) {
    for (int column = 0; column <= kColumns; ++column) {
      const double turn = static_cast<double>(column) / kColumns;
      grid.uv.emplace_back((x - 30) / 27.5, turn);
      if (column == kColumns) continue;
      const SinCos a = portable_sincos(2 * kPi * turn);
      const double lobes = 1 - 0.06 * (1 + portable_cos(5 * 2 * kPi * turn));
      grid.points.emplace_back(x / 1000, radius * lobes * a.cos / 1000,
                               (radius * lobes * a.sin + 0.6) / 1000);
    }
  }
  Surface surface;
  add_grid(surface, grid);
  return surface;
}

// Stretches by well under a millimetre so that the box is exact.
void fit(std::array<Surface*, 2> surfaces) {
  Box box = bounds(*surfaces[0]);
  const Box other = bounds(*surfaces[1]);
  box.low = box.low.cwiseMin(other.low);
  box.high = box.high.cwiseMax(other.high);
  for (Surface* surface : surfaces) {
    for (Triangle& t : *surface) {
      for (Vec3& p : t.position) {
        p = (p - box.low).cwiseQuotient(box.high - box.low).cwiseProduct(2 * kHalf) - kHalf;
      }
    }
  }
}

Image root_texture() {
  constexpr int kWidth = 256, kHeight = 256;
  constexpr double kGain = 1.15, kShine = 0.012;
  const Colour orange = texel_for({231, 106, 34}, kGain, kShine);
  const Colour deep = texel_for({190, 70, 18}, kGain, kShine);
  const Colour pale = texel_for({246, 142, 62}, kGain, kShine);
  const Colour crown = texel_for({120, 84, 40}, kGain, kShine);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) / kWidth, v = (row + 0.5) / kHeight;
      // Mottled skin, and creases that run part of the way round: noise that is long around and
      // short along.
      const double crease = value_noise(u * 64, v * 6, {.x = 64, .y = 6}, 21);
      const double fine = value_noise(u * 90, v * 24, {.x = 90, .y = 24}, 22);
      const double cloud = value_noise(u * 9, v * 6, {.x = 9, .y = 6}, 23);
      const double spot = value_noise(u * 36, v * 22, {.x = 36, .y = 22}, 25);
      const double grain =
          hash01(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), 24);
      Colour c = mix(orange, pale, 0.5 * smooth_step(0.35, 0.9, cloud) + 0.15 * (grain - 0.5));
      c = mix(c, pale, 0.55 * smooth_step(0.68, 0.9, spot));
      c = mix(c, deep, 0.30 * smooth_step(0.6, 0.95, fine));
      c = mix(c, deep, 0.6 * smooth_step(0.80, 0.93, crease));
      c = mix(c, deep, 0.6 * smooth_step(0.08, 0.0, u));    // the root's tip is darker
      c = mix(c, crown, 0.6 * smooth_step(0.79, 0.80, u));  // and so is the crown around the stalks
      image.set(column, row, c);
    }
  }
  return image;
}

Image stub_texture() {
  constexpr int kWidth = 64, kHeight = 128;
  constexpr double kGain = 1.05, kShine = 0.01;
  const Colour green = texel_for({46, 92, 52}, kGain, kShine);
  const Colour light = texel_for({72, 120, 62}, kGain, kShine);
  const Colour cut = texel_for({122, 150, 84}, kGain, kShine);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) / kWidth, v = (row + 0.5) / kHeight;
      const double streak = value_noise(u * 3, v * 40, {.x = 4, .y = 40}, 31);
      Colour c = mix(green, light, 0.6 * smooth_step(0.4, 0.9, streak));
      c = mix(c, light, 0.7 * smooth_step(0.25, 0.05, u));
      c = mix(c, cut, 0.6 * smooth_step(0.985, 0.995, u));
      image.set(column, row, c);
    }
  }
  return image;
}

// An octagon with a flat bottom, upright sides and a flat top.
struct Octagon {
  double x, half_width, bottom, top;  // mm
  double flat_half, side_low, side_high;
};

std::vector<Polyhedron> collision_parts() {
  constexpr std::array<Octagon, 3> kBody{{{-38, 9.3, -19, 1.8, 5.0, -13.0, -4.0},
                                          {-8, 15.0, -19, 14.8, 8.0, -10.0, 6.0},
                                          {19, 16.0, -19, 19.0, 8.5, -9.0, 9.0}}};
  std::vector<Vec3> body;
  for (const Octagon& o : kBody) {
    for (const double side : {-1.0, 1.0}) {
      body.emplace_back(o.x / 1000, side * o.flat_half / 1000, o.bottom / 1000);
      body.emplace_back(o.x / 1000, side * o.half_width / 1000, o.side_low / 1000);
      body.emplace_back(o.x / 1000, side * o.half_width / 1000, o.side_high / 1000);
      body.emplace_back(o.x / 1000, side * o.flat_half * 0.9 / 1000, o.top / 1000);
    }
  }
  const auto add_box = [](std::vector<Vec3>& points, double x, double half_width, double low,
                          double high) {
    for (const double y : {-half_width, half_width}) {
      for (const double z : {low, high}) points.emplace_back(x / 1000, y / 1000, z / 1000);
    }
  };
  add_box(body, -57.5, 2.2, -16.5, -10.5);
  add_box(body, 34.5, 8.5, -11, 11.5);
  std::vector<Vec3> stub;
  for (const auto& [x, radius] : {std::pair{34.5, 4.6}, std::pair{57.5, 7.0}}) {
    for (int i = 0; i < 6; ++i) {
      const SinCos a = portable_sincos_deg(60 * i);
      stub.emplace_back(x / 1000, radius * a.cos / 1000, (radius * a.sin + 0.6) / 1000);
    }
  }
  return {convex_hull(body, "root"), convex_hull(stub, "stub")};
}

}  // namespace

std::vector<OutputFile> make_carrot() {
  Surface root = root_surface(), stub = stub_surface();
  fit({&root, &stub});
  smooth_normals(root, 75);
  smooth_normals(stub, 50);
  std::vector<Part> parts;
  parts.push_back(
      {std::move(root), {.name = "root", .texture = root_texture(), .roughness = 0.45}});
  parts.push_back({std::move(stub), {.name = "stub", .texture = stub_texture(), .roughness = 0.7}});
  return {{"objects/carrot/visual.glb", glb_bytes("carrot", parts)},
          {"objects/carrot/collision.obj", obj_bytes(collision_parts())}};
}

}  // namespace probe::make
