// Hits that follow each other on one triangle, as they do wherever a surface is large in the
// picture: what they share is read once, the rest is loops over arrays. Every number is made by the
// same operations in the same order as for a hit alone (tile_tracer.cpp), so the bits are the same.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/render/mesh_geometry.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

// From here on a run is worth a call.
inline constexpr std::size_t kLongRun = 8;

// Unit directions of a run's rays in world, an array a coordinate.
struct RunRays {
  const float *x, *y, *z;
};

// The distance of a hit that no ray found and that refine_run() is to take as it computes it.
inline constexpr float kUnknownDistance = -1;

// t, u and v of `count` hits, recomputed; `origin` is the rays' in the mesh frame.
void refine_run(const TriangleData& triangle, const Instance& instance, const float* origin,
                const RunRays& d, std::size_t count, float* t, float* u, float* v);

// Where a run's attributes go.
struct RunNormals {
  float *nx, *ny, *nz;  // world, not yet of unit length
  float* side;          // -1 where the face turns away from the viewer
  float *vx, *vy, *vz;  // to the viewer
};
void turn_run(const TriangleData& triangle, const Instance& instance, const RunRays& d,
              std::size_t count, const float* u, const float* v, const RunNormals& out);

// Where a run's texels are: four indices and two weights a hit, as scene::texels_at gives them.
struct RunTexels {
  std::uint32_t *upper_left, *upper_right, *lower_left, *lower_right;
  float *across, *down;
};
void place_run(const TriangleData& triangle, const scene::Texture& texture, std::size_t count,
               const float* u, const float* v, const RunTexels& out);

}  // namespace probe::render
