#include "runtime/render/mesh_clusters.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace probe::render {
namespace {

// Halves what is too large across its longest side, until all of it is small enough. `out` gets the
// ends of the groups in `order`.
void split(std::span<std::uint32_t> order, const std::vector<Float3>& middles,
           std::vector<std::size_t>& out) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, order.size()}};
  while (!open.empty()) {
    const auto [first, count] = open.back();
    open.pop_back();
    if (count <= MeshClusters::kMostTriangles) {
      out.push_back(first + count);
      continue;
    }
    const auto group = order.subspan(first, count);
    Float3 low = middles[group[0]], high = low;
    for (const std::uint32_t i : group) {
      low = low.cwiseMin(middles[i]);
      high = high.cwiseMax(middles[i]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    // Whole groups on the left, so that few are nearly empty.
    const std::size_t groups =
        (count + MeshClusters::kMostTriangles - 1) / MeshClusters::kMostTriangles;
    const std::size_t left = groups / 2 * MeshClusters::kMostTriangles;
    std::nth_element(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(left), group.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       const float at_a = middles[a][axis], at_b = middles[b][axis];
                       return at_a != at_b ? at_a < at_b : a < b;
                     });
    open.emplace_back(first + left, count - left);
    open.emplace_back(first, left);  // next
  }
}

}  // namespace

Ball ball_around(std::span<const float> x, std::span<const float> y, std::span<const float> z) {
  Ball ball;
  if (x.empty()) return ball;
  const auto [left, right] = std::ranges::minmax(x);
  const auto [front, back] = std::ranges::minmax(y);
  const auto [low, high] = std::ranges::minmax(z);
  ball.middle = Float3(left + right, front + back, low + high) / 2;
  for (std::size_t i = 0; i < x.size(); ++i)
    ball.radius = std::max(ball.radius, (Float3(x[i], y[i], z[i]) - ball.middle).norm());
  return ball;
}

MeshClusters MeshClusters::build(std::span<const float> x, std::span<const float> y,
                                 std::span<const float> z, std::span<const std::uint32_t> indices) {
  MeshClusters out;
  const std::size_t triangles = indices.size() / 3;
  std::vector<Float3> middles(triangles, Float3::Zero());
  for (std::size_t t = 0; t < triangles; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = indices[3 * t + k];
      middles[t] += Float3(x[i], y[i], z[i]);
    }
  }
  std::vector<std::uint32_t> order(triangles);
  std::iota(order.begin(), order.end(), 0u);
  std::vector<std::size_t> ends;
  if (triangles > 0) split(order, middles, ends);
  std::size_t first = 0;
  for (const std::size_t end : ends) {
    Cluster cluster;
    cluster.first_place = static_cast<std::uint32_t>(out.x.size());
    cluster.first_triangle = static_cast<std::uint32_t>(first);
    cluster.triangles = static_cast<std::uint32_t>(end - first);
    // As the mesh has them: neighbours there share corners in the picture's buffers, too.
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(first),
              order.begin() + static_cast<std::ptrdiff_t>(end));
    std::vector<std::uint32_t> corners;
    for (std::size_t t = first; t < end; ++t) {
      for (std::size_t k = 0; k < 3; ++k) corners.push_back(indices[3 * std::size_t{order[t]} + k]);
    }
    const auto at = [&](std::uint32_t i) { return std::tuple(x[i], y[i], z[i]); };
    std::ranges::sort(corners, {}, at);
    const auto is_same = [&](std::uint32_t a, std::uint32_t b) { return at(a) == at(b); };
    corners.erase(std::unique(corners.begin(), corners.end(), is_same), corners.end());
    for (const std::uint32_t i : corners) {
      out.x.push_back(x[i]);
      out.y.push_back(y[i]);
      out.z.push_back(z[i]);
    }
    cluster.places = static_cast<std::uint32_t>(corners.size());
    for (std::size_t t = first; t < end; ++t) {
      out.triangle.push_back(order[t]);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = indices[3 * std::size_t{order[t]} + k];
        const auto found = std::ranges::lower_bound(corners, at(corner), {}, at);
        out.place[k].push_back(static_cast<std::uint16_t>(found - corners.begin()));
      }
    }
    const auto own = [&](const std::vector<float>& values) {
      return std::span(values).subspan(cluster.first_place, cluster.places);
    };
    cluster.around = ball_around(own(out.x), own(out.y), own(out.z));
    out.clusters.push_back(cluster);
    first = end;
  }
  return out;
}

}  // namespace probe::render
