#include "runtime/render/boxed_triangles.h"

#include <cstring>

#include "runtime/render/clones.h"
#include "runtime/render/extremes.h"
#include "runtime/render/sample_vectors.h"

namespace probe::render {
namespace {

using samples::Floats;
using samples::Ints;

// Triangles as arrays, [corner][triangle]. Of the edge across from a corner (twice the area of a
// point's part of the triangle, square subpixels): what a step of a subpixel right and below adds,
// and its value at the left top of the box's first pixel. `share`: 1 / depth (1/m) of the corner,
// then that over twice the triangle's area.
struct BoxedEdges {
  static constexpr std::size_t kMost = SmallTriangles::kMost;
  std::int32_t x[3][kMost], y[3][kMost];  // of corners, in the picture and then in the box
  float share[3][kMost];
  std::int32_t right[3][kMost], below[3][kMost], edge[3][kMost];
  std::int32_t pixel[kMost];  // the box's first
};

PROBE_CLONES void gather_corners(const SmallTriangles& triangles, const SomeTriangles& boxed,
                                 std::size_t corner, std::int32_t* __restrict x,
                                 std::int32_t* __restrict y, float* __restrict nearness) {
  const std::uint16_t* __restrict const which = boxed.which.data();
  const std::uint16_t* __restrict const of = triangles.corner[corner];
  const std::int32_t* __restrict const from_x = triangles.x;
  const std::int32_t* __restrict const from_y = triangles.y;
  const float* __restrict const from_nearness = triangles.nearness;
  for (std::size_t i = 0; i < boxed.count; ++i) {
    const std::uint16_t at = of[which[i]];
    x[i] = from_x[at];
    y[i] = from_y[at];
    nearness[i] = from_nearness[at];
  }
}

PROBE_CLONES void set_up(BoxedEdges& __restrict of, std::size_t count, const SampleGrid& grid,
                         std::int32_t width) {
  const std::int32_t high = grid.high;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t left = (least(of.x[0][i], of.x[1][i], of.x[2][i]) - high + 255) >> 8;
    const std::int32_t top = (least(of.y[0][i], of.y[1][i], of.y[2][i]) - high + 255) >> 8;
    of.pixel[i] = top * width + left;
    for (std::size_t k = 0; k < 3; ++k) {
      of.x[k][i] -= left * kSubpixels;
      of.y[k][i] -= top * kSubpixels;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t f = (k + 1) % 3, t = (k + 2) % 3;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t right = of.y[f][i] - of.y[t][i], below = of.x[t][i] - of.x[f][i];
      of.right[k][i] = right;
      of.below[k][i] = below;
      of.edge[k][i] = -(below * of.y[f][i] + right * of.x[f][i]);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t area = of.below[2][i] * of.right[1][i] - of.right[2][i] * of.below[1][i];
    const auto inverse = static_cast<float>(1 / static_cast<double>(area));
    for (std::size_t k = 0; k < 3; ++k) of.share[k][i] *= inverse;
  }
}

// All pixels of a box, asked or not: nothing is to be foreseen.
template <int kSide>
[[gnu::always_inline]] inline void draw_box(const BoxedEdges& of, std::size_t i, const Ints& across,
                                            const Ints& down, const Ints& taken, std::int32_t id,
                                            const SampleRows& rows) {
  Ints row[3];
  Floats share[3];
  for (std::size_t k = 0; k < 3; ++k) {
    row[k] = of.right[k][i] * across + of.below[k][i] * down + of.edge[k][i];
    share[k] = Floats{} + of.share[k][i];
  }
  std::size_t at = 4 * static_cast<std::size_t>(of.pixel[i]);
  for (int y = 0; y < kSide; ++y, at += 4 * static_cast<std::size_t>(rows.width)) {
    Ints e0 = row[0], e1 = row[1], e2 = row[2];
    for (int x = 0; x < kSide; ++x) {
      const Floats here = __builtin_convertvector(e0, Floats) * share[0] +
                          __builtin_convertvector(e1, Floats) * share[1] +
                          __builtin_convertvector(e2, Floats) * share[2];
      const std::size_t place = at + 4 * static_cast<std::size_t>(x);
      samples::put(((e0 | e1 | e2) >= 0) & taken, here, id, rows.nearness + place,
                   rows.ids + place);
      e0 += of.right[0][i] * kSubpixels;
      e1 += of.right[1][i] * kSubpixels;
      e2 += of.right[2][i] * kSubpixels;
    }
    for (std::size_t k = 0; k < 3; ++k) row[k] += of.below[k][i] * kSubpixels;
  }
}

PROBE_CLONES void draw_edges(const BoxedEdges& of, const SomeTriangles& boxed, int side,
                             std::uint32_t first_id, const std::uint32_t* numbers,
                             const SampleGrid& grid, int samples, const SampleRows& out) {
  Ints across, down;
  std::memcpy(&across, grid.across.data(), sizeof across);
  std::memcpy(&down, grid.down.data(), sizeof down);
  const Ints taken = samples::first_samples(samples);
  const SampleRows rows = out;  // a copy: what is written could else change it
  const auto id = [&](std::size_t i) {
    return static_cast<std::int32_t>(first_id + numbers[boxed.which[i]]);
  };
  for (std::size_t i = 0; side == 2 && i < boxed.count; ++i)
    draw_box<2>(of, i, across, down, taken, id(i), rows);
  for (std::size_t i = 0; side == 3 && i < boxed.count; ++i)
    draw_box<3>(of, i, across, down, taken, id(i), rows);
}

}  // namespace

void draw_boxes(const SmallTriangles& triangles, const SomeTriangles& boxed, int side,
                std::uint32_t first_id, const std::uint32_t* ids, const SampleGrid& grid, int taken,
                const SampleRows& rows) {
  BoxedEdges edges;
  // As SampleBuffer::draw has them: the second and the third corner exchanged.
  for (std::size_t k = 0; k < 3; ++k)
    gather_corners(triangles, boxed, k == 0 ? 0 : 3 - k, edges.x[k], edges.y[k], edges.share[k]);
  set_up(edges, boxed.count, grid, rows.width);
  draw_edges(edges, boxed, side, first_id, ids, grid, taken, rows);
}

}  // namespace probe::render
