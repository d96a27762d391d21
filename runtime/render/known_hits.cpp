#include "runtime/render/known_hits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "runtime/render/clones.h"
#include "runtime/render/extremes.h"

namespace probe::render {
namespace {

constexpr float kEmbreeDoubt = static_cast<float>(kPlaceDoubt);
// Eight roundings of 6e-8 in the projection, twice.
constexpr float kProjectionDoubt = 1e-6f;
// Roundings of an edge's value, by the greatest coordinate of a vertex.
constexpr float kEdgeDoubt = 4e-7f;
// A triangle so thin that rounding can turn it over is doubtful along its line, also beyond its
// ends, pixels.
constexpr float kThinRoom = 16.0f;

// Setting up and drawing this many triangles costs as much as tracing a packet of rays.
constexpr std::size_t kTrianglesForPacket = 2;

enum Kind : std::int32_t { kUnseen, kDrawn, kDoubtful };

// The packets that hold samples from `low` to `high` pixels, of a side that ends at `last`.
struct Span {
  std::int32_t first, count;  // no more than 0: none
};
inline Span packets_between(float low, float high, float last, std::int32_t side) {
  // Sample i lies at i + 0.5. Cut as floats: a far-away triangle's pixels do not fit an int.
  const float from = least(greatest(low - 0.5f, 0.0f), last + 1);
  const float to = greatest(least(high - 0.5f, last), -1.0f);
  const auto first = static_cast<std::int32_t>(std::ceil(from));
  const auto end = static_cast<std::int32_t>(std::floor(to));
  return {first / side, end < first ? 0 : end / side - first / side + 1};
}

// How wrong places in the picture may be, pixels; coordinates go up to `widest`.
inline float room_at(float closeness, float widest, const TriangleLimits& limits) {
  return (limits.pixels + limits.grows * widest) * closeness + kEdgeDoubt * widest;
}

// Sets up `count` triangles whose vertices are `index`, with a Kind each. Those that are doubtful
// all over, being too near, too far out or too thin, are left to the caller.
PROBE_CLONES void set_up(const std::uint32_t* __restrict index, std::size_t count,
                         const float* __restrict px, const float* __restrict py,
                         const float* __restrict pz, const float* __restrict pw,
                         const TriangleLimits& given, TriangleBatch& __restrict out,
                         std::int32_t* __restrict kind) {
  const TriangleLimits limits = given;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t v0 = index[3 * i], v1 = index[3 * i + 1], v2 = index[3 * i + 2];
    const float x0 = px[v0], x1 = px[v1], x2 = px[v2];
    const float y0 = py[v0], y1 = py[v1], y2 = py[v2];
    const float w0 = pw[v0], w1 = pw[v1], w2 = pw[v2];
    const float nearest_z = least(pz[v0], pz[v1], pz[v2]);
    const float farthest_z = greatest(pz[v0], pz[v1], pz[v2]);
    const float closest = greatest(w0, w1, w2), farthest = least(w0, w1, w2);
    const float left = least(x0, x1, x2), right = greatest(x0, x1, x2);
    const float top = least(y0, y1, y2), bottom = greatest(y0, y1, y2);
    const float room = room_at(
        closest,
        greatest(greatest(-left, right, -top), greatest(bottom, limits.max_x, limits.max_y)),
        limits);

    const float area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0);
    const float sign = area < 0 ? -1.0f : 1.0f;
    const float size = sign * area;
    const float a0 = sign * (y1 - y2), b0 = sign * (x2 - x1);
    const float a1 = sign * (y2 - y0), b1 = sign * (x0 - x2);
    const float a2 = sign * (y0 - y1), b2 = sign * (x1 - x0);
    // At least the sides' lengths.
    const float side0 = std::abs(a0) + std::abs(b0), side1 = std::abs(a1) + std::abs(b1),
                side2 = std::abs(a2) + std::abs(b2);
    const float longest = greatest(side0, side1, side2);
    // Strips round the lines of two sides meet beyond the corner between them.
    const float beyond = room + room * longest * longest / size;
    const Span across = packets_between(left - beyond, right + beyond, limits.max_x, 4);
    const Span down = packets_between(top - beyond, bottom + beyond, limits.max_y, 2);
    const float from_x = static_cast<float>(4 * across.first) + 0.5f;
    const float from_y = static_cast<float>(2 * down.first) + 0.5f;

