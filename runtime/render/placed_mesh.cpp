#include "runtime/render/placed_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "runtime/render/clones.h"
#include "runtime/render/extremes.h"
#include "runtime/render/placing_check.h"
#include "runtime/render/seen_triangles.h"

namespace probe::render {
namespace {

constexpr float kMostSubpixels = 134217728.0f;  // 2^27
static_assert(MeshClusters::kMostTriangles <= SmallTriangles::kMost);
constexpr float kBehindEye = -1;  // the nearness of what has to be cut

inline std::int32_t subpixel(float pixels) {
  const float at = pixels * static_cast<float>(kSubpixels);
  const float kept = at < -kMostSubpixels  ? -kMostSubpixels
                     : at > kMostSubpixels ? kMostSubpixels
                                           : at;
  return static_cast<std::int32_t>(std::floor(kept + 0.5f));
}

// How far from a ball's middle what it holds may lie, with room for rounding.
inline float room_of(const Ball& ball) { return ball.radius * 1.001f + 1e-5f; }

struct CornerView {
  std::array<float, 9> turn;
  std::array<float, 3> shift;
  float fx, fy, cx, cy;
};

// Places of a cluster as they are drawn, and the box around them.
struct SeenPlaces {
  static constexpr std::size_t kMost = MeshClusters::kMostPlaces;
  std::array<std::int32_t, kMost> x, y;
  std::array<float, kMost> nearness;
  std::int32_t left = 0, right = 0, top = 0, bottom = 0;
  float nearest = 0;
  bool is_cut = false;  // some lie before the nearest depth
};

PROBE_CLONES void view_places(const float* __restrict x, const float* __restrict y,
                              const float* __restrict z, std::size_t count, const CornerView& by,
                              SeenPlaces& __restrict out) {
  const CornerView p = by;
  std::int32_t* __restrict across = out.x.data();
  std::int32_t* __restrict down = out.y.data();
  float* __restrict nearness = out.nearness.data();
  std::int32_t x0 = std::numeric_limits<std::int32_t>::max(), x1 = -x0, y0 = x0, y1 = -x0;
  std::int32_t behind = 0;
  std::int32_t nearest = 0;  // bits of a positive float, which are in its order
  for (std::size_t i = 0; i < count; ++i) {
    const float right = p.turn[0] * x[i] + p.turn[1] * y[i] + p.turn[2] * z[i] + p.shift[0];
    const float low = p.turn[3] * x[i] + p.turn[4] * y[i] + p.turn[5] * z[i] + p.shift[1];
    const float deep = p.turn[6] * x[i] + p.turn[7] * y[i] + p.turn[8] * z[i] + p.shift[2];
    const float from = deep < PlacedMeshes::kNearestDepth ? PlacedMeshes::kNearestDepth : deep;
    const float near = 1.0f / from;
    across[i] = subpixel(p.cx + p.fx * right * near);
    down[i] = subpixel(p.cy + p.fy * low * near);
    nearness[i] = deep < PlacedMeshes::kNearestDepth ? kBehindEye : near;
    nearest = greatest(nearest, std::bit_cast<std::int32_t>(near));
    x0 = least(x0, across[i]);
    x1 = greatest(x1, across[i]);
    y0 = least(y0, down[i]);
    y1 = greatest(y1, down[i]);
    behind |= deep < PlacedMeshes::kNearestDepth ? 1 : 0;
  }
  out.left = x0;
  out.right = x1;
  out.top = y0;
  out.bottom = y1;
  out.nearest = std::bit_cast<float>(nearest);
  out.is_cut = behind != 0;
}

// Those of a cluster that no plane cuts.
struct UncutTriangles {
  std::array<std::array<std::uint16_t, SmallTriangles::kMost>, 3> corner;
  std::array<std::uint32_t, SmallTriangles::kMost> triangle;
  std::size_t count = 0;

