// Shapes: convex polyhedra and triangle surfaces with normals and texture coordinates, in metres in
// the model's or link's own frame. Knows nothing of files.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::make {

using Vec2 = Eigen::Vector2d;

// Faces are loops of vertex indices, counter-clockwise seen from outside.
struct Polyhedron {
  std::string name;
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces;
};

struct Triangle {
  std::array<Vec3, 3> position;
  std::array<Vec3, 3> normal;
  std::array<Vec2, 3> uv;
};

using Surface = std::vector<Triangle>;

// The convex hull of at least four points that are not in one plane, coplanar facets merged. By
// trying every plane through three points: slow and simple, for up to about a hundred points.
Polyhedron convex_hull(std::span<const Vec3> points, std::string name);

// The hull of at most 26 of the points: the farthest ones along axes, edges and corners of a cube.
Polyhedron coarse_hull(std::span<const Vec3> points, std::string name);

// Adds the polyhedron's faces as flat triangles, uv = 0.
void add_faces(Surface& surface, const Polyhedron& polyhedron);

// A sheet of quads over a grid of points, row by row; `closed` joins the last column to the first.
// Texture coordinates come in the same order; a closed sheet gives one more column of them than of
// points.
struct Grid {
  int rows = 0, columns = 0;
  bool closed = false;
  std::vector<Vec3> points;
  std::vector<Vec2> uv;
};
// Normals point along (next row - row) x (next column - column). Triangles without area are left
// out.
void add_grid(Surface& surface, const Grid& grid);

// Replaces every normal by the mean, weighted by corner angles, over the triangles that share its
// position and turn from its own by less than `max_angle_deg`.
void smooth_normals(Surface& surface, double max_angle_deg);

struct Box {
  Vec3 low, high;
};
Box bounds(const Surface& surface);
Box bounds(std::span<const Vec3> points);

// Points for hulls. `axis` is 0, 1, 2 for x, y, z; the centre's coordinate along the axis is not
// used.
std::vector<Vec3> box_points(const Vec3& low, const Vec3& high, double bevel);
struct Disc {
  int axis = 0;
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  double low = 0, high = 0;  // along the axis
  int corners = 20;
};
std::vector<Vec3> disc_points(const Disc& disc);

}  // namespace probe::make
