// Groups of triangles hold what the mesh holds.
#include "runtime/render/mesh_clusters.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/runtime/render/test_scenes.h"

namespace probe::render {

TEST_CASE("clusters have every triangle once, with its corners where the mesh has them") {
  const auto mesh = test::sphere(0.3, 60);
  const scene::MeshPart& part = mesh->parts[0];
  std::array<std::vector<float>, 3> at;
  for (std::size_t i = 0; i < part.positions.size(); ++i) at[i % 3].push_back(part.positions[i]);
  const MeshClusters made = MeshClusters::build(at[0], at[1], at[2], part.indices);
  std::vector<int> times(part.indices.size() / 3);
  int misplaced = 0, outside = 0;
  for (const MeshClusters::Cluster& cluster : made.clusters) {
    CHECK(cluster.triangles <= MeshClusters::kMostTriangles);
    CHECK(cluster.places <= MeshClusters::kMostPlaces);
    for (std::size_t i = 0; i < cluster.triangles; ++i) {
      const std::size_t triangle = made.triangle[cluster.first_triangle + i];
      ++times[triangle];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t corner = part.indices[3 * triangle + k];
        const std::size_t place = cluster.first_place + made.place[k][cluster.first_triangle + i];
        misplaced += made.x[place] != at[0][corner] || made.y[place] != at[1][corner] ||
                     made.z[place] != at[2][corner];
        const Float3 p(made.x[place], made.y[place], made.z[place]);
        outside += (p - cluster.around.middle).norm() > 1.00001f * cluster.around.radius;
      }
    }
  }
  CHECK(std::ranges::all_of(times, [](int t) { return t == 1; }));
  CHECK(misplaced == 0);
  CHECK(outside == 0);
  CHECK(made.clusters.size() < 2 * times.size() / MeshClusters::kMostTriangles + 2);
}

}  // namespace probe::render
