#include "runtime/render/sample_buffer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "runtime/render/boxed_triangles.h"
#include "runtime/render/clones.h"
#include "runtime/render/sample_vectors.h"

namespace probe::render {
namespace {

using samples::first_samples;
using samples::Floats;
using samples::Ints;
using samples::put;
using Doubles = double __attribute__((vector_size(32)));
using Longs = std::int64_t __attribute__((vector_size(32)));

struct Pixels {
  int left, right, top, bottom;  // the last ones too
};

inline bool any(const Ints& mask) {
  std::int64_t both[2];
  std::memcpy(both, &mask, sizeof both);
  return (both[0] | both[1]) != 0;
}

// Whether the sign of one of them is not set.
inline bool any_positive(const Ints& of) {
#ifdef __SSE2__
  return __builtin_ia32_movmskps(reinterpret_cast<const Floats&>(of)) != 15;
#else
  return any(of >= 0);
#endif
}

// How near the farthest samples of tiles of 2^shift pixels a side are.
struct Farthest {
  const float* tile;
  int across, shift;
};

// What is behind by less than this may come to lie before, by rounding.
constexpr double kBehind = 1.0001;

// A triangle of at most 64 pixels a side: everything in 32 bits.
PROBE_CLONES void draw_small(const DrawnCorner* c, double area, const Pixels& in,
                             const SampleGrid& grid, int samples, std::int32_t id, int stride,
                             float* nearness, std::uint32_t* ids) {
  Ints across, down;
  std::memcpy(&across, grid.across.data(), sizeof across);
  std::memcpy(&down, grid.down.data(), sizeof down);
  const Ints taken = first_samples(samples);
  int x[3], y[3];
  for (int i = 0; i < 3; ++i) {
    x[i] = c[i].x - in.left * kSubpixels;
    y[i] = c[i].y - in.top * kSubpixels;
  }
  const auto inverse = static_cast<float>(1 / area);
  constexpr int kWide = 6;
  const bool is_wide = in.right - in.left > kWide;
  // The edge across from corner i at a sample, twice the area of its part of the triangle.
  Ints row[3];
  int along_x[3], along_y[3];
  Floats share[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const int dx = x[k] - x[j], dy = y[k] - y[j];
    row[i] = dx * down - dy * across + (dy * x[j] - dx * y[j]);
    along_x[i] = -dy * kSubpixels;
    along_y[i] = dx * kSubpixels;
    share[i] = Floats{} + c[i].nearness * inverse;
  }
  // Pixels of a wide row before which an edge is not met, or from which on it is not any more.
  float inverse_step[3] = {}, reach[3] = {};
  if (is_wide) {
    for (int i = 0; i < 3; ++i) {
      inverse_step[i] = along_x[i] == 0 ? 0 : 1.0f / static_cast<float>(along_x[i]);
      reach[i] = static_cast<float>(std::abs(along_x[i]) + std::abs(along_y[i]));
    }
  }
  for (int py = in.top; py <= in.bottom; ++py) {
    int left = in.left, right = in.right;
    Ints e0 = row[0], e1 = row[1], e2 = row[2];
    if (is_wide) {
      float first = 0, last = static_cast<float>(in.right - in.left);
      for (int i = 0; i < 3; ++i) {
        const float place = -(static_cast<float>(row[i][0]) + reach[i]) * inverse_step[i];
        if (along_x[i] > 0) first = std::max(first, place - 1);
        if (along_x[i] < 0) last = std::min(last, place + 1);
      }
      if (first > last) {
        left = right + 1;
      } else {
        const auto skipped = static_cast<int>(first);
        left += skipped;
        right = in.left + static_cast<int>(last);
        e0 += skipped * along_x[0];
        e1 += skipped * along_x[1];
        e2 += skipped * along_x[2];
      }
    }
    std::size_t at = 4 * (static_cast<std::size_t>(py) * static_cast<std::size_t>(stride) +
                          static_cast<std::size_t>(left));
    for (int px = left; px <= right; ++px, at += 4) {
      const Ints outside = e0 | e1 | e2;
      if (any_positive(outside)) {
        const Floats here = __builtin_convertvector(e0, Floats) * share[0] +
                            __builtin_convertvector(e1, Floats) * share[1] +
                            __builtin_convertvector(e2, Floats) * share[2];
        put((outside >= 0) & taken, here, id, nearness + at, ids + at);
      }
      e0 += along_x[0];
      e1 += along_x[1];
      e2 += along_x[2];
    }
    row[0] += along_y[0];
    row[1] += along_y[1];
    row[2] += along_y[2];
  }
}

// Any triangle: edges in doubles, which hold these whole numbers exactly. Drawn from column `begin`
// on; as depths are summed up from where a row of it begins, they are so from in.left on, too.
PROBE_CLONES void draw_large(const DrawnCorner* c, double area, const Pixels& in,
                             const SampleGrid& grid, int samples, std::int32_t id, int stride,
                             float* nearness, std::uint32_t* ids, int begin,
                             const Farthest& behind) {
  Ints across, down;
  std::memcpy(&across, grid.across.data(), sizeof across);
  std::memcpy(&down, grid.down.data(), sizeof down);
  const Ints taken = first_samples(samples);
  const Doubles fx = __builtin_convertvector(__builtin_convertvector(across, Floats), Doubles);
  const Doubles fy = __builtin_convertvector(__builtin_convertvector(down, Floats), Doubles);
  double along_x[3], along_y[3], constant[3];
  double slope_x = 0, slope_y = 0, level = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto dx = static_cast<double>(c[k].x - c[j].x), dy = static_cast<double>(c[k].y - c[j].y);
    along_x[i] = -dy;
    along_y[i] = dx;
    constant[i] = dy * static_cast<double>(c[j].x) - dx * static_cast<double>(c[j].y);
    const double share = static_cast<double>(c[i].nearness) / area;
    slope_x += along_x[i] * share;
    slope_y += along_y[i] * share;
    level += constant[i] * share;
  }
  // Edges are sums of whole numbers below 2^53 then, and many steps of them are one.
  constexpr std::int32_t kExact = 1 << 24;
  bool is_exact = true;
  for (int i = 0; i < 3; ++i)
    is_exact = is_exact && std::abs(c[i].x) < kExact && std::abs(c[i].y) < kExact;
  Doubles offset[3];
  for (int i = 0; i < 3; ++i) offset[i] = along_x[i] * fx + along_y[i] * fy;
  // The least that a sample adds to an edge's value at its pixel's corner.
  double least_offset[3];
  for (int i = 0; i < 3; ++i)
    least_offset[i] = std::min({offset[i][0], offset[i][1], offset[i][2], offset[i][3]});
  const Floats lean = __builtin_convertvector(slope_x * fx + slope_y * fy, Floats);
  const double greatest_lean = std::max({lean[0], lean[1], lean[2], lean[3]});
  for (int py = in.top; py <= in.bottom; ++py) {
    // Where along the row all edges can be met by some sample, with a pixel of room.
    const double y = static_cast<double>(py) * kSubpixels;
    double first = in.left, last = in.right;
    // And where all samples are inside, with a pixel less.
    double inner_first = in.left, inner_last = in.right;
    double row[3];
    for (int i = 0; i < 3; ++i) {
      row[i] = constant[i] + along_y[i] * y;
      const double step = along_x[i] * kSubpixels;
      const double reach = (std::abs(along_x[i]) + std::abs(along_y[i])) * kSubpixels;
      if (step > 0) first = std::max(first, (-row[i] - reach) / step - 1);
      if (step < 0) last = std::min(last, (-row[i] - reach) / step + 1);
      if (step == 0 && row[i] + reach < 0) last = -1;
      const double inside = row[i] + least_offset[i];
      if (step > 0) inner_first = std::max(inner_first, -inside / step + 1);
      if (step < 0) inner_last = std::min(inner_last, -inside / step - 1);
      if (step == 0 && inside < 0) inner_last = -1;
    }
    if (!(first <= last)) continue;
    const int left = static_cast<int>(first), right = static_cast<int>(last);
    const bool any_inner = inner_first <= inner_last;
    const int inner_left = any_inner ? static_cast<int>(std::ceil(inner_first)) : right + 1;
    const int inner_right = any_inner ? static_cast<int>(std::floor(inner_last)) : right;
    std::size_t at = 4 * (static_cast<std::size_t>(py) * static_cast<std::size_t>(stride) +
                          static_cast<std::size_t>(left));
    const double x0 = static_cast<double>(left) * kSubpixels;
    Doubles e0 = row[0] + along_x[0] * x0 + offset[0];
    Doubles e1 = row[1] + along_x[1] * x0 + offset[1];
    Doubles e2 = row[2] + along_x[2] * x0 + offset[2];
    const double step0 = along_x[0] * kSubpixels, step1 = along_x[1] * kSubpixels,
                 step2 = along_x[2] * kSubpixels;
    const auto advance = [&](int pixels) {
      const int steps = is_exact ? 1 : pixels;
      const double each = is_exact ? pixels : 1;
      for (int i = 0; i < steps; ++i) {
        e0 += step0 * each;
        e1 += step1 * each;
        e2 += step2 * each;
      }
    };
    double here = level + slope_y * y + slope_x * x0;
    const double step = slope_x * kSubpixels;
    const float* const farthest = behind.tile + (py >> behind.shift) * behind.across;
    int px = left;
    if (px < begin) {
      const int count = std::min(begin, right + 1) - px;
      advance(count);
      for (int i = 0; i < count; ++i) here += step;
      at += 4 * static_cast<std::size_t>(count);
      px += count;
    }
    while (px <= right) {
      const int next = std::min(right + 1, ((px >> behind.shift) + 1) << behind.shift);
      const int count = next - px;
      // A row of a tile: the nearest of it lies at one of its ends, or beyond.
      const double ends = std::max(here, here + step * count) + greatest_lean;
      if (ends * kBehind < static_cast<double>(farthest[px >> behind.shift])) {
        // Step by step: what is rounded on the way stays the same.
        advance(count);
        for (int i = 0; i < count; ++i) here += step;
        at += 4 * static_cast<std::size_t>(count);
        px = next;
        continue;
      }
      if (px >= inner_left && next - 1 <= inner_right) {
        advance(count);
        for (; px < next; ++px, at += 4) {
          put(taken, static_cast<float>(here) + lean, id, nearness + at, ids + at);
          here += step;
        }
        continue;
      }
      for (; px < next; ++px, at += 4) {
        const Longs wide = (e0 >= 0.0) & (e1 >= 0.0) & (e2 >= 0.0);
        const Ints inside = __builtin_convertvector(wide, Ints) & taken;
        if (any(inside)) put(inside, static_cast<float>(here) + lean, id, nearness + at, ids + at);
        e0 += step0;
        e1 += step1;
        e2 += step2;
        here += step;
      }
    }
  }
}

}  // namespace

