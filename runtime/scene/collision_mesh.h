// Collision shapes from a mesh file of any format that is read: one convex part a connected
// component.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/scene/hull.h"
#include "runtime/scene/mesh.h"
#include "runtime/scene/mesh_import.h"

namespace probe::scene {

// More separate pieces make a slow world and mostly mean a picture mesh: they are refused.
inline constexpr std::size_t kMaxCollisionParts = 256;

// The triangles of a file. In an OBJ whose name has "collision" in it a component is what shares
// vertex indices, as convex decompositions are stored; everywhere else vertices are split at seams,
// so those at one place are one. Fails as load_obj_triangles and load_mesh do.
Result<TriangleSoup> load_triangles(const std::string& path, const Vec3& scale,
                                    const MeshLimits& limits = {});

// All triangles of a mesh, vertices of equal coordinates made one.
TriangleSoup weld_triangles(const Mesh& mesh);
TriangleSoup weld_triangles(const TriangleSoup& soup);

// One convex part a component. Fails also when there are more than kMaxCollisionParts.
Result<CollisionShape> load_collision_mesh(const std::string& path, const Vec3& scale,
                                           const MeshLimits& limits = {});

}  // namespace probe::scene