    const float scale = 1.0f / size;
    const float wx = (a0 * w0 + a1 * w1 + a2 * w2) * scale;
    const float wy = (b0 * w0 + b1 * w1 + b2 * w2) * scale;
    const float w = w0 + wx * (from_x - x0) + wy * (from_y - y0);
    const float wrong = room * (std::abs(wx) + std::abs(wy)) + limits.distance * closest * closest;
    const std::int32_t solid =
        is(wrong < kDepthDoubt * farthest) & is(wrong < limits.depth * farthest * farthest);
    // Slopes of a thin one are lost in rounding.
    const float rounded = kProjectionDoubt * closest * longest * longest / size;
    const std::int32_t fine = is(wrong + rounded < kFineDoubt * farthest);

    out.a[0][i] = a0;
    out.a[1][i] = a1;
    out.a[2][i] = a2;
    out.b[0][i] = b0;
    out.b[1][i] = b1;
    out.b[2][i] = b2;
    out.e[0][i] = a0 * (from_x - x1) + b0 * (from_y - y1);
    out.e[1][i] = a1 * (from_x - x2) + b1 * (from_y - y2);
    out.e[2][i] = a2 * (from_x - x0) + b2 * (from_y - y0);
    out.touch[0][i] = room * side0;
    out.touch[1][i] = room * side1;
    out.touch[2][i] = room * side2;
    out.w[i] = w + wrong;
    out.wx[i] = wx;
    out.wy[i] = wy;
    out.left[i] = across.first;
    out.top[i] = down.first;
    out.columns[i] = across.count;
    out.rows[i] = down.count;
    out.most[i] = closest + wrong;
    out.solid[i] = solid;
    out.fine[i] = fine;

    const std::int32_t untrusted = is(nearest_z < 2 * kNearest) | is(left < -limits.widest) |
                                   is(right > limits.widest) | is(top < -limits.widest) |
                                   is(bottom > limits.widest) | is(!(size > room * longest));
    const std::int32_t inside = is(across.count > 0) & is(down.count > 0);
    const std::int32_t seen = untrusted != 0 ? kDoubtful : inside != 0 ? kDrawn : kUnseen;
    kind[i] = farthest_z > limits.nearest ? seen : kUnseen;
  }
}

}  // namespace

void KnownHits::name_all(const std::vector<Instance>& instances) {
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const auto& parts = instances[i].geometry->parts;
    first_.push_back(static_cast<std::uint32_t>(names_.size()));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      parts_.push_back({instance_bit(i), parts[p].triangles.size()});
      for (std::size_t k = 0; k < parts[p].triangles.size(); ++k) {
        names_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(p),
                          static_cast<std::uint32_t>(k)});
      }
    }
  }
}

// What is near first: it hides much of the rest, which then need not be drawn. What the sheet says
// does not depend on the order.
void KnownHits::order(const std::vector<Instance>& instances, const Camera& camera) {
  turns_.clear();
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if ((wanted_ & instance_bit(i)) == 0) continue;
    const Vec3 from_eye = instances[i].exact_translation - camera.position;
    turns_.push_back({static_cast<float>(camera.forward_left_up.col(0).dot(from_eye)),
                      static_cast<std::uint32_t>(i)});
  }
  std::sort(turns_.begin(), turns_.end(), [](const Turn& a, const Turn& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.instance < b.instance;
  });
}

void KnownHits::limit(const Instance& instance, const MeshGeometry::Part& part,
                      const Projection& projection, const Camera& camera) {
  const float* t = instance.translation;
  const float placed = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
  const auto eye = static_cast<float>(camera.position.norm());
  float sums[3];  // of what is added up for x z, y z and z
  for (int r = 0; r < 3; ++r) {
    const float* row = projection.rows + 4 * r;
    sums[r] =
        (std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2])) * part.reach + std::abs(row[3]);
  }
  limits_.distance = kEmbreeDoubt * (placed + eye + 2 * part.reach);
  limits_.pixels = limits_.distance * static_cast<float>(std::max(camera.fx, camera.fy)) +
                   kProjectionDoubt * (sums[0] + sums[1]);
  limits_.grows = 2 * kProjectionDoubt * sums[2];
}

KnownTriangles KnownHits::look(const std::vector<Instance>& instances, const Camera& camera,
                               const CameraRays& rays, const BlockMarks& marks) {
  if (names_.empty()) name_all(instances);
  if (!is_worth_it(marks)) return {};
  limits_.nearest = 0.99f * rays.nearest_depth;  // as BlockMarks has it
  limits_.widest = 4.0f * static_cast<float>(std::max(rays.width, rays.height));
  limits_.max_x = static_cast<float>(rays.width - 1);
  limits_.max_y = static_cast<float>(rays.height - 1);
  limits_.depth = kDistanceDoubt * rays.nearest_depth / kNearest;
  cones_ = ConeView(camera);
  sheet_.resize(rays.tiles_x, rays.tiles_y);
  for (int y = 0; y < marks.blocks_y(); ++y) {
    for (int x = 0; x < marks.blocks_x(); ++x) {
      if (is_drawn(marks.touching(x, y))) sheet_.clear_block(x, y);
    }
  }
  order(instances, camera);
  for (const Turn& turn : turns_) {
    const Instance& instance = instances[turn.instance];
    const Projection projection = projection_of(instance, camera);
    std::uint32_t number = first_[turn.instance];
    for (const MeshGeometry::Part& part : instance.geometry->parts) {
      part_.project(part, projection);
      limit(instance, part, projection, camera);
      draw(instance, part, number, marks, instance_bit(turn.instance));
      number += static_cast<std::uint32_t>(part.triangles.size());
    }
  }
  flush_doubtful();
  return {&sheet_, names_.data(), 0, 0, rest_};
}

