// Green and yellow cube, 3 cm, half a millimetre bevelled. Sides are painted a little darker than
// the top, as the pictures of the reference show them.
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

struct Paint {
  Colour top, side;  // linear
  Colour side_glow{0, 0, 0};
};

std::vector<OutputFile> make_cube(const std::string& name, const Paint& paint) {
  constexpr double kHalf = 0.015, kBevel = 0.0005;
  const Vec3 half = Vec3::Constant(kHalf);
  const Polyhedron block = convex_hull(box_points(-half, half, kBevel), "block");
  Surface faces, caps, sides;
  add_faces(faces, block);
  for (const Triangle& t : faces) {
    (std::abs(t.normal[0].z()) > 0.9 ? caps : sides).push_back(t);
  }
  std::vector<Part> parts{plain_part(caps, "top", paint.top, 1),
                          plain_part(sides, "side", paint.side, 1)};
  parts[1].material.emission = paint.side_glow;
  return object_files(name, parts, {block});
}

}  // namespace

std::vector<OutputFile> make_green_cube() {
  return make_cube("green_cube", {.top = albedo_for({133, 165, 147}, kGainUp, 0.002),
                                  .side = albedo_for({61, 84, 67}, 0.43, 0.002)});
}

// Its lit sides are brighter than white paint could be under the table's light: two equations, one
// for each of the sides the camera sees, give albedo and a warm glow.
std::vector<OutputFile> make_yellow_cube() {
  const Colour at_x = albedo_for({221, 175, 91}, 1, 0), at_y = albedo_for({213, 166, 89}, 1, 0);
  Paint paint{.top = albedo_for({252, 247, 194}, kGainUp, 0.002), .side = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    paint.side[i] = (at_x[i] - at_y[i]) / (kGainPlusX - kGainPlusY);
    paint.side_glow[i] = at_x[i] - kGainPlusX * paint.side[i];
  }
  return make_cube("yellow_cube", paint);
}

}  // namespace probe::make
