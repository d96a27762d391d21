// Drink cans, 3.3 cm across and 6.15 cm tall, along local y, lid at +y. The labels are invented:
// COLA on red with a white wave, FIZZ on blue in a white ring; ALOE on green, of which there is
// only one with its light baked in.
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/lettering.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr int kLabelWidth = 512, kLabelHeight = 256;
constexpr double kGirth = 103.7, kLabelTall = 60.0;  // mm of the texture's two sides
constexpr double kGain = 0.62, kShine = 0.01;        // between an upright wall's and a top's

constexpr double kFace = kGirth / 3;

// A place on the label: mm right of and above the middle of one of its three equal faces. One of
// them looks at the bench camera when the can stands, one looks up when it lies.
Vec2 on_face(int column, int row) {
  const double x = (column + 0.5) / kLabelWidth * 3 + 0.5;
  return {(x - std::floor(x) - 0.5) * kFace, (0.5 - (row + 0.5) / kLabelHeight) * kLabelTall};
}

// 1 in the ink of a word centred at `middle`, `size` mm wide and tall.
double ink(std::string_view word, const Vec2& at, const Vec2& middle, const Vec2& size) {
  constexpr double kBold = 0.125, kSoft = 0.02;  // of the height
  const Vec2 from = at - middle + size / 2;
  const Vec2 place(from.x() / size.x() * text_width(word), from.y() / size.y());
  return smooth_step(kBold + kSoft, kBold - kSoft, stroke_distance(word, place));
}

// A word over a white wave, on `lit` with ends in `deep_lit`.
Image wave_label(std::string_view word, const Colour& lit, const Colour& deep_lit) {
  const Colour ground = texel_for(lit, kGain, kShine);
  const Colour deep = texel_for(deep_lit, kGain, kShine);
  const Colour white = texel_for({238, 236, 232}, kGain, kShine);
  Image image(kLabelWidth, kLabelHeight);
  for (int row = 0; row < kLabelHeight; ++row) {
    for (int column = 0; column < kLabelWidth; ++column) {
      const Vec2 p = on_face(column, row);
      const double wave = -13 + 4.5 * portable_sin(2 * kPi * (p.x() + 4) / kFace);
      const double band = smooth_step(2.6, 2.1, std::abs(p.y() - wave));
      const double thin = smooth_step(0.9, 0.5, std::abs(p.y() - wave + 4.6));
      Colour c = mix(ground, deep, smooth_step(24.5, 28, std::abs(p.y())));
      c = mix(c, white, std::max(band, thin));
      c = mix(c, white, ink(word, p, {0, 5}, {26.5, 12}));
      image.set(column, row, c);
    }
  }
  return image;
}

Image cola_label() { return wave_label("COLA", {206, 22, 28}, {150, 8, 16}); }
Image aloe_label() { return wave_label("ALOE", {64, 150, 76}, {28, 104, 48}); }

Image fizz_label() {
  const Colour blue = texel_for({18, 62, 148}, kGain, kShine);
  const Colour deep = texel_for({8, 34, 92}, kGain, kShine);
  const Colour white = texel_for({236, 238, 242}, kGain, kShine);
  const Colour sky = texel_for({96, 176, 226}, kGain, kShine);
  Image image(kLabelWidth, kLabelHeight);
  for (int row = 0; row < kLabelHeight; ++row) {
    for (int column = 0; column < kLabelWidth; ++column) {
      const Vec2 p = on_face(column, row);
      const double radius = (p - Vec2(0, 1)).norm();
      const double ring = smooth_step(1.7, 1.2, std::abs(radius - 15));
      Colour c = mix(blue, deep, smooth_step(24.5, 28, std::abs(p.y())));
      c = mix(c, white, ring);
      // Bubbles rise inside the ring.
      for (int i = 0; i < 7; ++i) {
        const auto k = static_cast<std::uint32_t>(i);
        const Vec2 bubble(-7 + 14 * hash01(k, 1, 111), -10 + 5 * hash01(k, 2, 111));
        const double size = 0.9 + 1.1 * hash01(k, 3, 111);
        c = mix(c, sky, smooth_step(0.7, 0.4, std::abs((p - bubble).norm() - size)));
      }
      c = mix(c, white, ink("FIZZ", p, {0, 2}, {19, 10}));
      image.set(column, row, c);
    }
  }
  return image;
}