  void add(const SmallTriangles& from, std::size_t i, std::uint32_t number) {
    for (std::size_t k = 0; k < 3; ++k) corner[k][count] = from.corner[k][i];
    triangle[count++] = number;
  }
  void put(SmallTriangles& into) const {
    for (std::size_t k = 0; k < 3; ++k) into.corner[k] = corner[k].data();
    into.count = count;
  }
};

}  // namespace

void RowSpans::add(int top, int bottom, int left, int right) {
  const auto last = static_cast<int>(rows_.size()) - 1;
  for (int y = std::max(top, 0); y <= std::min(bottom, last); ++y) {
    Span& row = rows_[static_cast<std::size_t>(y)];
    const bool is_empty = row.left == row.right;
    row.left = is_empty ? left : std::min(row.left, left);
    row.right = is_empty ? right + 1 : std::max(row.right, right + 1);
  }
}

Status PlacedMeshes::add(const std::vector<Visual>& visuals,
                         std::span<const std::shared_ptr<const VertexMesh>> meshes) {
  for (std::size_t i = 0; i < visuals.size(); ++i) {
    const Visual& visual = visuals[i];
    PROBE_TRY(check_origin(visual));
    Instance instance;
    instance.mesh = meshes[i];
    instance.origin = visual.origin;
    instance.body = static_cast<std::uint16_t>(visual.body + 1);
    instance.name = visual.name;
    instance.first_part = parts_.size();
    for (const VertexMesh::Part& part : instance.mesh->parts) {
      const std::uint32_t first = end_id_;
      end_id_ += static_cast<std::uint32_t>(part.indices.size() / 3);
      while (part_at_.size() * kIdsTogether < end_id_)
        part_at_.push_back(static_cast<std::uint32_t>(parts_.size()));
      parts_.push_back({instances_.size(), &part, corners_, first, end_id_});
      corners_ += part.corners.size();
    }
    instances_.push_back(std::move(instance));
  }
  return {};
}

void PlacedMeshes::look_from(const Camera& camera) {
  into_.reset();
  eye_ = camera.position;
  forward_ = camera.forward_left_up.col(0);
  to_eye_.row(0) = -camera.forward_left_up.col(1).transpose();
  to_eye_.row(1) = -camera.forward_left_up.col(2).transpose();
  to_eye_.row(2) = camera.forward_left_up.col(0).transpose();
  width_ = camera.width;
  height_ = camera.height;
  fx_ = static_cast<float>(camera.fx);
  fy_ = static_cast<float>(camera.fy);
  cx_ = static_cast<float>(camera.cx);
  cy_ = static_cast<float>(camera.cy);
  const auto middles = [](int count, float center, float focal, std::vector<float>& out) {
    out.clear();
    for (int i = 0; i < count; ++i) out.push_back((static_cast<float>(i) + 0.5f - center) / focal);
  };
  middles(width_, cx_, fx_, across_);
  middles(height_, cy_, fy_, down_);
  step_across_ = 1 / fx_;
  step_down_ = 1 / fy_;
  shift_ = -(to_eye_ * eye_);
  left_ = top_ = 0;
  right_ = static_cast<float>(width_);
  bottom_ = static_cast<float>(height_);
}

std::optional<PlacedMeshes::Mirror> PlacedMeshes::mirror() const {
  for (const PlacedPart& placed : parts_) {
    const VertexMesh::Part& part = *placed.part;
    if (part.mirror <= 0) continue;
    const Instance& instance = instances_[placed.instance];
    Mirror mirror;
    mirror.instance = placed.instance;
    mirror.share = part.mirror;
    mirror.first_id = placed.first_id;
    mirror.end_id = placed.end_id;
    const VertexCorner& first = part.corners[0];
    mirror.normal = instance.place.rotation * first.normal.cast<double>();
    mirror.height = mirror.normal.dot(instance.place.apply(first.place.cast<double>()));
    if (mirror.normal.dot(eye_) <= mirror.height || is_outside(instance, part.around)) continue;
    mirror.left = width_;
    mirror.top = height_;
    for (const VertexCorner& corner : part.corners) {
      const Float3 seen = instance.to_camera(corner.place);
      if (seen.z() < kNearestDepth) {
        mirror.left = mirror.top = 0;
        mirror.right = width_ - 1;
        mirror.bottom = height_ - 1;
        break;
      }
      const DrawnCorner at = corner_at(seen);
      const auto pixel = [](std::int32_t subpixels) { return subpixels >> 8; };
      mirror.left = std::min(mirror.left, pixel(at.x) - 1);
      mirror.right = std::max(mirror.right, pixel(at.x) + 1);
      mirror.top = std::min(mirror.top, pixel(at.y) - 1);
      mirror.bottom = std::max(mirror.bottom, pixel(at.y) + 1);
    }
    mirror.left = std::max(mirror.left, 0);
    mirror.top = std::max(mirror.top, 0);
    mirror.right = std::min(mirror.right, width_ - 1);
    mirror.bottom = std::min(mirror.bottom, height_ - 1);
    if (mirror.left > mirror.right || mirror.top > mirror.bottom) return std::nullopt;
    return mirror;
  }
  return std::nullopt;
}

bool PlacedMeshes::Mirror::narrow(const SampleBuffer& seen) {
  Mirror found = *this;
  found.left = right + 1;
  found.right = left - 1;
  found.top = bottom + 1;
  found.bottom = top - 1;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      if (!is_in(seen.ids(x, y))) continue;
      found.left = std::min(found.left, x);
      found.right = std::max(found.right, x);
      found.top = std::min(found.top, y);
      found.bottom = std::max(found.bottom, y);
    }
  }
  *this = found;
  return left <= right;
}

