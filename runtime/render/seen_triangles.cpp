#include "runtime/render/seen_triangles.h"

#include <bit>
#include <cstring>

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
};

using Flags = std::array<std::int32_t, kMost>;  // -1 or 0
struct Found {
  Flags is_drawn;
  std::array<Flags, SampleBuffer::kBoxes.size()> is_boxed;
};

PROBE_CLONES void gather(const std::int32_t* __restrict from, const std::uint16_t* __restrict at,
                         std::size_t count, std::int32_t* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[at[i]];
}

PROBE_CLONES void sort_out(const Corners& __restrict corners, std::size_t count,
                           const SampleGrid& grid, std::int32_t width, std::int32_t height,
                           Found& __restrict found) {
  const SampleGrid at = grid;
  const std::int32_t right = width * kSubpixels, bottom = height * kSubpixels;
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
    // Pixels that may have samples in it.
    const std::int32_t column = (low_x - at.high + 255) >> kPixelShift,
                       row = (low_y - at.high + 255) >> kPixelShift;
    const std::int32_t across = ((high_x - at.low) >> kPixelShift) - column + 1,
                       down = ((high_y - at.low) >> kPixelShift) - row + 1;
    bool is_left = is_seen & !is_large & (column >= 0) & (row >= 0);
    bool is_drawn = is_large | is_seen;
    for (std::size_t k = 0; k < SampleBuffer::kBoxes.size(); ++k) {
      const std::int32_t box = SampleBuffer::kBoxes[k];
      const bool fits = is_left & (across <= box) & (down <= box) & (column + box <= width) &
                        (row + box <= height);
      found.is_boxed[k][i] = -is(fits);
      is_left &= !fits;
      is_drawn &= !fits;
    }
    found.is_drawn[i] = -is(is_drawn);
  }
}

// The numbers of the first `count` flags that are set.
void list(const Flags& flags, std::size_t count, SomeTriangles& out) {
  out.count = 0;
  for (std::size_t first = 0; first < count; first += 32) {
    std::uint32_t set = 0;
    for (std::size_t i = 0; i < 32; i += 4) set |= signs_of(flags.data() + first + i) << i;
    if (count - first < 32) set &= (1u << (count - first)) - 1;
    for (; set != 0; set &= set - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(set));
      out.which[out.count++] = static_cast<std::uint16_t>(first + i);
    }
  }
}

}  // namespace

void find_seen(const SmallTriangles& triangles, const SampleBuffer& picture, SeenTriangles& out) {
  Corners corners;
  const std::size_t count = triangles.count;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint16_t* corner = triangles.corner[k == 0 ? 0 : 3 - k];
    gather(triangles.x, corner, count, corners.x[k]);
    gather(triangles.y, corner, count, corners.y[k]);
  }
  Found found;
  sort_out(corners, count, picture.grid(), picture.width(), picture.height(), found);
  list(found.is_drawn, count, out.to_draw);
  for (std::size_t k = 0; k < out.boxed.size(); ++k) list(found.is_boxed[k], count, out.boxed[k]);
}

}  // namespace probe::render