// The lid: bare metal, the oval of the mouth scored into it.
Image lid_texture() {
  constexpr int kSize = 96;
  const Colour metal = texel_for({198, 201, 206}, kGainUp, 0.03);
  const Colour dark = texel_for({118, 121, 128}, kGainUp, 0.03);
  const Colour light = texel_for({228, 230, 234}, kGainUp, 0.03);
  Image image(kSize, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const Vec2 p(((column + 0.5) / kSize - 0.5) * 28, (0.5 - (row + 0.5) / kSize) * 28);
      const double radius = p.norm();
      const double spun = value_noise(radius * 2.5, 3, {}, 112);
      Colour c = mix(metal, spun > 0.5 ? light : dark, 0.3 * std::abs(spun - 0.5));
      c = mix(c, dark, 0.8 * smooth_step(0.7, 0.3, std::abs(radius - 11.3)));
      const double mouth = Vec2(p.x() / 4.2, (p.y() - 5.6) / 3.6).norm();
      c = mix(c, dark, 0.9 * smooth_step(0.16, 0.08, std::abs(mouth - 1)));
      image.set(column, row, c);
    }
  }
  return image;
}

std::vector<OutputFile> make_can(const std::string& name, Image label, bool is_baked = false) {
  const std::vector<Vec2> lid_profile{{0, 28.6},    {10.6, 28.6},  {11.4, 27.9}, {12.0, 28.2},
                                      {12.4, 30.4}, {12.9, 30.75}, {13.4, 30.4}, {13.2, 29.2}};
  const std::vector<Vec2> body_profile{{13.2, 29.2},  {14.8, 27.4},  {16.1, 25.2}, {16.5, 23.6},
                                       {16.5, -26.2}, {16.1, -27.6}, {15.2, -28.8}};
  const std::vector<Vec2> foot_profile{{15.2, -28.8}, {12.9, -30.5}, {12.2, -30.75},
                                       {11.4, -30.4}, {8, -28.9},    {0, -28.0}};
  constexpr int kColumns = 48;
  Surface lid = lathe(lid_profile, kColumns, seen_from_above({28, 28}));
  Surface tab = cushion({.half = {2.7, 4.6, 0.35}, .corner = 2.4, .rim = 0.3, .rim_steps = 1},
                        seen_from_above({28, 28}));
  move_points(tab, [](const Vec3& p) { return Vec3(p.x(), p.y() - 2.4, p.z() + 29.4); });
  append(lid, tab);
  Surface body = lathe(body_profile, kColumns, around_and_along);
  Surface foot = lathe(foot_profile, kColumns, around_and_along);
  Surface* all[] = {&lid, &body, &foot};
  for (Surface* surface : all) lay_along(*surface, 1);
  fit_to_box(all, box_of({33, 61.5, 33}));
  for (Surface* surface : all) smooth_normals(*surface, 40);
  // Twelve flat sides, so that a pair of them faces the fingers; flat square ends to stand on.
  std::vector<Vec3> hull;
  struct Ring {
    double apothem, along;
    int corners;
  };
  for (const Ring& ring :
       {Ring{9.1, 30.75, 4}, {16.5, 23.6, 12}, {16.5, -26.5, 12}, {9.1, -30.75, 4}}) {
    for (const Vec3& p : flat_sided(ring.apothem, ring.corners, ring.along)) {
      hull.emplace_back(p.y(), p.z(), p.x());
    }
  }
  const Colour metal = albedo_for({186, 189, 195}, 0.62, 0.02);
  return (is_baked ? baked_files : object_files)(
      name,
      {painted_part(lid, "lid", lid_texture(), 0.35),
       painted_part(body, "label", std::move(label), 0.4), plain_part(foot, "foot", metal, 0.35)},
      {hull_mm(hull, "can")});
}

}  // namespace

std::vector<OutputFile> make_coke_can() { return make_can("coke_can", cola_label()); }
std::vector<OutputFile> make_pepsi_can() { return make_can("pepsi_can", fizz_label()); }
std::vector<OutputFile> make_baked_cans() {
  std::vector<OutputFile> all;
  for (auto& files : {make_can("baked_coke_can", cola_label(), true),
                      make_can("baked_pepsi_can", fizz_label(), true),
                      make_can("baked_7up_can", aloe_label(), true)}) {
    all.insert(all.end(), files.begin(), files.end());
  }
  return all;
}

}  // namespace probe::make