void PlacedMeshes::look_into(const Camera& camera, const Mirror& mirror) {
  look_from(camera);
  const Mat3 flip = Mat3::Identity() - 2 * mirror.normal * mirror.normal.transpose();
  const Vec3 behind = 2 * mirror.height * mirror.normal;
  shift_ = to_eye_ * (behind - eye_);
  to_eye_ = to_eye_ * flip;
  eye_ = flip * eye_ + behind;
  into_ = mirror;
  left_ = static_cast<float>(mirror.left);
  right_ = static_cast<float>(mirror.right + 1);
  top_ = static_cast<float>(mirror.top);
  bottom_ = static_cast<float>(mirror.bottom + 1);
}

void PlacedMeshes::place(std::size_t index, const Pose& pose, const LampTable& lamps) {
  Instance& instance = instances_[index];
  const Pose there = pose * instance.origin;
  instance.place = there;
  const Mat3 rotation = there.rotation.toRotationMatrix();
  const Mat3 turn = to_eye_ * rotation;
  const Vec3 shift = to_eye_ * there.position + shift_;
  for (std::size_t r = 0; r < 3; ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    for (std::size_t c = 0; c < 3; ++c)
      instance.turn[3 * r + c] = static_cast<float>(turn(row, static_cast<Eigen::Index>(c)));
    instance.shift[r] = static_cast<float>(shift[row]);
  }
  if (into_) {
    instance.up = (rotation.transpose() * into_->normal).cast<float>();
    instance.level = static_cast<float>(into_->height - into_->normal.dot(there.position));
  }
  lamps.put(there, eye_, forward_, instance.lamps);
  instance.lamps.share = into_ ? into_->share : 1;
}

Float3 PlacedMeshes::Instance::to_camera(const Float3& p) const {
  const auto& m = turn;
  return {m[0] * p.x() + m[1] * p.y() + m[2] * p.z() + shift[0],
          m[3] * p.x() + m[4] * p.y() + m[5] * p.z() + shift[1],
          m[6] * p.x() + m[7] * p.y() + m[8] * p.z() + shift[2]};
}

