// Triangles drawn into a sheet of closeness a sample: where one of them is clearly hit and clearly
// before all others, a ray could only say the same. Conservative, hence exact: what is doubtful is
// left to rays.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/instance_set.h"

namespace probe::render {

// Of two triangles the second is clearly behind if it is less close than this part of the first.
inline constexpr float kClearlyBehind = 0.997f;

// How far what is drawn and what Embree finds may be apart, and still be told apart from another
// triangle's. Embree turns a ray into the mesh's frame and tests it there, all in single precision:
// places are wrong by at most about 1e-6 of the distances that take part, the camera's and the
// instance's from the world's origin. Three times that.
inline constexpr double kPlaceDoubt = 3e-6;
// Closeness is wrong by less than this part of itself, so that two are well within kClearlyBehind
// ...
inline constexpr float kDepthDoubt = 7e-4f;
static_assert(1 - 2 * kDepthDoubt > kClearlyBehind);
// ... or, as of most triangles, by less than this one, and what is less close than so much of it is
// clearly behind: the lining of a drawer, half a millimetre beneath its board.
inline constexpr float kFineDoubt = 2e-4f, kFinelyBehind = 0.9994f;
static_assert(1 - 2 * kFineDoubt > kFinelyBehind);
// ... and the distance along a ray by less than this, m: Embree's and ours then agree within the
// millimetre that TileTracer's refine() asks for.
inline constexpr float kDistanceDoubt = 3e-4f;

// Triangles as they are drawn, an array a quantity. A sample (x, y) pixels from the first sample of
// the first packet is touched where all three a x + b y + e are at least -touch, and inside, of a
// triangle that is `solid`, where they exceed touch. Closeness, 1 / depth, is at most w + wx x +
// wy y there; of one that is solid also at least that but for twice kDepthDoubt, and of one that is
// `fine`, too, but for twice kFineDoubt of it.
struct TriangleBatch {
  static constexpr std::size_t kSize = 256;
  using Floats = std::array<float, kSize>;
  using Ints = std::array<std::int32_t, kSize>;
  alignas(64) std::array<Floats, 3> a, b, e, touch;
  alignas(64) Floats w, wx, wy;
  alignas(64) Floats most;  // closeness anywhere; only of those that hides() is asked about
  alignas(64) Ints left, top, columns, rows;  // packets of 4 x 2 samples
  alignas(64) Ints solid, fine;
  alignas(64) std::array<std::uint32_t, kSize> triangle;  // its number
  // Those to draw.
  std::array<std::uint16_t, kSize> order;
  std::size_t count = 0;
};

// Of the 64 samples of a block, a byte each.
struct BlockAnswers {
  alignas(64) std::array<std::uint8_t, 64> hit;   // 1: meets the sheet's triangle
  alignas(64) std::array<std::uint8_t, 64> open;  // 1: only a ray can tell
  std::array<const std::uint32_t*, 8> owner;      // of a packet's eight samples

  // Of the 8 samples of a packet.
  bool settled(std::size_t packet) const;
  // The sheet's number of the triangle that a sample meets.
  std::uint32_t triangle(std::size_t packet, std::size_t sample) const {
    return owner[packet][sample] >> 1;
  }
};

// Of a tile's 32 packets, in sample order.
using PacketSet = std::uint32_t;

class HitSheet {
 public:
  // What is in it counts only where it is cleared.
  void resize(int tiles_x, int tiles_y);
  void clear_block(int x, int y);
  void draw(const TriangleBatch& batch);
  // Whether something no closer than that, in a rectangle of blocks, both ends included, is clearly
  // behind the foremost triangles of all samples there: it says nothing that is asked. False also
  // of many blocks.
  bool hides(int x0, int y0, int x1, int y1, float closeness);
  // Of a block of the sheet; nothing beyond `farthest` along each of its rays, whose cosines
  // (camera_rays.h) are given too, is of interest.
  void answer(int block_x, int block_y, const float* farthest, const float* cosines,
              BlockAnswers& out) const;
  // Which of a block's eight packets show the sheet's triangles in all their samples, whatever
  // there is besides, as long as it is no closer than that.
  PacketSet covers(int block_x, int block_y, float closeness) const;

 private:
  std::size_t packet_at(int x, int y) const {
    return 8 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(packets_x_) +
                static_cast<std::size_t>(x));
  }

  std::size_t block_at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(packets_x_ / 2) +
           static_cast<std::size_t>(x);
  }
  // Where a block's packets begin.
  std::array<std::size_t, 8> packets_of(int block_x, int block_y) const;

  int packets_x_ = 0;
  // A sample each, packets row by row: closeness of the foremost triangle that it is inside of, of
  // the foremost other one that it touches, both at most, and of the first twice its number, and 1
  // where that one is fine.
  std::vector<float> closest_, other_;
  std::vector<std::uint32_t> owner_;
  // A packet each: what is less close is clearly behind all its samples' foremost triangles, and
  // says nothing that is asked.
  std::vector<float> hidden_;
  // The least of those of a block, and whether that has to be looked up again.
  std::vector<float> block_hidden_;
  std::vector<std::uint8_t> changed_;
};

struct TriangleName {
  std::uint32_t instance = 0, part = 0, primitive = 0;
};

// A sheet that begins at a tile of the picture, and what its triangles' numbers mean.
struct KnownTriangles {
  const HitSheet* sheet = nullptr;  // null: nothing is known
  const TriangleName* names = nullptr;
  int tile_x = 0, tile_y = 0;
  InstanceSet rest = 0;  // blocks that these touch are not in it

  bool has(InstanceSet block) const { return sheet != nullptr && (block & rest) == 0; }
};

}  // namespace probe::render
