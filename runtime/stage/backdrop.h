// Where the table of a backdrop is. A backdrop is a mesh that is only seen, in world coordinates;
// if objects rest on a part of it, that part must lie where the surface of the physics is, or
// pictures would show them afloat or not at all.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/plan/format.h"
#include "runtime/scene/mesh.h"

namespace probe::stage {

// The mesh placed in world, without a turn.
struct SeenMesh {
  const scene::Mesh* mesh = nullptr;  // may be null
  Vec3 position = Vec3::Zero();
};

// The height (m) at which `backdrop` is level under `area` (x min, y min, x max, y max; m): what a
// plumb line meets first, at 13 x 13 places; where that is `fixture`, the place does not count.
// Of the levels on which at least a tenth of the places agree within 5 mm, the one nearest to
// `surface_z`, where the things lie, within half a metre: an area may be wider than its table, and
// then most of it is over something else. Without `surface_z` the one of half the places that
// count.
std::optional<double> table_height(const SeenMesh& backdrop, const SeenMesh& fixture,
                                   const std::array<double, 4>& area,
                                   std::optional<double> surface_z = std::nullopt);

// How far (m) the backdrop has to be raised for its table to lie at `surface_z`. 0 where it has no
// table, one within 2 mm (drawn a little lower so that nothing flickers), or one farther than half
// a metre away, which is the floor of a room.
double backdrop_lift(std::optional<double> table_height, double surface_z);
// The same of a scene: one that stands is raised as far as the surface was.
double backdrop_lift(const plan::SceneRecord& scene, std::optional<double> table_height);

// A texture on a part of a backdrop.
struct Cover {
  plan::CoverOf of = plan::CoverOf::kSurface;
  const scene::Texture* picture = nullptr;
  double side = 0;  // m that one picture covers
};

// `backdrop` with textures on its surface (level, at the table's height), its walls (upright, above
// that) and its floor (level, the lowest of it: well below the surface, or that itself). Where it
// has no table the surface is what lies at `surface_z`. Fails (kRender), naming the part, where a
// texture covers nothing.
Result<scene::Mesh> covered_backdrop(const scene::Mesh& backdrop, const SeenMesh& fixture,
                                     const std::array<double, 4>& area, double surface_z,
                                     std::span<const Cover> covers);

}  // namespace probe::stage
