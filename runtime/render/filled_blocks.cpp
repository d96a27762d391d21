#include "runtime/render/filled_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/render/clones.h"
#include "runtime/render/extremes.h"

namespace probe::render {
namespace {

constexpr std::size_t kMostTriangles = 512;  // beyond, the search costs more than the rays
constexpr float kMostGrazing = 0.7f;  // least by greatest 1 / depth of a triangle in its block
constexpr float kBehindBlock = 0.999f;

// `columns`: a, b, c of the first edge, of the second, of the third; then bounds x0, x1, y0, y1
// and how wrong an edge may be.
PROBE_CLONES void find_outside(const float* const* columns, std::size_t count,
                               const PixelRectangle& rectangle, std::uint8_t* __restrict outside) {
  const PixelRectangle in = rectangle;
  const float* __restrict a0 = columns[0];
  const float* __restrict b0 = columns[1];
  const float* __restrict c0 = columns[2];
  const float* __restrict a1 = columns[3];
  const float* __restrict b1 = columns[4];
  const float* __restrict c1 = columns[5];
  const float* __restrict a2 = columns[6];
  const float* __restrict b2 = columns[7];
  const float* __restrict c2 = columns[8];
  const float* __restrict left = columns[9];
  const float* __restrict right = columns[10];
  const float* __restrict top = columns[11];
  const float* __restrict bottom = columns[12];
  const float* __restrict doubt = columns[13];
  for (std::size_t i = 0; i < count; ++i) {
    // Numbers and not truths: no branch, and clang asks for && of truths.
    const int beyond = is(range_in(in, a0[i], b0[i], c0[i]).high < -doubt[i]) |
                       is(range_in(in, a1[i], b1[i], c1[i]).high < -doubt[i]) |
                       is(range_in(in, a2[i], b2[i], c2[i]).high < -doubt[i]);
    const int apart =
        is(left[i] > in.x1) | is(right[i] < in.x0) | is(top[i] > in.y1) | is(bottom[i] < in.y0);
    outside[i] = static_cast<std::uint8_t>(beyond | apart);
  }
}

}  // namespace

void BlockFills::look(const TopScene& scene, const Camera& camera) {
  triangles_.clear();
  names_.clear();
  for (auto& column : columns_) column.clear();
  std::size_t count = 0;
  for (const Instance& instance : scene.instances()) {
    for (const MeshGeometry::Part& part : instance.geometry->parts) count += part.triangles.size();
  }
  if (count > kMostTriangles) return;
  view_ = ConeView(camera);
  farthest_ = 0.99f * kFarthest / view_.longest;
  for (std::size_t i = 0; i < scene.instances().size(); ++i) {
    const Instance& instance = scene.instances()[i];
    const Vec3 offset = instance.exact_translation - camera.position;
    for (std::size_t p = 0; p < instance.geometry->parts.size(); ++p) {
      const MeshGeometry::Part& part = instance.geometry->parts[p];
      const double doubt = kPlaceDoubt * (instance.exact_translation.norm() +
                                          camera.position.norm() + 2.0 * part.reach);
      for (std::size_t k = 0; k < part.triangles.size(); ++k) {
        Vec3 corners[3];
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t v = part.indices[3 * k + c];
          corners[c] = instance.exact_rotation * Vec3(part.x[v], part.y[v], part.z[v]) + offset;
        }
        ConeTriangle cone;
        if (!ConeTriangle::make(corners, doubt, view_, cone)) continue;
        triangles_.push_back(cone);
        names_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(p),
                          static_cast<std::uint32_t>(k)});
      }
    }
  }
  for (const ConeTriangle& triangle : triangles_) {
    for (std::size_t e = 0; e < 3; ++e) {
      columns_[3 * e].push_back(triangle.a[e]);
      columns_[3 * e + 1].push_back(triangle.b[e]);
      columns_[3 * e + 2].push_back(triangle.c[e]);
    }
    columns_[9].push_back(triangle.bounds.x0);
    columns_[10].push_back(triangle.bounds.x1);
    columns_[11].push_back(triangle.bounds.y0);
    columns_[12].push_back(triangle.bounds.y1);
    columns_[13].push_back(std::max({triangle.touch[0], triangle.touch[1], triangle.touch[2]}));
  }
  outside_.resize(triangles_.size());
}

namespace {

// From the first sample to the last of so many, with room.
float extent(int side) { return static_cast<float>(side - 1) + 2 * kConeRoom; }

}  // namespace

PixelRectangle BlockFills::rectangle_of(int tile_x, int tile_y) {
  const auto left = static_cast<float>(kTileSide * tile_x) + 0.5f - kConeRoom;
  const auto top = static_cast<float>(kTileSide * tile_y) + 0.5f - kConeRoom;
  return {left, left + extent(kTileSide), top, top + extent(kTileSide)};
}

