#include "runtime/render/hit_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();
// Packets of a row from which on its ends are worth computing.
constexpr int kLongRow = 3;
// A triangle that is less close than this part of a packet's farthest sample is clearly behind in
// all of them, with room for rounding.
constexpr float kHiddenBehind = 0.996f;
static_assert(kHiddenBehind < kClearlyBehind);

using Eight = float __attribute__((vector_size(32)));
using EightInts = std::int32_t __attribute__((vector_size(32)));

// Columns and rows of the samples of a packet.
constexpr Eight kLaneX{0, 1, 0, 1, 2, 3, 2, 3};
constexpr Eight kLaneY{0, 0, 1, 1, 0, 0, 1, 1};
constexpr bool lanes_are_tile_offsets() {
  constexpr unsigned x[] = {0, 1, 0, 1, 2, 3, 2, 3}, y[] = {0, 0, 1, 1, 0, 0, 1, 1};
  for (std::size_t i = 0; i < 8; ++i) {
    if (kTileOffsets[i].x != x[i] || kTileOffsets[i].y != y[i]) return false;
  }
  return true;
}
static_assert(lanes_are_tile_offsets(), "a packet's samples are the first eight of a tile's order");

inline float least_of(const Eight& of) {
  const auto less = [](float a, float b) { return a < b ? a : b; };
  return less(less(less(of[0], of[1]), less(of[2], of[3])),
              less(less(of[4], of[5]), less(of[6], of[7])));
}

PROBE_CLONES void draw_all(const TriangleBatch& batch, int packets_x, float* __restrict closest,
                           float* __restrict other, std::uint32_t* __restrict owner,
                           float* __restrict hidden, std::uint8_t* __restrict changed) {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const std::size_t i = batch.order[n];
    const float a[3] = {batch.a[0][i], batch.a[1][i], batch.a[2][i]};
    const float b[3] = {batch.b[0][i], batch.b[1][i], batch.b[2][i]};
    const float e[3] = {batch.e[0][i], batch.e[1][i], batch.e[2][i]};
    const float touch[3] = {batch.touch[0][i], batch.touch[1][i], batch.touch[2][i]};
    const float wx = batch.wx[i], wy = batch.wy[i];
    const bool solid = batch.solid[i] != 0;
    const Eight e0 = e[0] + a[0] * kLaneX + b[0] * kLaneY;
    const Eight e1 = e[1] + a[1] * kLaneX + b[1] * kLaneY;
    const Eight e2 = e[2] + a[2] * kLaneX + b[2] * kLaneY;
    const Eight w0 = batch.w[i] + wx * kLaneX + wy * kLaneY;
    const Eight touch0 = Eight{} - touch[0], touch1 = Eight{} - touch[1],
                touch2 = Eight{} - touch[2];
    const Eight inside0 = Eight{} + (solid ? touch[0] : kNowhere), inside1 = Eight{} + touch[1],
                inside2 = Eight{} + touch[2];
    const EightInts number =
        EightInts{} + (2 * static_cast<std::int32_t>(batch.triangle[i]) + batch.fine[i]);
    const float a0 = 4 * a[0], a1 = 4 * a[1], a2 = 4 * a[2], w4 = 4 * wx;
    // The closest that it is in a packet, of that packet's first sample's.
    const float highest = batch.w[i] + (wx > 0 ? 3 * wx : 0.0f) + (wy > 0 ? wy : 0.0f);
    const int columns = batch.columns[i];
    // An edge's bound in a row of packets, as (reach + b y) step: the first column where step is
    // negative, else the last.
    float reach[3] = {}, step[3] = {};
    if (columns >= kLongRow) {
      for (int k = 0; k < 3; ++k) {
        // Its greatest value in the packet, and room for rounding.
        reach[k] = e[k] + touch[k] + (b[k] > 0 ? b[k] : 0) + (a[k] > 0 ? 3 * a[k] : 0) +
                   1e-3f * std::abs(a[k]);
        step[k] = a[k] == 0 ? kNowhere : -0.25f / a[k];
      }
    }
    const std::size_t first =
        8 * (static_cast<std::size_t>(batch.top[i]) * static_cast<std::size_t>(packets_x) +
             static_cast<std::size_t>(batch.left[i]));
    for (int y = 0; y < batch.rows[i]; ++y) {
      const auto dy = static_cast<float>(2 * y);
      int from = 0, to = columns;
      if (columns >= kLongRow) {
        const auto end = static_cast<float>(columns);
        float left = 0, right = end;
        for (int k = 0; k < 3; ++k) {
          const float bound = (reach[k] + b[k] * dy) * step[k];
          const float low = step[k] < 0 ? bound : 0.0f;
          const float high = step[k] < 0 ? end : bound;
          left = left < low ? low : left;
          right = high < right ? high : right;
        }
        if (!(left <= right)) continue;
        from = static_cast<int>(left);
        to = static_cast<int>(right) + 1 < columns ? static_cast<int>(right) + 1 : columns;
      }
      const float b0 = b[0] * dy, b1 = b[1] * dy, b2 = b[2] * dy, dw = wy * dy;
      std::uint8_t* const row_changed =
          changed + static_cast<std::size_t>((batch.top[i] + y) >> 2) *
                        static_cast<std::size_t>(packets_x >> 1);
      const std::size_t row =
          first + 8 * static_cast<std::size_t>(y) * static_cast<std::size_t>(packets_x);
      for (int x = from; x < to; ++x) {
        const auto dx = static_cast<float>(x);
        float& behind = hidden[(row >> 3) + static_cast<std::size_t>(x)];
        if (highest + (w4 * dx + dw) < behind) continue;
        const Eight v0 = e0 + (a0 * dx + b0), v1 = e1 + (a1 * dx + b1), v2 = e2 + (a2 * dx + b2);
        const Eight w = w0 + (w4 * dx + dw);
        const EightInts inside = (v0 > inside0) & (v1 > inside1) & (v2 > inside2);
        const EightInts touched = (v0 >= touch0) & (v1 >= touch1) & (v2 >= touch2);
        const std::size_t at = row + 8 * static_cast<std::size_t>(x);
        Eight front, second;
        EightInts name;
        std::memcpy(&front, closest + at, sizeof front);
        std::memcpy(&second, other + at, sizeof second);
        std::memcpy(&name, owner + at, sizeof name);
        const Eight seen = touched ? w : Eight{};
        const EightInts ahead = inside & (w > front);
        const Eight beaten = ahead ? front : seen;
        second = second > beaten ? second : beaten;
        front = ahead ? w : front;
        name = ahead ? number : name;
        behind = kHiddenBehind * least_of(front);
        row_changed[(batch.left[i] + x) >> 1] = 1;
        std::memcpy(closest + at, &front, sizeof front);
        std::memcpy(other + at, &second, sizeof second);
        std::memcpy(owner + at, &name, sizeof name);
      }
    }
  }
}

