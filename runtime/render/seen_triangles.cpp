#include "runtime/render/seen_triangles.h"

#include "runtime/render/clones.h"
#include "runtime/render/extremes.h"

namespace probe::render {
namespace {

constexpr std::size_t kMost = SmallTriangles::kMost;
constexpr int kPixelShift = 8;
static_assert(1 << kPixelShift == kSubpixels);

// In the order that SampleBuffer::draw works in: the second and the third corner exchanged.
struct Corners {
  std::int32_t x[3][kMost], y[3][kMost];
  float nearness[3][kMost];
};

struct Found {
  std::int32_t is_drawn[kMost];  // 1: SampleBuffer::draw has to see it
  std::int32_t is_tiny[kMost];  // 1: of less than a pixel a side, front, and in the picture's reach
  std::int32_t twice_area[kMost];
};

PROBE_CLONES void gather(const std::int32_t* __restrict from, const std::uint16_t* __restrict at,
                         std::size_t count, std::int32_t* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[at[i]];
}

PROBE_CLONES void gather(const float* __restrict from, const std::uint16_t* __restrict at,
                         std::size_t count, float* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[at[i]];
}

PROBE_CLONES std::int32_t sort_out(const Corners& __restrict corners, std::size_t count,
                                   const SampleGrid& grid, std::int32_t right, std::int32_t bottom,
                                   Found& __restrict found) {
  const SampleGrid at = grid;
  std::int32_t any_tiny = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t ax = corners.x[0][i], bx = corners.x[1][i], cx = corners.x[2][i];
    const std::int32_t ay = corners.y[0][i], by = corners.y[1][i], cy = corners.y[2][i];
    const std::int32_t low_x = least(ax, bx, cx), high_x = greatest(ax, bx, cx);
    const std::int32_t low_y = least(ay, by, cy), high_y = greatest(ay, by, cy);
    const std::int32_t side = greatest(high_x - low_x, high_y - low_y);
    // Sides below 2^14: products of two fit 2^28, and what wraps is of triangles that are drawn.
    const bool is_large = side >= 1 << 14;
    const auto product = [](std::int32_t a, std::int32_t b) {
      return static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b);
    };
    const auto area =
        static_cast<std::int32_t>(product(bx - ax, cy - ay) - product(cx - ax, by - ay));
    const bool is_within = (high_x >= 0) & (low_x < right) & (high_y >= 0) & (low_y < bottom);
    // A sample's column and row in the box around the triangle.
    bool holds = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int32_t dx = at.across[k], dy = at.down[k];
      holds |= (((high_x - dx) >> kPixelShift) >= ((low_x - dx + 255) >> kPixelShift)) &
               (((high_y - dy) >> kPixelShift) >= ((low_y - dy + 255) >> kPixelShift));
    }
    const bool is_seen = (area > 0) & is_within & holds;
    const bool is_tiny = is_seen & (side < kSubpixels);
    found.is_drawn[i] = is(is_large | (is_seen & (side >= kSubpixels)));
    found.is_tiny[i] = is(is_tiny);
    found.twice_area[i] = area;
    any_tiny |= found.is_tiny[i];
  }
  return any_tiny;
}

