#include "runtime/render/filled_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/render/clones.h"
#include "runtime/render/extremes.h"

namespace probe::render {
namespace {

constexpr std::size_t kMostTriangles = 512;  // beyond, the search costs more than the rays
constexpr float kRoom = 1.0f;                // pixels
// Edge values are products of unit vectors; those of rays are wrong by less than this.
constexpr float kDoubt = 1e-5f;
constexpr float kMostGrazing = 0.7f;  // least by greatest 1 / depth of a triangle in its block
constexpr float kBehindBlock = 0.999f;

struct Range {
  float low, high;
};

// Of a x + b y + c in a rectangle.
inline Range range(float a, float b, float c, float x0, float x1, float y0, float y1) {
  const float ax0 = a * x0, ax1 = a * x1, by0 = b * y0, by1 = b * y1;
  return {c + (ax0 < ax1 ? ax0 : ax1) + (by0 < by1 ? by0 : by1),
          c + (ax0 < ax1 ? ax1 : ax0) + (by0 < by1 ? by1 : by0)};
}


// `columns`: a, b, c of the first edge, of the second, of the third; then bounds x0, x1, y0, y1
// and how wrong an edge may be.
PROBE_CLONES void find_outside(const float* const* columns, std::size_t count, float x0, float x1,
                               float y0, float y1, std::uint8_t* __restrict outside) {
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
    const int beyond = is(range(a0[i], b0[i], c0[i], x0, x1, y0, y1).high < -doubt[i]) |
                       is(range(a1[i], b1[i], c1[i], x0, x1, y0, y1).high < -doubt[i]) |
                       is(range(a2[i], b2[i], c2[i], x0, x1, y0, y1).high < -doubt[i]);
    const int apart = is(left[i] > x1) | is(right[i] < x0) | is(top[i] > y1) | is(bottom[i] < y0);
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
  const double across = std::max(std::abs(camera.cx), std::abs(camera.width - camera.cx)) + 16;
  const double down = std::max(std::abs(camera.cy), std::abs(camera.height - camera.cy)) + 16;
  const double longest = std::sqrt(1 + across * across / (camera.fx * camera.fx) +
                                   down * down / (camera.fy * camera.fy));
  farthest_ = static_cast<float>(0.99 * kFarthest / longest);
  longest_ = static_cast<float>(longest);
  across_ = static_cast<float>(std::max(camera.fx, camera.fy));
  depth_doubt_ = kDistanceDoubt / longest_;
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
        const std::size_t before = triangles_.size();
        add(corners, doubt, camera);
        if (triangles_.size() == before) continue;
        names_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(p),
                          static_cast<std::uint32_t>(k)});
      }
    }
  }
  for (const Triangle& triangle : triangles_) {
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

void BlockFills::add(const Vec3 (&corners)[3], double doubt, const Camera& camera) {
  const Vec3 forward = camera.forward_left_up.col(0);
  const double z[3] = {forward.dot(corners[0]), forward.dot(corners[1]), forward.dot(corners[2])};
  const double nearest = std::min({z[0], z[1], z[2]});
  if (std::max({z[0], z[1], z[2]}) <= 0) return;  // behind the camera
  const Vec3 right = -camera.forward_left_up.col(1) / camera.fx;
  const Vec3 down = -camera.forward_left_up.col(2) / camera.fy;
  const Vec3 corner = forward - camera.cx * right - camera.cy * down;  // through pixel (0, 0)

  Triangle out{};
  out.bounds = {-kInfinite, kInfinite, -kInfinite, kInfinite};
  out.closest = kInfinite;
  if (nearest > 1e-3) {
    out.bounds = {kInfinite, -kInfinite, kInfinite, -kInfinite};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x =
          static_cast<float>(right.dot(corners[k]) * camera.fx * camera.fx / z[k] + camera.cx);
      const auto y =
          static_cast<float>(down.dot(corners[k]) * camera.fy * camera.fy / z[k] + camera.cy);
      out.bounds = {std::min(out.bounds.x0, x), std::max(out.bounds.x1, x),
                    std::min(out.bounds.y0, y), std::max(out.bounds.y1, y)};
    }
    out.closest = static_cast<float>(1 / nearest);
  }
  // det / depth is the sum of the three edges' products with the ray (forward part 1).
  const double det = corners[0].dot(corners[1].cross(corners[2]));
  const double sign = det < 0 ? -1 : 1;
  Vec3 sum = Vec3::Zero();
  double size = 1;
  for (std::size_t e = 0; e < 3; ++e) {
    const Vec3 &p = corners[(e + 1) % 3], &q = corners[(e + 2) % 3];
    const Vec3 edge = sign * p.cross(q);
    const double scale = 1 / std::max(p.norm() * q.norm(), 1e-12);
    out.a[e] = static_cast<float>(scale * edge.dot(right));
    out.b[e] = static_cast<float>(scale * edge.dot(down));
    out.c[e] = static_cast<float>(scale * edge.dot(corner));
    const double closer = std::max(std::min(p.norm(), q.norm()), 1e-6);
    out.touch[e] = kDoubt + static_cast<float>(2 * doubt * longest_ / closer);
    sum += edge;
    size *= p.norm();
  }
  out.doubt = static_cast<float>(doubt);
  const double flatness = std::abs(det) / std::max(size, 1e-12);
  out.thin = !(flatness > 2.0 * std::max({out.touch[0], out.touch[1], out.touch[2]}));
  // Of one seen from the side no more is known than its corners.
  out.closeness_c = kInfinite;
  if (std::abs(det) > 1e-6 * size) {
    sum /= std::abs(det);
    out.closeness_a = static_cast<float>(sum.dot(right));
    out.closeness_b = static_cast<float>(sum.dot(down));
    out.closeness_c = static_cast<float>(sum.dot(corner));
  }
  triangles_.push_back(out);
}