// The ball lies beside the picture or behind the eye, with room for rounding.
bool PlacedMeshes::is_outside(const Instance& instance, const Ball& ball) const {
  const Float3 c = instance.to_camera(ball.middle);
  const float reach = room_of(ball);
  if (c.z() + reach < kNearestDepth) return true;
  if (into_ && instance.up.dot(ball.middle) + reach < instance.level) return true;
  // Past a side of the picture: `room` pixels from the middle, with a pixel to spare.
  const auto past = [&](float along, float focal, float room) {
    return along * focal - (room + 1) * c.z() > reach * std::hypot(focal, room + 1);
  };
  return past(c.x(), fx_, right_ - cx_) || past(-c.x(), fx_, cx_ - left_) ||
         past(c.y(), fy_, bottom_ - cy_) || past(-c.y(), fy_, cy_ - top_);
}

// Some of the ball may lie behind the mirror that is looked into.
bool PlacedMeshes::meets_mirror(const Instance& instance, const Ball& ball) const {
  return instance.up.dot(ball.middle) - room_of(ball) < instance.level;
}

DrawnCorner PlacedMeshes::corner_at(const Float3& seen) const {
  const float near = 1.0f / seen.z();
  return {subpixel(cx_ + fx_ * seen.x() * near), subpixel(cy_ + fy_ * seen.y() * near), near};
}

// What of a triangle lies beyond the nearest depth, and before the mirror that is looked into.
void PlacedMeshes::draw_cut(const Instance& instance, const VertexMesh::Part& part,
                            std::size_t first, SampleBuffer& out, std::uint32_t id) const {
  std::array<Float3, 5> left;
  std::size_t count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    left[k] = part.corners[part.indices[first + k]].place;
  }
  // Keeps what `height` says 0 or more of.
  const auto cut = [&](const auto& height) {
    std::array<Float3, 5> kept;
    std::size_t n = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Float3& a = left[k];
      const Float3& b = left[(k + 1) % count];
      const float above = height(a), below = height(b);
      if (above >= 0) kept[n++] = a;
      if ((above >= 0) != (below >= 0)) kept[n++] = a + (b - a) * (above / (above - below));
    }
    left = kept;
    count = n;
  };
  if (into_) cut([&](const Float3& p) { return instance.up.dot(p) - instance.level; });
  for (std::size_t k = 0; k < count; ++k) left[k] = instance.to_camera(left[k]);
  cut([](const Float3& p) { return p.z() - kNearestDepth; });
  std::array<DrawnCorner, 5> corners;
  for (std::size_t k = 0; k < count; ++k) {
    left[k].z() = std::max(left[k].z(), kNearestDepth);
    corners[k] = corner_at(left[k]);
  }
  for (std::size_t k = 2; k < count; ++k) {
    const std::size_t b = into_ ? k : k - 1, c = into_ ? k - 1 : k;
    out.draw(corners[0], corners[b], corners[c], id);
  }
}

void PlacedMeshes::draw(std::size_t index, SampleBuffer& out, RowSpans* spans) {
  const Instance& instance = instances_[index];
  for (std::size_t p = 0; p < instance.mesh->parts.size(); ++p)
    draw_part(parts_[instance.first_part + p], out, spans);
}

void PlacedMeshes::draw_all(SampleBuffer& out) {
  order_.clear();
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const Ball& ball = parts_[p].part->around;
    const Instance& instance = instances_[parts_[p].instance];
    if (into_ && parts_[p].instance == into_->instance) continue;
    order_.push_back({instance.to_camera(ball.middle).z(), p});
  }
  std::ranges::sort(order_);
  for (const auto& [depth, part] : order_) draw_part(parts_[part], out, nullptr);
}

void PlacedMeshes::draw_part(const PlacedPart& placed, SampleBuffer& out, RowSpans* spans) const {
  const Instance& instance = instances_[placed.instance];
  const VertexMesh::Part& part = *placed.part;
  if (part.indices.empty() || part.samples == 0 || is_outside(instance, part.around)) return;
  out.take(part.samples);
  const auto& clusters = part.clusters.clusters;
  for (const MeshClusters::Cluster& cluster : clusters) {
    if (clusters.size() > 1 && is_outside(instance, cluster.around)) continue;
    draw_cluster(instance, placed, cluster, out, spans);
  }
  out.take(4);
}

