// A mesh's triangles in groups of such as lie near one another, so that what no camera sees is left
// out by the group, and corners that stand in one place are looked at once. Knows nothing of light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/render/vertex_law.h"

namespace probe::render {

// The middle of the box around some places and the farthest of them from it.
Ball ball_around(std::span<const float> x, std::span<const float> y, std::span<const float> z);

struct MeshClusters {
  static constexpr std::size_t kMostTriangles = 128;  // SmallTriangles::kMost
  static constexpr std::size_t kMostPlaces = 3 * kMostTriangles;

  struct Cluster {
    std::uint32_t first_place = 0, places = 0;
    std::uint32_t first_triangle = 0, triangles = 0;
    Ball around;
  };
  std::vector<Cluster> clusters;
  std::vector<float> x, y, z;                       // of places, m, in the mesh's frame
  std::array<std::vector<std::uint16_t>, 3> place;  // of a triangle's corners, from `first_place`
  std::vector<std::uint32_t> triangle;              // which of the mesh's that is

  // `indices`: 3 a triangle, into the arrays of corners.
  static MeshClusters build(std::span<const float> x, std::span<const float> y,
                            std::span<const float> z, std::span<const std::uint32_t> indices);
};

}  // namespace probe::render