FilledBlocks BlockFills::of_tile(int tile_x, int tile_y) {
  FilledBlocks out;
  if (triangles_.empty()) return out;
  const auto left = static_cast<float>(kTileSide * tile_x) + 0.5f - kRoom;
  const auto top = static_cast<float>(kTileSide * tile_y) + 0.5f - kRoom;
  const auto extent = [](int side) { return static_cast<float>(side - 1) + 2 * kRoom; };
  const Rectangle tile{left, left + extent(kTileSide), top, top + extent(kTileSide)};
  const float* columns[14];
  for (std::size_t k = 0; k < columns_.size(); ++k) columns[k] = columns_[k].data();
  find_outside(columns, triangles_.size(), tile.x0, tile.x1, tile.y0, tile.y1, outside_.data());
  near_.clear();
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    if (outside_[k] == 0) near_.push_back(static_cast<std::uint32_t>(k));
  }
  if (near_.empty()) return out;
  if (const FilledBlock all = find(tile); all.filled) {
    out.fill(all);
    return out;
  }
  for (std::size_t block = 0; block < out.size(); ++block) {
    const float x = left + static_cast<float>(block % 2 * kBlockSide);
    const float y = top + static_cast<float>(block / 2 * kBlockSide);
    out[block] = find({x, x + extent(kBlockSide), y, y + extent(kBlockSide)});
  }
  return out;
}

KnownTriangles BlockFills::draw_rest(int tile_x, int tile_y, const FilledBlocks& filled) {
  if (near_.empty() || triangles_.empty()) return {};
  sheet_.resize(1, 1);
  for (std::size_t block = 0; block < filled.size(); ++block) {
    if (filled[block].filled) continue;
    const int x = static_cast<int>(block % 2), y = static_cast<int>(block / 2);
    sheet_.clear_block(x, y);
    const auto left = static_cast<float>(kTileSide * tile_x + kBlockSide * x) + 0.5f;
    const auto top = static_cast<float>(kTileSide * tile_y + kBlockSide * y) + 0.5f;
    draw_block({left, left + kBlockSide - 1, top, top + kBlockSide - 1}, 2 * x, 4 * y);
  }
  return {&sheet_, names_.data(), tile_x, tile_y};
}

