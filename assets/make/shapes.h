// Surfaces and collision parts from a few numbers: lathes, lofts, rods, cushions, blobs; fitted to
// the box a catalogue gives. Lengths here are millimetres until they are fitted or scaled.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "assets/make/files.h"
#include "assets/make/solid.h"

namespace probe::make {

inline constexpr double kPi = 3.14159265358979323846;

// Texture coordinates of a point: `around` and `along` run 0..1 over columns and rows.
struct SheetPlace {
  Vec3 point;
  double around = 0, along = 0;
};
using Mapping = std::function<Vec2(const SheetPlace&)>;
Vec2 around_and_along(const SheetPlace& at);
// The texture lies on the xy plane, its middle at the origin, `size` wide and high.
Mapping seen_from_above(const Vec2& size);

// A skin over loops of equally many points; `along` is the length of the way of the rows' centres
// and first points. Loops that run counter-clockwise seen from above must come from the top down.
Surface skin(const std::vector<std::vector<Vec3>>& rows, bool closed, const Mapping& uv);

// Turned about z: radius and height from the middle of the top outward and down.
Surface lathe(std::span<const Vec2> profile, int columns, const Mapping& uv);

// Counter-clockwise, beginning on the +x side: each corner an arc of `steps` pieces, each side of
// `side_steps`.
struct RoundedRectangle {
  Vec2 half = Vec2::Zero();
  double radius = 0;
  int steps = 4, side_steps = 1;
};
std::vector<Vec3> outline(const RoundedRectangle& shape, double z);
std::vector<Vec3> circle(double radius, int corners, double z, double phase_deg = 0);

// A box with rounded upright edges and rounded rims; `rings` loops towards the middle of top and
// bottom give it points to bend.
struct Cushion {
  Vec3 half = Vec3::Zero();
  double corner = 0;  // radius of the upright edges
  double rim = 0;     // radius of the edges of top and bottom
  int corner_steps = 4, side_steps = 1, rim_steps = 3, rings = 1;
};
Surface cushion(const Cushion& shape, const Mapping& uv);

// A tube of round section through the points, closed by flat ends or into a ring.
struct Rod {
  std::vector<Vec3> path;
  double radius = 1;
  int corners = 6;
  bool ring = false;
};
Surface rod(const Rod& rod);
// The same with a radius for each point, ends closed.
Surface tapered_rod(std::span<const Vec3> path, std::span<const double> radii, int corners);

// The zero level of a field that is positive outside, by surface nets on cubes of side `cell`;
// points are drawn onto the level and normals follow its gradient.
using Field = std::function<double(const Vec3&)>;
Surface blob(const Field& field, const Box& box, double cell);

// `a` joined to `b` with a fillet of about `radius`.
double smooth_union(double a, double b, double radius);
double ellipsoid_distance(const Vec3& p, const Vec3& centre, const Vec3& radii);
double capsule_distance(const Vec3& p, const Vec3& a, const Vec3& b, double radius);

// A flat rectangle, origin + s a + t b, with uv over `repeat` textures. It shows along a x b.
Surface sheet(const Vec3& origin, const Vec3& a, const Vec3& b, const Vec2& repeat);

void append(Surface& surface, const Surface& more);
void move_points(Surface& surface, const std::function<Vec3(const Vec3&)>& to);
// Turned so that z shows along +x or +y (the axis), a proper rotation.
void lay_along(Surface& surface, int axis);

// Stretches all of them together, out of millimetres, to fill the box (metres) exactly.
void fit_to_box(std::span<Surface* const> surfaces, const Box& box);
Surface in_metres(Surface millimetres);

// A box of this size, millimetres, about a point.
Box box_of(const Vec3& size, const Vec3& centre = Vec3::Zero());

// Collision parts, in millimetres.
Polyhedron hull_mm(const std::vector<Vec3>& points, std::string name);
// Segments of a ring about z: the hull of `profile` (radius, height) at each corner and the next.
void add_ring(std::vector<Polyhedron>& parts, std::span<const Vec2> profile, int segments,
              const std::string& name, const Vec3& centre = Vec3::Zero());
// `corners` points of a regular polygon whose sides, not corners, are `apothem` from the axis.
std::vector<Vec3> flat_sided(double apothem, int corners, double z);

// Eight corners in the plane x: upright sides and a level bottom and top, each about `flat` of the
// width or height long.
struct Octagon {
  double x, half_width, bottom, top;
  double flat = 0.42;
};
void add_octagon(std::vector<Vec3>& points, const Octagon& shape);

// The two files of an object.
std::vector<OutputFile> object_files(const std::string& name, const std::vector<Part>& parts,
                                     const std::vector<Polyhedron>& collision);
// The same with its light baked in: each part shows by itself what it would in a diffuse light of
// `kGainBaked`.
std::vector<OutputFile> baked_files(const std::string& name, const std::vector<Part>& lit,
                                    const std::vector<Polyhedron>& collision);
// A part of one colour.
Part plain_part(Surface surface, std::string name, const Colour& base_color, double roughness);
Part painted_part(Surface surface, std::string name, Image texture, double roughness);

}  // namespace probe::make