void SampleBuffer::draw_boxed(const SmallTriangles& triangles, const SomeTriangles& boxed,
                              std::size_t box, std::uint32_t first_id, const std::uint32_t* ids) {
  if (boxed.count == 0) return;
  draw_boxes(triangles, boxed, kBoxes[box], first_id, ids, grid_, taken_,
             {nearness_.data(), id_.data(), width_});
}

void SampleBuffer::resize(int width, int height, bool smooth) {
  width_ = width;
  height_ = height;
  // The four places of a rotated grid: each in a row and a column of its own.
  grid_ = smooth ? SampleGrid{{96, 224, 32, 160}, {224, 160, 96, 32}, 32, 224}
                 : SampleGrid{{128, 128, 128, 128}, {128, 128, 128, 128}, 128, 128};
  const std::size_t samples =
      std::size_t{4} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height);
  const auto tiles = [](int pixels) { return (pixels + kTile - 1) >> kTileShift; };
  tiles_across_ = tiles(width);
  farthest_.resize(static_cast<std::size_t>(tiles_across_) *
                   static_cast<std::size_t>(tiles(height)));
  changed_.resize(farthest_.size());
  nearness_.resize(samples);
  id_.resize(samples);
  clear();
}

void SampleBuffer::clear() {
  left_ = top_ = 0;
  right_ = width_ - 1;
  bottom_ = height_ - 1;
  std::fill(nearness_.begin(), nearness_.end(), 0.0f);
  std::fill(id_.begin(), id_.end(), 0u);
  std::fill(farthest_.begin(), farthest_.end(), 0.0f);
  std::fill(changed_.begin(), changed_.end(), std::uint8_t{0});
  is_looked_at_ = false;
}