// `left`, `top`: the block's first packet in the sheet.
void BlockFills::draw_block(const Rectangle& block, int left, int top) {
  TriangleBatch& out = *batch_;
  out.count = 0;
  for (const std::uint32_t number : near_) {
    const Triangle& triangle = triangles_[number];
    bool outside = triangle.bounds.x0 > block.x1 + kRoom || triangle.bounds.x1 < block.x0 - kRoom ||
                   triangle.bounds.y0 > block.y1 + kRoom || triangle.bounds.y1 < block.y0 - kRoom;
    for (std::size_t e = 0; e < 3 && !outside && !triangle.thin; ++e) {
      const Range edge = range(triangle.a[e], triangle.b[e], triangle.c[e], block.x0, block.x1,
                               block.y0, block.y1);
      outside = edge.high < -triangle.touch[e];
    }
    if (outside) continue;
    if (out.count == TriangleBatch::kSize) {
      sheet_.draw(out);
      out.count = 0;
    }
    const std::size_t i = out.count++;
    out.order[i] = static_cast<std::uint16_t>(i);
    out.triangle[i] = number;
    out.left[i] = left;
    out.top[i] = top;
    out.columns[i] = kBlockSide / 4;
    out.rows[i] = kBlockSide / 2;
    for (std::size_t e = 0; e < 3; ++e) {
      out.a[e][i] = triangle.thin ? 0 : triangle.a[e];
      out.b[e][i] = triangle.thin ? 0 : triangle.b[e];
      out.e[e][i] =
          triangle.thin ? 0 : triangle.c[e] + triangle.a[e] * block.x0 + triangle.b[e] * block.y0;
      out.touch[e][i] = triangle.touch[e];
    }
    const Range its = range(triangle.closeness_a, triangle.closeness_b, triangle.closeness_c,
                            block.x0, block.x1, block.y0, block.y1);
    const bool known = !triangle.thin && its.high < kInfinite;
    const float slope = std::abs(triangle.closeness_a) + std::abs(triangle.closeness_b);
    const float wrong = across_ * slope * (triangle.doubt * its.high + kDoubt) +
                        triangle.doubt * its.high * its.high;
    const bool solid = known && its.low > 0 && wrong < kDepthDoubt * its.low &&
                       wrong < depth_doubt_ * its.low * its.low && its.high < 0.5f / kNearest;
    out.solid[i] = is(solid);
    out.w[i] = !known ? kInfinite
                      : triangle.closeness_c + triangle.closeness_a * block.x0 +
                            triangle.closeness_b * block.y0 + (solid ? 0 : std::abs(wrong));
    out.wx[i] = known ? triangle.closeness_a : 0;
    out.wy[i] = known ? triangle.closeness_b : 0;
  }
  sheet_.draw(out);
}

FilledBlock BlockFills::find(const Rectangle& block) const {
  const auto in_block = [&block](float a, float b, float c) {
    return range(a, b, c, block.x0, block.x1, block.y0, block.y1);
  };
  const Triangle* front = nullptr;
  Range closeness{0, 0};
  for (const std::uint32_t k : near_) {
    const Triangle& triangle = triangles_[k];
    bool covers = true;
    for (std::size_t e = 0; e < 3 && covers; ++e) {
      covers = in_block(triangle.a[e], triangle.b[e], triangle.c[e]).low > kDoubt;
    }
    if (!covers) continue;
    const Range own = in_block(triangle.closeness_a, triangle.closeness_b, triangle.closeness_c);
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
    const Triangle& other = triangles_[k];
    if (&other == front) continue;
    if (other.closest < kBehindBlock * closeness.low) continue;
    const Range its = in_block(other.closeness_a, other.closeness_b, other.closeness_c);
    if (its.high < kBehindBlock * closeness.low) continue;
    bool outside = false;
    for (std::size_t e = 0; e < 3 && !outside; ++e) {
      outside = in_block(other.a[e], other.b[e], other.c[e]).high < -kDoubt;
    }
    outside = outside || other.bounds.x0 > block.x1 || other.bounds.x1 < block.x0 ||
              other.bounds.y0 > block.y1 || other.bounds.y1 < block.y0;
    if (!outside) return {};
  }
  return {true, names_[static_cast<std::size_t>(front - triangles_.data())]};
}

}  // namespace probe::render