void PlacedMeshes::draw_cluster(const Instance& instance, const PlacedPart& placed,
                                const MeshClusters::Cluster& cluster, SampleBuffer& out,
                                RowSpans* spans) const {
  const MeshClusters& of = placed.part->clusters;
  SeenPlaces seen;
  view_places(of.x.data() + cluster.first_place, of.y.data() + cluster.first_place,
              of.z.data() + cluster.first_place, cluster.places,
              {instance.turn, instance.shift, fx_, fy_, cx_, cy_}, seen);
  int left = static_cast<int>(left_), right = static_cast<int>(right_) - 1,
      top = static_cast<int>(top_), bottom = static_cast<int>(bottom_) - 1;
  if (!seen.is_cut) {
    left = std::max(left, seen.left / kSubpixels - 1);
    right = std::min(right, seen.right / kSubpixels + 1);
    top = std::max(top, seen.top / kSubpixels - 1);
    bottom = std::min(bottom, seen.bottom / kSubpixels + 1);
  }
  if (left > right || top > bottom) return;
  // Over what is kept of another picture little is hidden.
  const bool is_whole = spans == nullptr;
  if (is_whole && !seen.is_cut && out.hides(left, right, top, bottom, seen.nearest)) return;
  if (spans != nullptr) spans->add(top, bottom, left, right);
  const std::uint32_t* triangle = of.triangle.data() + cluster.first_triangle;
  SmallTriangles all{.x = seen.x.data(),
                     .y = seen.y.data(),
                     .nearness = seen.nearness.data(),
                     .corner = {},
                     .count = cluster.triangles};
  // A mirror turns what it shows: two corners change places.
  for (std::size_t k = 0; k < 3; ++k)
    all.corner[into_ && k > 0 ? 3 - k : k] = of.place[k].data() + cluster.first_triangle;
  UncutTriangles uncut;
  if (seen.is_cut || (into_ && meets_mirror(instance, cluster.around))) {
    std::array<float, MeshClusters::kMostPlaces> above;  // the plane of the mirror
    for (std::size_t i = 0; into_ && i < cluster.places; ++i) {
      const std::size_t at = cluster.first_place + i;
      above[i] = instance.up.dot(Float3(of.x[at], of.y[at], of.z[at])) - instance.level;
    }
    for (std::size_t i = 0; i < cluster.triangles; ++i) {
      int behind = 0, under = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint16_t at = all.corner[k][i];
        behind += seen.nearness[at] == kBehindEye ? 1 : 0;
        under += into_ && above[at] < 0 ? 1 : 0;
      }
      if (behind == 3 || under == 3) continue;
      if (behind == 0 && under == 0) {
        uncut.add(all, i, triangle[i]);
      } else {
        draw_cut(instance, *placed.part, std::size_t{3} * triangle[i], out,
                 placed.first_id + triangle[i]);
      }
    }
    uncut.put(all);
    triangle = uncut.triangle.data();
  }
  SeenTriangles shown;
  find_seen(all, out, shown);
  const auto corner = [&](std::size_t k, std::size_t i) {
    const std::uint16_t at = all.corner[k][i];
    return DrawnCorner{seen.x[at], seen.y[at], seen.nearness[at]};
  };
  for (std::size_t n = 0; n < shown.to_draw.count; ++n) {
    const std::size_t i = shown.to_draw.which[n];
    out.draw(corner(0, i), corner(1, i), corner(2, i), placed.first_id + triangle[i]);
  }
  bool is_changed = false;
  for (std::size_t k = 0; k < shown.boxed.size(); ++k) {
    out.draw_boxed(all, shown.boxed[k], k, placed.first_id, triangle);
    is_changed = is_changed || shown.boxed[k].count > 0;
  }
  if (is_whole && is_changed) out.note(left, right, top, bottom);
}

}  // namespace probe::render
