// Collision shapes from points and meshes: convex hulls with merged polygonal faces, few vertices
// and mass properties. Made once per asset. Knows nothing of worlds; Qhull stays inside hull.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/scene/collision_shape.h"

namespace probe::scene {

struct HullOptions {
  int max_vertices = 32;     // 64 for round objects; more is refused
  bool single_hull = false;  // one hull of all components: what links of a robot use
};

// One convex part per component (its points, metres, model frame). Components that are flat or
// smaller than 0.2 mm are dropped. Fails (kAsset, where = name) when a number is not finite
// or nothing solid is left.
Result<CollisionShape> make_collision_shape(const std::vector<std::vector<Vec3>>& components,
                                            const std::string& name,
                                            const HullOptions& options = {});

// The same from triangles: components are sets of triangles that share vertex indices.
struct TriangleSoup {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;  // 3 a triangle
};
Result<CollisionShape> make_mesh_shape(const TriangleSoup& mesh, const std::string& name,
                                       const HullOptions& options = {});

// Reads positions and faces of a Wavefront file and multiplies them by `scale`. Fails naming file
// and line, also for a coordinate more than a kilometre out or more than a million triangles.
Result<TriangleSoup> load_obj_triangles(const std::string& path, const Vec3& scale);
Result<CollisionShape> load_collision_obj(const std::string& path, const Vec3& scale,
                                          const HullOptions& options = {});

// Primitives about the origin; lengths in metres, all positive. Balls and capsules are exact and
// roll smoothly; a cylinder is a prism of 32 sides with its corners on the circle (0.5 % of the
// radius inside it between them).
CollisionShape make_box_shape(const Vec3& half);
CollisionShape make_sphere_shape(double radius);
CollisionShape make_capsule_shape(double radius, double half_length);   // along z, without the caps
CollisionShape make_cylinder_shape(double radius, double half_length);  // along z

// Several shapes of equal density in one frame, each at its place: all their parts.
struct PlacedShape {
  CollisionShape shape;
  Pose pose;  // of its model frame
};
CollisionShape join_shapes(std::vector<PlacedShape> shapes);

// The same shape about another centre of mass: with the density mass / volume it has this inertia
// about it, kg m2 in the axes of the model frame.
CollisionShape shape_weighing(const CollisionShape& shape, double mass, const Vec3& center,
                              const Mat3& inertia);

// One part: closed, convex, at most 64 vertices, volume and moments about the origin of the points'
// frame.
struct HullPart {
  ConvexPart part;  // not yet moved to a centre of mass
  double volume = 0;
  Vec3 moment = Vec3::Zero();  // integral of x
  Mat3 second = Mat3::Zero();  // integral of x x^T
  double reduction_error = 0;  // m, farthest given point outside the part
};
Result<HullPart> make_hull(std::span<const Vec3> points, const std::string& name, int max_vertices);

// Puts parts about their common centre of mass.
CollisionShape assemble_shape(std::vector<HullPart> parts);

}  // namespace probe::scene