void SampleBuffer::clear(int left, int right, int top, int bottom) {
  left_ = left;
  right_ = right;
  top_ = top;
  bottom_ = bottom;
  forget(left, right, top, bottom);
  for (int y = top; y <= bottom; ++y) {
    const auto first = static_cast<std::ptrdiff_t>(4 * at(left, y)),
               end = static_cast<std::ptrdiff_t>(4 * (at(right, y) + 1));
    std::fill(nearness_.begin() + first, nearness_.begin() + end, 0.0f);
    std::fill(id_.begin() + first, id_.begin() + end, 0u);
  }
}

void SampleBuffer::draw(const DrawnCorner& a, const DrawnCorner& b, const DrawnCorner& c,
                        std::uint32_t id) {
  const double area = static_cast<double>(b.x - a.x) * static_cast<double>(c.y - a.y) -
                      static_cast<double>(c.x - a.x) * static_cast<double>(b.y - a.y);
  // Rows go down, so what turns against the clock in the world does so with a negative area.
  if (area >= 0) return;
  const DrawnCorner corners[3] = {a, c, b};
  // The first and the last pixel of which a sample can be inside.
  const auto first = [&](int least) { return (least - grid_.high + kSubpixels - 1) >> 8; };
  const auto last = [&](int greatest) { return (greatest - grid_.low) >> 8; };
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
  const int x0 = first(left), x1 = last(right), y0 = first(top), y1 = last(bottom);
  Pixels in{std::max(x0, left_), std::min(x1, right_), std::max(y0, top_), std::min(y1, bottom_)};
  if (in.left > in.right || in.top > in.bottom) return;
  const int left_tile = in.left >> kTileShift, right_tile = in.right >> kTileShift;
  const int top_tile = in.top >> kTileShift, bottom_tile = in.bottom >> kTileShift;
  if (is_looked_at_) {
    const float nearest =
        std::max({a.nearness, b.nearness, c.nearness}) * static_cast<float>(kBehind);
    const auto is_hidden = [&] {
      for (int row = top_tile; row <= bottom_tile; ++row) {
        for (int column = left_tile; column <= right_tile; ++column) {
          if (!(nearest < farthest_[tile_at(column, row)])) return false;
        }
      }
      return true;
    };
    if (is_hidden()) return;
  }
  if (is_looked_at_) note(in.left, in.right, in.top, in.bottom);
  constexpr int kSmall = 64;
  if (x1 - x0 < kSmall && y1 - y0 < kSmall) {
    draw_small(corners, -area, in, grid_, taken_, static_cast<std::int32_t>(id), width_,
               nearness_.data(), id_.data());
  } else {
    in.left = std::max(x0, 0);
    draw_large(corners, -area, in, grid_, taken_, static_cast<std::int32_t>(id), width_,
               nearness_.data(), id_.data(), left_, {farthest_.data(), tiles_across_, kTileShift});
  }
}

