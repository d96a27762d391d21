// Green and yellow cube, 3 cm, half a millimetre bevelled. Sides are painted a little darker than
// the top, as the pictures of the reference show them.
#include <cmath>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"

namespace probe::make {
namespace {

struct Paint {
  Colour top, side;  // linear
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
  return object_files(
      name, {plain_part(caps, "top", paint.top, 1), plain_part(sides, "side", paint.side, 1)},
      {block});
}

}  // namespace

std::vector<OutputFile> make_green_cube() {
  return make_cube("green_cube", {.top = albedo_for({133, 165, 147}, kGainUp, 0.002),
                                  .side = albedo_for({61, 84, 67}, 0.43, 0.002)});
}

// The reference's sides, (221, 175, 91) and (213, 166, 89), shine by themselves: even white paint
// shows as no more than 177 there. These are as light as paint can be, and as warm; a cube that
// glowed would be seen in the dark.
std::vector<OutputFile> make_yellow_cube() {
  return make_cube("yellow_cube", {.top = albedo_for({252, 247, 194}, kGainUp, 0.002),
                                   .side = albedo_for({177, 158, 80}, kGainPlusX, 0.002)});
}

}  // namespace probe::make
