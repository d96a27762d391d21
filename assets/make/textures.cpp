// Pictures that texts lay on objects and backdrops (`texture "wood"`): small, seamless, and smooth
// enough for a renderer that does not average texels.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "assets/make/generators.h"
#include "runtime/base/check.h"
#include "runtime/base/trig.h"
#include "runtime/scene/image.h"

namespace probe::make {
namespace {

constexpr int kSide = 128;
constexpr double kTurn = 6.283185307179586;

// `colour(u, v)`, u and v in [0, 1), repeats with a period of 1.
template <typename ColourAt>
OutputFile texture(const std::string& name, ColourAt colour) {
  Image image(kSide, kSide);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column)
      image.set(column, row, colour((column + 0.5) / kSide, (row + 0.5) / kSide));
  }
  auto png = scene::png_bytes(kSide, kSide, image.rgb, scene::PngEffort::kSmallest);
  PROBE_CHECK(png.ok(), "a texture has the size that it says");
  return {"textures/" + name + ".png", std::move(png).value()};
}

// Noise of `cells` cells a side and of two octaves more, in [0, 1).
double cloud(double u, double v, int across, int down, std::uint32_t seed) {
  double sum = 0, weight = 0.5;
  for (int octave = 0; octave < 3; ++octave) {
    const int x = across << octave, y = down << octave;
    sum += weight * value_noise(u * x, v * y, {x, y}, seed + static_cast<std::uint32_t>(octave));
    weight /= 2;
  }
  return sum / 0.875;
}

double wave(double turns) { return portable_sincos(kTurn * (turns - std::floor(turns))).sin; }

// Boards along u, each of its own tone, with a grain.
OutputFile wood() {
  return texture("wood", [](double u, double v) {
    const double boards = 4, at = v * boards, board = std::floor(at);
    const auto number = static_cast<std::uint32_t>(board);
    const double grain = cloud(u, v, 2, 32, 11 + 5 * number);
    const double rings = 0.5 + 0.5 * wave(6 * at + 1.5 * cloud(u, v, 3, 8, 31 + number));
    const double tone = 0.75 + 0.25 * hash01(number, 0, 7);
    const Colour base = mix({150, 100, 58}, {205, 155, 100}, 0.65 * grain + 0.35 * rings);
    const double edge = smooth_step(0, 0.05, std::min(at - board, board + 1 - at));
    return mix({80, 50, 28}, {base[0] * tone, base[1] * tone, base[2] * tone}, edge);
  });
}

OutputFile marble() {
  return texture("marble", [](double u, double v) {
    const double bent = u + 2 * v + 0.9 * cloud(u, v, 4, 4, 51);
    const double vein = 1 - std::abs(wave(bent));
    const Colour stone = mix({214, 212, 208}, {240, 238, 233}, cloud(u, v, 5, 5, 61));
    return mix(stone, {120, 122, 130}, 0.75 * vein * vein * vein);
  });
}

// Squares, two a side.
OutputFile checks() {
  return texture("checks", [](double u, double v) {
    const auto side = [](double t) {
      const double near = std::abs(t < 0.5 ? t - 0.25 : t - 0.75);
      const double inside = smooth_step(0.235, 0.265, near);
      return t < 0.5 ? 1 - inside : inside;
    };
    const double a = side(u), b = side(v);
    return mix({36, 38, 44}, {232, 230, 224}, a * b + (1 - a) * (1 - b));
  });
}

OutputFile noise() {
  return texture("noise", [](double u, double v) {
    const auto channel = [&](std::uint32_t seed) { return 40 + 190 * cloud(u, v, 12, 12, seed); };
    return Colour{channel(71), channel(81), channel(91)};
  });
}

OutputFile bricks() {
  return texture("bricks", [](double u, double v) {
    const double rows = 4, columns = 2;
    const double y = v * rows, row = std::floor(y);
    double x = u * columns + (static_cast<int>(row) % 2 == 0 ? 0 : 0.5);
    if (x >= columns) x -= columns;
    const double column = std::floor(x);
    const double edge = std::min(std::min(x - column, column + 1 - x) * rows / columns,
                                 std::min(y - row, row + 1 - y));
    const double tone = 0.8 + 0.2 * hash01(static_cast<std::uint32_t>(column),
                                           static_cast<std::uint32_t>(row), 101);
    const Colour clay = mix({140, 62, 46}, {178, 92, 70}, cloud(u, v, 10, 10, 111));
    return mix({190, 184, 174}, {clay[0] * tone, clay[1] * tone, clay[2] * tone},
               smooth_step(0.04, 0.1, edge));
  });
}

OutputFile stripes() {
  return texture("stripes", [](double u, double) {
    const double band = std::abs(u - 0.5);
    return mix({232, 228, 218}, {52, 92, 140}, 1 - smooth_step(0.235, 0.265, band));
  });
}

}  // namespace

std::vector<OutputFile> make_textures() {
  return {bricks(), checks(), marble(), noise(), stripes(), wood()};
}

}  // namespace probe::make