float BlockFills::closest(int tile_x, int tile_y) const {
  constexpr float kMore = 1.001f;  // than what rounding and doubts add
  if (triangles_.empty()) return kInfinite;
  const PixelRectangle tile = rectangle_of(tile_x, tile_y);
  float most = view_.longest / kFarthest;
  for (const std::uint32_t k : near_) {
    const ConeTriangle& triangle = triangles_[k];
    const float by_plane =
        triangle.thin
            ? kInfinite
            : range_in(tile, triangle.closeness_a, triangle.closeness_b, triangle.closeness_c).high;
    most = std::max(most, std::min(by_plane, triangle.closest));
  }
  return kMore * most;
}

FilledBlocks BlockFills::of_tile(int tile_x, int tile_y) {
  FilledBlocks out;
  near_.clear();
  if (triangles_.empty()) return out;
  const PixelRectangle tile = rectangle_of(tile_x, tile_y);
  const float* columns[14];
  for (std::size_t k = 0; k < columns_.size(); ++k) columns[k] = columns_[k].data();
  find_outside(columns, triangles_.size(), tile, outside_.data());
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    if (outside_[k] == 0) near_.push_back(static_cast<std::uint32_t>(k));
  }
  if (near_.empty()) return out;
  if (const FilledBlock all = find(tile); all.filled) {
    out.fill(all);
    return out;
  }
  for (std::size_t block = 0; block < out.size(); ++block) {
    const float x = tile.x0 + static_cast<float>(block % 2 * kBlockSide);
    const float y = tile.y0 + static_cast<float>(block / 2 * kBlockSide);
    out[block] = find({x, x + extent(kBlockSide), y, y + extent(kBlockSide)});
  }
  return out;
}

KnownTriangles BlockFills::draw_rest(int tile_x, int tile_y, const FilledBlocks& filled,
                                     PacketSet hidden) {
  if (near_.empty() || triangles_.empty()) return {};
  sheet_.resize(1, 1);
  for (std::size_t block = 0; block < filled.size(); ++block) {
    if (filled[block].filled || (hidden >> (8 * block) & 0xFF) == 0xFF) continue;
    const int x = static_cast<int>(block % 2), y = static_cast<int>(block / 2);
    sheet_.clear_block(x, y);
    const auto left = static_cast<float>(kTileSide * tile_x + kBlockSide * x) + 0.5f;
    const auto top = static_cast<float>(kTileSide * tile_y + kBlockSide * y) + 0.5f;
    draw_block({left, left + kBlockSide - 1, top, top + kBlockSide - 1}, 2 * x, 4 * y);
  }
  return {&sheet_, names_.data(), tile_x, tile_y, 0};
}

// `left`, `top`: the block's first packet in the sheet.
void BlockFills::draw_block(const PixelRectangle& block, int left, int top) {
  TriangleBatch& out = *batch_;
  out.count = 0;
  for (const std::uint32_t number : near_) {
    const ConeTriangle& triangle = triangles_[number];
    if (!triangle.may_meet(block)) continue;
    if (out.count == TriangleBatch::kSize) {
      sheet_.draw(out);
      out.count = 0;
    }
    triangle.put(block, {left, top, kBlockSide / 4, kBlockSide / 2}, view_, number, out);
  }
  sheet_.draw(out);
}

FilledBlock BlockFills::find(const PixelRectangle& block) const {
  const auto in_block = [&block](float a, float b, float c) { return range_in(block, a, b, c); };
  const ConeTriangle* front = nullptr;
  ValueRange closeness{0, 0};
  for (const std::uint32_t k : near_) {
    const ConeTriangle& triangle = triangles_[k];
    bool covers = true;
    for (std::size_t e = 0; e < 3 && covers; ++e) {
      covers = in_block(triangle.a[e], triangle.b[e], triangle.c[e]).low > kConeDoubt;
    }
    if (!covers) continue;
    const ValueRange own =
        in_block(triangle.closeness_a, triangle.closeness_b, triangle.closeness_c);
    if (own.low > closeness.low) {
      front = &triangle;
      closeness = own;
    }
  }
  // In reach of rays all over, and seen well enough that rays and refine_run() agree.
  if (front == nullptr || !(closeness.low > kMostGrazing * closeness.high) ||
      !(closeness.high < 0.5f / kNearest) || !(closeness.low * farthest_ > 1)) {
    return {};
  }
  for (const std::uint32_t k : near_) {
    const ConeTriangle& other = triangles_[k];
    if (&other == front) continue;
    if (other.closest < kBehindBlock * closeness.low) continue;
    const ValueRange its = in_block(other.closeness_a, other.closeness_b, other.closeness_c);
    if (its.high < kBehindBlock * closeness.low) continue;
    bool outside = false;
    for (std::size_t e = 0; e < 3 && !outside; ++e) {
      outside = in_block(other.a[e], other.b[e], other.c[e]).high < -kConeDoubt;
    }
    outside = outside || other.bounds.x0 > block.x1 || other.bounds.x1 < block.x0 ||
              other.bounds.y0 > block.y1 || other.bounds.y1 < block.y0;
    if (!outside) return {};
  }
  return {true, names_[static_cast<std::size_t>(front - triangles_.data())]};
}

}  // namespace probe::render
