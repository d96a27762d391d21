// The basket: the plane on the floor of the sink's dish rack that things are put on, 13 x 8 x 0.2
// cm. Photos hide it; in our own pictures it is the rack's yellow mat.
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

Image mat_texture() {
  constexpr int kWidth = 256, kHeight = 160;
  constexpr double kGain = 0.395;  // a face turned up in the sink's light
  const Colour yellow = texel_for({160, 140, 84}, kGain, 0.002);
  const Colour gap = texel_for({112, 100, 66}, kGain, 0.002);
  Image image(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double x = (column + 0.5) / kWidth * 130 - 65, y = (row + 0.5) / kHeight * 80 - 40;
      // A grid of slots with round ribs between them.
      const auto slot = [](double at, double pitch) {
        const double off = std::abs(at / pitch - std::floor(at / pitch + 0.5)) * pitch;
        return smooth_step(2.0, 2.8, off);
      };
      const double inside = smooth_step(62, 60, std::abs(x)) * smooth_step(37, 35, std::abs(y));
      image.set(column, row, mix(yellow, gap, slot(x, 13) * slot(y, 11) * inside));
    }
  }
  return image;
}

}  // namespace

std::vector<OutputFile> make_basket() {
  Surface surface = cushion({.half = {65, 40, 1}, .corner = 3, .rim = 0.3, .rim_steps = 1},
                            seen_from_above({130, 80}));
  Surface* all[] = {&surface};
  fit_to_box(all, box_of({130, 80, 2}));
  smooth_normals(surface, 30);
  return object_files("basket", {painted_part(surface, "mat", mat_texture(), 1)},
                      {hull_mm(box_points({-65, -40, -1}, {65, 40, 1}, 0), "mat")});
}

}  // namespace probe::make