// A block's packets, one pointer each.
PROBE_CLONES void answer_all(const float* const* closest, const float* const* other,
                             const std::uint32_t* const* owner, const float* __restrict farthest,
                             const float* __restrict cosine, std::uint8_t* __restrict hit,
                             std::uint8_t* __restrict open) {
  for (std::size_t p = 0; p < 8; ++p) {
    const float* __restrict c = closest[p];
    const float* __restrict o = other[p];
    const std::uint32_t* __restrict of = owner[p];
    for (std::size_t k = 0; k < 8; ++k) {
      const float front = c[k], second = o[k];
      const float still = 1.0f / (farthest[8 * p + k] * cosine[8 * p + k]);
      const float behind = second > still ? second : still;
      const float any = second > front ? second : front;
      const float least = front * ((of[k] & 1) != 0 ? kFinelyBehind : kClearlyBehind);
      const int is_hit = least > behind ? 1 : 0;
      const int is_miss = any < kFinelyBehind * still ? 1 : 0;
      hit[8 * p + k] = static_cast<std::uint8_t>(is_hit);
      open[8 * p + k] = static_cast<std::uint8_t>(1 - (is_hit | is_miss));
    }
  }
}

PROBE_CLONES void cover_all(const float* const* closest, const float* const* other,
                            const std::uint32_t* const* owner, float closeness,
                            std::uint8_t* __restrict covered) {
  for (std::size_t p = 0; p < 8; ++p) {
    const float* __restrict c = closest[p];
    const float* __restrict o = other[p];
    const std::uint32_t* __restrict of = owner[p];
    int all = 1;
    for (std::size_t k = 0; k < 8; ++k) {
      const float least = c[k] * ((of[k] & 1) != 0 ? kFinelyBehind : kClearlyBehind);
      const float behind = o[k] > closeness ? o[k] : closeness;
      all &= least > behind ? 1 : 0;
    }
    covered[p] = static_cast<std::uint8_t>(all);
  }
}

}  // namespace