// Whether triangles of less than a pixel hold the sample of that place in some pixel, where, and
// how near they are there.
PROBE_CLONES void find_held(const Corners& __restrict corners, const float* __restrict inverse,
                            std::size_t count, std::int32_t dx, std::int32_t dy, std::int32_t width,
                            std::int32_t height, std::int32_t* __restrict holds,
                            std::int32_t* __restrict pixel, float* __restrict nearness) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t ax = corners.x[0][i], bx = corners.x[1][i], cx = corners.x[2][i];
    const std::int32_t ay = corners.y[0][i], by = corners.y[1][i], cy = corners.y[2][i];
    // The first such sample right of and below the box's least corner is the only one it can hold.
    const std::int32_t column = (least(ax, bx, cx) - dx + 255) >> kPixelShift;
    const std::int32_t row = (least(ay, by, cy) - dy + 255) >> kPixelShift;
    const auto whole = [](std::int32_t pixels) {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(pixels) << kPixelShift);
    };
    const std::int32_t x = whole(column) + dx, y = whole(row) + dy;
    const auto edge = [&](std::int32_t fx, std::int32_t fy, std::int32_t tx, std::int32_t ty) {
      const auto product = [](std::int32_t a, std::int32_t b) {
        return static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b);
      };
      return static_cast<std::int32_t>(product(tx - fx, y - fy) - product(ty - fy, x - fx));
    };
    const std::int32_t e0 = edge(bx, by, cx, cy), e1 = edge(cx, cy, ax, ay),
                       e2 = edge(ax, ay, bx, by);
    nearness[i] = static_cast<float>(e0) * (corners.nearness[0][i] * inverse[i]) +
                  static_cast<float>(e1) * (corners.nearness[1][i] * inverse[i]) +
                  static_cast<float>(e2) * (corners.nearness[2][i] * inverse[i]);
    pixel[i] = row * width + column;
    const bool is_in = (column >= 0) & (column < width) & (row >= 0) & (row < height);
    holds[i] = is(((e0 | e1 | e2) >= 0) & is_in);
  }
}

PROBE_CLONES void invert(const std::int32_t* __restrict twice_area, std::size_t count,
                         float* __restrict inverse) {
  for (std::size_t i = 0; i < count; ++i)
    inverse[i] = static_cast<float>(1 / static_cast<double>(twice_area[i]));
}

}  // namespace

void find_seen(const SmallTriangles& triangles, const SampleBuffer& picture, SeenTriangles& out) {
  Corners corners;
  const std::size_t count = triangles.count;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint16_t* corner = triangles.corner[k == 0 ? 0 : 3 - k];
    gather(triangles.x, corner, count, corners.x[k]);
    gather(triangles.y, corner, count, corners.y[k]);
    gather(triangles.nearness, corner, count, corners.nearness[k]);
  }
  const SampleGrid& grid = picture.grid();
  const std::int32_t width = picture.width(), height = picture.height();
  Found found;
  const bool any_tiny =
      sort_out(corners, count, grid, width * kSubpixels, height * kSubpixels, found) != 0;
  out.draws = out.held = 0;
  for (std::size_t i = 0; i < count; ++i) {
    out.to_draw[out.draws] = static_cast<std::uint16_t>(i);
    out.draws += static_cast<std::size_t>(found.is_drawn[i]);
  }
  if (!any_tiny) return;
  Corners tiny;
  std::uint16_t which[kMost];
  std::int32_t twice_area[kMost];
  std::size_t tinies = 0;
  for (std::size_t i = 0; i < count; ++i) {
    which[tinies] = static_cast<std::uint16_t>(i);
    twice_area[tinies] = found.twice_area[i];
    tinies += static_cast<std::size_t>(found.is_tiny[i]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    gather(corners.x[k], which, tinies, tiny.x[k]);
    gather(corners.y[k], which, tinies, tiny.y[k]);
    gather(corners.nearness[k], which, tinies, tiny.nearness[k]);
  }
  float inverse[kMost];
  invert(twice_area, tinies, inverse);
  for (std::size_t k = 0; k < grid.across.size(); ++k) {
    std::int32_t holds[kMost], pixel[kMost];
    float nearness[kMost];
    find_held(tiny, inverse, tinies, grid.across[k], grid.down[k], width, height, holds, pixel,
              nearness);
    for (std::size_t i = 0; i < tinies; ++i) {
      out.samples[out.held] = {
          4 * static_cast<std::uint32_t>(pixel[i]) + static_cast<std::uint32_t>(k), nearness[i],
          which[i]};
      out.held += static_cast<std::size_t>(holds[i]);
    }
  }
}

}  // namespace probe::render