void SampleBuffer::note(int left, int right, int top, int bottom) {
  for (int row = top >> kTileShift; row <= bottom >> kTileShift; ++row) {
    for (int column = left >> kTileShift; column <= right >> kTileShift; ++column)
      changed_[tile_at(column, row)] = 1;
  }
}

// How near the farthest sample of a tile is.
float SampleBuffer::look_at(int column, int row) {
  float& farthest = farthest_[tile_at(column, row)];
  std::uint8_t& changed = changed_[tile_at(column, row)];
  if (changed == 0) return farthest;
  changed = 0;
  const int left = column << kTileShift, right = std::min(left + kTile, width_);
  Floats least = Floats{} + std::numeric_limits<float>::infinity();
  for (int y = row << kTileShift; y < std::min((row + 1) << kTileShift, height_); ++y) {
    const float* const from = nearness(left, y);
    for (int i = 0; i < 4 * (right - left); i += 4) {
      Floats here;
      std::memcpy(&here, from + i, sizeof here);
      least = here < least ? here : least;
    }
  }
  farthest = std::min({least[0], least[1], least[2], least[3]});
  return farthest;
}

bool SampleBuffer::hides(int left, int right, int top, int bottom, float nearness) {
  constexpr int kMostTiles = 256;
  const int first = left >> kTileShift, last = right >> kTileShift;
  if ((last - first + 1) * ((bottom >> kTileShift) - (top >> kTileShift) + 1) > kMostTiles)
    return false;
  const float nearest = nearness * static_cast<float>(kBehind);
  is_looked_at_ = true;
  bool hides = true;
  for (int row = top >> kTileShift; row <= bottom >> kTileShift; ++row) {
    for (int column = first; column <= last; ++column)
      hides = nearest < look_at(column, row) && hides;
  }
  return hides;
}

// Samples of these pixels are farther than they were, or may be.
void SampleBuffer::forget(int left, int right, int top, int bottom) {
  if (!is_looked_at_) return;
  for (int row = top >> kTileShift; row <= bottom >> kTileShift; ++row) {
    for (int column = left >> kTileShift; column <= right >> kTileShift; ++column) {
      farthest_[tile_at(column, row)] = 0;
      changed_[tile_at(column, row)] = 1;
    }
  }
}

void SampleBuffer::restore(const SampleBuffer& from, int row, int left, int right) {
  forget(left, right - 1, row, row);
  const std::size_t first = 4 * at(left, row),
                    count = std::size_t{4} * static_cast<std::size_t>(right - left);
  std::copy_n(from.nearness_.begin() + static_cast<std::ptrdiff_t>(first), count,
              nearness_.begin() + static_cast<std::ptrdiff_t>(first));
  std::copy_n(from.id_.begin() + static_cast<std::ptrdiff_t>(first), count,
              id_.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace probe::render