// Chooses what is drawn: all that is marked, but for instances of so many triangles in so few
// packets that rays are cheaper; these have their blocks to themselves.
bool KnownHits::is_worth_it(const BlockMarks& marks) {
  constexpr std::size_t kBits = 8 * sizeof(InstanceSet);
  std::array<std::size_t, kBits> triangles{};
  for (const Range& range : parts_)
    triangles[static_cast<std::size_t>(std::countr_zero(range.bit))] += range.count;
  rest_ = 0;
  for (;;) {
    wanted_ = 0;
    std::size_t packets = 0, drawn = 0;
    std::array<std::size_t, kBits> its_packets{};
    for (int y = 0; y < marks.blocks_y(); ++y) {
      for (int x = 0; x < marks.blocks_x(); ++x) {
        const InstanceSet set = marks.touching(x, y);
        if (!is_drawn(set)) continue;
        wanted_ |= set;
        packets += 8;
        for (InstanceSet left = set; left != 0; left &= left - 1)
          its_packets[static_cast<std::size_t>(std::countr_zero(left))] += 8;
      }
    }
    if (wanted_ == 0) return false;
    std::size_t densest = kBits;
    for (InstanceSet left = wanted_; left != 0; left &= left - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(left));
      drawn += triangles[bit];
      if (densest == kBits ||
          triangles[bit] * its_packets[densest] > triangles[densest] * its_packets[bit])
        densest = bit;
    }
    if (kTrianglesForPacket * packets > drawn) return true;
    rest_ |= InstanceSet{1} << densest;
  }
}

// Whether a triangle of a batch lies in a marked block and is not hidden.
bool KnownHits::is_asked(const TriangleBatch& batch, std::size_t i, const BlockMarks& marks,
                         InstanceSet bit) {
  const int x0 = batch.left[i] / 2, x1 = (batch.left[i] + batch.columns[i] - 1) / 2;
  const int y0 = batch.top[i] / 4, y1 = (batch.top[i] + batch.rows[i] - 1) / 4;
  return marks.any(x0, y0, x1, y1, bit) && !sheet_.hides(x0, y0, x1, y1, batch.most[i]);
}

void KnownHits::draw(const Instance& instance, const MeshGeometry::Part& part, std::uint32_t number,
                     const BlockMarks& marks, InstanceSet bit) {
  std::array<std::int32_t, TriangleBatch::kSize> kind;
  TriangleBatch& batch = *batch_;
  const std::size_t all = part.triangles.size();
  for (std::size_t first = 0; first < all; first += TriangleBatch::kSize) {
    const std::size_t count = std::min(all - first, TriangleBatch::kSize);
    set_up(part.indices.data() + 3 * first, count, part_.x(), part_.y(), part_.depth(),
           part_.closeness(), limits_, batch, kind.data());
    batch.count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (kind[i] == kUnseen) continue;
      if (kind[i] == kDoubtful) {
        add_doubtful(instance, part, 3 * (first + i),
                     number + static_cast<std::uint32_t>(first + i), marks, bit);
        continue;
      }
      batch.triangle[i] = number + static_cast<std::uint32_t>(first + i);
      if (is_asked(batch, i, marks, bit))
        batch.order[batch.count++] = static_cast<std::uint16_t>(i);
    }
    sheet_.draw(batch);
  }
}

