#include "runtime/render/shadow_marks.h"

#include <algorithm>
#include <cmath>

namespace probe::render {
namespace {

constexpr int kCells = 512;          // a side
constexpr float kCellSize = 0.008f;  // m
constexpr float kRoom = 0.001f;      // m, for the rays' offset from the surface and for rounding

// Places outside the grid count as its edge, so that nothing is lost there.
std::uint16_t cell_of(float place) {
  const float cell = place / kCellSize + 0.5f * kCells;
  return static_cast<std::uint16_t>(std::clamp(cell, 0.0f, static_cast<float>(kCells - 1)));
}

float along(const std::array<float, 3>& axis, const std::array<float, 3>& origin, float x, float y,
            float z) {
  return axis[0] * (x - origin[0]) + axis[1] * (y - origin[1]) + axis[2] * (z - origin[2]);
}

}  // namespace

void ShadowReceivers::prepare(const LightTable& lights, const std::array<float, 3>& centre,
                              std::size_t blocks) {
  for (const LightRay& sun : lights.suns) {
    if (!sun.shadow) continue;
    const Vec3 towards(sun.x, sun.y, sun.z);
    const Vec3 a = towards.unitOrthogonal(), b = towards.cross(a).normalized();
    Sun entry;
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      entry.plane.a[at] = static_cast<float>(a[k]);
      entry.plane.b[at] = static_cast<float>(b[k]);
    }
    entry.plane.origin = centre;
    entry.blocks.resize(blocks);
    suns.push_back(std::move(entry));
  }
}

void ShadowReceivers::add(std::size_t block, const std::array<float, 3>& p) {
  for (Sun& sun : suns) {
    const float x = along(sun.plane.a, sun.plane.origin, p[0], p[1], p[2]);
    const float y = along(sun.plane.b, sun.plane.origin, p[0], p[1], p[2]);
    const CellRectangle cell{cell_of(x - kRoom), cell_of(y - kRoom), cell_of(x + kRoom),
                             cell_of(y + kRoom)};
    CellRectangle& all = sun.blocks[block];
    if (all.x1 < all.x0) {
      all = cell;
      continue;
    }
    all.x0 = std::min(all.x0, cell.x0);
    all.y0 = std::min(all.y0, cell.y0);
    all.x1 = std::max(all.x1, cell.x1);
    all.y1 = std::max(all.y1, cell.y1);
  }
}

void ShadowMarks::mark(const ShadowReceivers& receivers, const std::vector<Instance>& instances,
                       BlockMarks& marks) {
  for (const ShadowReceivers::Sun& sun : receivers.suns) {
    draw(sun.plane, instances);
    for (int by = 0; by < marks.blocks_y(); ++by) {
      for (int bx = 0; bx < marks.blocks_x(); ++bx) {
        if (marks.marked(bx, by)) continue;
        const CellRectangle& r =
            sun.blocks[static_cast<std::size_t>(by) * static_cast<std::size_t>(marks.blocks_x()) +
                       static_cast<std::size_t>(bx)];
        bool reached = false;
        for (std::size_t y = r.y0; y <= r.y1 && !reached && r.x0 <= r.x1; ++y) {
          const std::uint8_t* row = cells_.data() + y * kCells;
          reached = std::find(row + r.x0, row + r.x1 + 1, 1) != row + r.x1 + 1;
        }
        if (reached) marks.mark_block(bx, by);
      }
    }
  }
}

void ShadowMarks::draw(const LightPlane& plane, const std::vector<Instance>& instances) {
  cells_.assign(static_cast<std::size_t>(kCells) * kCells, 0);
  for (const Instance& instance : instances) {
    const float* m = instance.rotation;
    for (const MeshGeometry::Part& part : instance.geometry->parts) {
      const std::size_t count = part.x.size();
      x_.resize(std::max(x_.size(), count));
      y_.resize(std::max(y_.size(), count));
      for (std::size_t v = 0; v < count; ++v) {
        const float px = part.x[v], py = part.y[v], pz = part.z[v];
        const float wx = m[0] * px + m[1] * py + m[2] * pz + instance.translation[0];
        const float wy = m[3] * px + m[4] * py + m[5] * pz + instance.translation[1];
        const float wz = m[6] * px + m[7] * py + m[8] * pz + instance.translation[2];
        x_[v] = along(plane.a, plane.origin, wx, wy, wz);
        y_[v] = along(plane.b, plane.origin, wx, wy, wz);
      }
      for (std::size_t i = 0; i < part.indices.size(); i += 3) {
        const std::size_t a = part.indices[i], b = part.indices[i + 1], c = part.indices[i + 2];
        const auto [x0, x1] = std::minmax({x_[a], x_[b], x_[c]});
        const auto [y0, y1] = std::minmax({y_[a], y_[b], y_[c]});
        const std::size_t left = cell_of(x0), right = cell_of(x1);
        for (std::size_t y = cell_of(y0); y <= cell_of(y1); ++y) {
          std::fill(cells_.begin() + static_cast<std::ptrdiff_t>(y * kCells + left),
                    cells_.begin() + static_cast<std::ptrdiff_t>(y * kCells + right + 1),
                    std::uint8_t{1});
        }
      }
    }
  }
}

}  // namespace probe::render
