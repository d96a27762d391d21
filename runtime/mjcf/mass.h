// Masses, centres of mass and inertias as MuJoCo's compiler gives them (3.2: user_objects.cc,
// user_mesh.cc).
#pragma once

#include <span>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/mjcf/model.h"
#include "runtime/scene/mesh.h"

namespace probe::mjcf {

struct MassProperties {
  double mass = 0;              // kg
  Vec3 center = Vec3::Zero();   // m
  Mat3 inertia = Mat3::Zero();  // kg m2, about the centre, axes of the frame of `center`
};

// Seen from the frame in which theirs stands at `pose`.
MassProperties moved(const MassProperties& mass, const Pose& pose);
// One rigid thing of two, in one frame.
MassProperties joined(const MassProperties& a, const MassProperties& b);

// The solid within a mesh, for a density of 1: the sum of the pyramids from the mean of its faces
// to each of them, all counted as positive unless `exact` (MuJoCo's `legacy` way, which is more
// than the volume where a mesh is not star-shaped).
MassProperties solid_of(const scene::Mesh& mesh, bool exact);

// The axes of an inertia as columns, the largest moment first, with the signs that MuJoCo's
// compiler arrives at: Jacobi's turns from no turn on, ended below 1e-12 kg m2, then quarter turns
// into order.
Mat3 inertia_frame(const Mat3& inertia);

// Whether the geom adds to its body's mass: by its group, unless `inertial` counts.
bool has_mass(const Model& model, const Body& body, const Geom& geom);

// Of a body, in its frame: its `inertial`, or volume times density of its geoms (or their `mass`),
// where they overlap counted twice. `solids` by index of Model::meshes; those of meshes with mass
// are read. Fails (kAsset, where = the geom) on a geom or mesh whose mass lies on its surface.
Result<MassProperties> mass_of(const Model& model, const Body& body,
                               std::span<const MassProperties> solids);

}  // namespace probe::mjcf