// One that is near or far out, block by block. False if it is too thin for that.
bool KnownHits::add_cone(const Instance& instance, const MeshGeometry::Part& part,
                         std::size_t index, const PixelBounds& bounds, std::uint32_t number,
                         const BlockMarks& marks, InstanceSet bit) {
  const Vec3 offset = instance.exact_translation - cones_.eye;
  Vec3 corners[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = part.indices[index + k];
    corners[k] = instance.exact_rotation * Vec3(part.x[v], part.y[v], part.z[v]) + offset;
  }
  const double doubt = kPlaceDoubt * (instance.exact_translation.norm() + cones_.eye.norm() +
                                      2.0 * static_cast<double>(part.reach));
  ConeTriangle cone;
  if (!ConeTriangle::make(corners, doubt, cones_, cone)) return true;
  if (cone.thin) return false;
  const auto block = [](float at, float last) {
    return static_cast<int>(least(greatest(at, 0.0f), last)) / kBlockSide;
  };
  const int left = block(bounds.min_x - kConeRoom, limits_.max_x),
            right = block(bounds.max_x + kConeRoom, limits_.max_x),
            top = block(bounds.min_y - kConeRoom, limits_.max_y),
            bottom = block(bounds.max_y + kConeRoom, limits_.max_y);
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      if ((marks.touching(x, y) & bit) == 0) continue;
      const float x0 = static_cast<float>(kBlockSide * x) + 0.5f,
                  y0 = static_cast<float>(kBlockSide * y) + 0.5f;
      const PixelRectangle samples{x0, x0 + kBlockSide - 1, y0, y0 + kBlockSide - 1};
      if (!cone.may_meet(samples)) continue;
      if (doubtful_->count == TriangleBatch::kSize) flush_doubtful();
      cone.put(samples, {2 * x, 4 * y, kBlockSide / 4, kBlockSide / 2}, cones_, number, *doubtful_);
    }
  }
  return true;
}

// One that is near, far out or thin: a ray has to tell wherever it may be, but for what its cone
// tells.
void KnownHits::add_doubtful(const Instance& instance, const MeshGeometry::Part& part,
                             std::size_t index, std::uint32_t number, const BlockMarks& marks,
                             InstanceSet bit) {
  PixelBounds bounds;
  if (!part_.bounds(part, index, limits_.nearest, bounds)) return;
  const std::uint32_t* v = part.indices.data() + index;
  const float x[3] = {part_.x()[v[0]], part_.x()[v[1]], part_.x()[v[2]]};
  const float y[3] = {part_.y()[v[0]], part_.y()[v[1]], part_.y()[v[2]]};
  const float *depth = part_.depth(), *closeness = part_.closeness();
  const bool near = least(depth[v[0]], depth[v[1]], depth[v[2]]) < 2 * kNearest ||
                    bounds.min_x < -limits_.widest || bounds.max_x > limits_.widest ||
                    bounds.min_y < -limits_.widest || bounds.max_y > limits_.widest;
  if (near && add_cone(instance, part, index, bounds, number, marks, bit)) return;
  const float beyond = near ? 1 : kThinRoom;
  const Span across =
      packets_between(bounds.min_x - beyond, bounds.max_x + beyond, limits_.max_x, 4);
  const Span down = packets_between(bounds.min_y - beyond, bounds.max_y + beyond, limits_.max_y, 2);
  if (across.count <= 0 || down.count <= 0) return;

  TriangleBatch& out = *doubtful_;
  if (out.count == TriangleBatch::kSize) flush_doubtful();
  const std::size_t i = out.count++;
  out.order[i] = static_cast<std::uint16_t>(i);
  out.left[i] = across.first;
  out.top[i] = down.first;
  out.columns[i] = across.count;
  out.rows[i] = down.count;
  out.solid[i] = out.fine[i] = 0;
  out.triangle[i] = 0;
  out.w[i] = kInfinite;
  out.wx[i] = out.wy[i] = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    out.a[k][i] = out.b[k][i] = out.e[k][i] = 0;
    out.touch[k][i] = 1;
  }
  if (near) return;
  // Near the line of its longest side, on either side of it.
  float longest = -1;
  const float from_x = static_cast<float>(4 * across.first) + 0.5f;
  const float from_y = static_cast<float>(2 * down.first) + 0.5f;
  const float room =
      room_at(greatest(closeness[v[0]], closeness[v[1]], closeness[v[2]]), limits_.widest, limits_);
  for (std::size_t p = 0; p < 3; ++p) {
    const std::size_t q = (p + 1) % 3;
    const float a = y[p] - y[q], b = x[q] - x[p];
    const float length = std::abs(a) + std::abs(b);
    if (!(length > longest)) continue;
    longest = length;
    const float e = a * (from_x - x[p]) + b * (from_y - y[p]);
    for (std::size_t k = 0; k < 2; ++k) {
      const float side = k == 0 ? 1.0f : -1.0f;
      out.a[k][i] = side * a;
      out.b[k][i] = side * b;
      out.e[k][i] = side * e;
      out.touch[k][i] = 3 * room * length;
    }
  }
}

void KnownHits::flush_doubtful() {
  sheet_.draw(*doubtful_);
  doubtful_->count = 0;
}

}  // namespace probe::render