bool BlockAnswers::settled(std::size_t packet) const {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, open.data() + 8 * packet, sizeof bytes);
  return bytes == 0;
}

void HitSheet::resize(int tiles_x, int tiles_y) {
  packets_x_ = 4 * tiles_x;
  const std::size_t samples =
      static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y) * kTileSamples;
  closest_.resize(samples);
  other_.resize(samples);
  owner_.resize(samples);
  hidden_.resize(samples / 8);
  block_hidden_.resize(samples / 64);
  changed_.resize(samples / 64);
}

void HitSheet::clear_block(int x, int y) {
  for (int row = 4 * y; row < 4 * (y + 1); ++row) {
    std::fill_n(closest_.data() + packet_at(2 * x, row), 16, 0.0f);
    std::fill_n(other_.data() + packet_at(2 * x, row), 16, 0.0f);
    std::fill_n(hidden_.data() + packet_at(2 * x, row) / 8, 2, 0.0f);
  }
  block_hidden_[block_at(x, y)] = 0;
  changed_[block_at(x, y)] = 0;
}

void HitSheet::draw(const TriangleBatch& batch) {
  draw_all(batch, packets_x_, closest_.data(), other_.data(), owner_.data(), hidden_.data(),
           changed_.data());
}

bool HitSheet::hides(int x0, int y0, int x1, int y1, float closeness) {
  constexpr int kMost = 64;
  if ((x1 - x0 + 1) * (y1 - y0 + 1) > kMost) return false;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      float& hidden = block_hidden_[block_at(x, y)];
      std::uint8_t& changed = changed_[block_at(x, y)];
      if (changed != 0) {
        changed = 0;
        hidden = kNowhere;
        for (int row = 4 * y; row < 4 * (y + 1); ++row) {
          const float* const two = hidden_.data() + packet_at(2 * x, row) / 8;
          hidden = std::min({hidden, two[0], two[1]});
        }
      }
      if (!(closeness < hidden)) return false;
    }
  }
  return true;
}

std::array<std::size_t, 8> HitSheet::packets_of(int block_x, int block_y) const {
  std::array<std::size_t, 8> out;
  for (int p = 0; p < 8; ++p) {
    out[static_cast<std::size_t>(p)] =
        packet_at(2 * block_x + ((p >> 1) & 1), 4 * block_y + (p & 1) + 2 * (p >> 2));
  }
  return out;
}

PacketSet HitSheet::covers(int block_x, int block_y, float closeness) const {
  const std::array<std::size_t, 8> packets = packets_of(block_x, block_y);
  const float *closest[8], *other[8];
  const std::uint32_t* owner[8];
  for (std::size_t p = 0; p < 8; ++p) {
    closest[p] = closest_.data() + packets[p];
    other[p] = other_.data() + packets[p];
    owner[p] = owner_.data() + packets[p];
  }
  std::uint8_t covered[8];
  cover_all(closest, other, owner, closeness, covered);
  PacketSet out = 0;
  for (std::size_t p = 0; p < 8; ++p) out |= PacketSet{covered[p]} << p;
  return out;
}

void HitSheet::answer(int block_x, int block_y, const float* farthest, const float* cosines,
                      BlockAnswers& out) const {
  const std::array<std::size_t, 8> packets = packets_of(block_x, block_y);
  const float *closest[8], *other[8];
  for (std::size_t p = 0; p < 8; ++p) {
    closest[p] = closest_.data() + packets[p];
    other[p] = other_.data() + packets[p];
    out.owner[p] = owner_.data() + packets[p];
  }
  answer_all(closest, other, out.owner.data(), farthest, cosines, out.hit.data(), out.open.data());
}

}  // namespace probe::render
