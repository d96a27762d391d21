#include "runtime/render/placed_mesh.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"
#include "runtime/render/placing_check.h"

namespace probe::render {
namespace {

constexpr float kMostSubpixels = 134217728.0f;  // 2^27
constexpr float kBehind = -1;                   // the nearness of what has to be cut

inline std::int32_t subpixel(float pixels) {
  const float at = pixels * static_cast<float>(kSubpixels);
  const float kept = at < -kMostSubpixels  ? -kMostSubpixels
                     : at > kMostSubpixels ? kMostSubpixels
                                           : at;
  return static_cast<std::int32_t>(std::floor(kept + 0.5f));
}

struct CornerView {
  std::array<float, 9> turn;
  std::array<float, 3> shift;
  float fx, fy, cx, cy;
};

PROBE_CLONES void view_corners(const float* __restrict x, const float* __restrict y,
                               const float* __restrict z, std::size_t count, const CornerView& by,
                               std::int32_t* __restrict across, std::int32_t* __restrict down,
                               float* __restrict nearness) {
  const CornerView p = by;
  for (std::size_t i = 0; i < count; ++i) {
    const float right = p.turn[0] * x[i] + p.turn[1] * y[i] + p.turn[2] * z[i] + p.shift[0];
    const float low = p.turn[3] * x[i] + p.turn[4] * y[i] + p.turn[5] * z[i] + p.shift[1];
    const float deep = p.turn[6] * x[i] + p.turn[7] * y[i] + p.turn[8] * z[i] + p.shift[2];
    const float from = deep < PlacedMeshes::kNearestDepth ? PlacedMeshes::kNearestDepth : deep;
    const float near = 1.0f / from;
    across[i] = subpixel(p.cx + p.fx * right * near);
    down[i] = subpixel(p.cy + p.fy * low * near);
    nearness[i] = deep < PlacedMeshes::kNearestDepth ? kBehind : near;
  }
}

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
      parts_.push_back({instances_.size(), &part, lit_.size()});
      lit_.resize(lit_.size() + part.x.size());
    }
    instances_.push_back(std::move(instance));
  }
  lit_stamp_.resize(lit_.size(), 0);
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
    const Vec3 normal(part.normals[0], part.normals[1], part.normals[2]);
    mirror.normal = instance.place.rotation * normal;
    mirror.height = mirror.normal.dot(instance.place.apply(Vec3(part.x[0], part.y[0], part.z[0])));
    if (mirror.normal.dot(eye_) <= mirror.height || is_outside(instance, part)) continue;
    mirror.left = width_;
    mirror.top = height_;
    for (std::size_t i = 0; i < part.x.size(); ++i) {
      const Float3 seen = to_camera(instance, {part.x[i], part.y[i], part.z[i]});
      if (seen.z() < kNearestDepth) {
        mirror.left = mirror.top = 0;
        mirror.right = width_ - 1;
        mirror.bottom = height_ - 1;
        break;
      }
      const DrawnCorner at = corner_at(seen);
      const auto pixel = [](std::int64_t subpixels) { return static_cast<int>(subpixels >> 8); };
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
  instance.stamp = ++stamps_;
}

Float3 PlacedMeshes::to_camera(const Instance& instance, const Float3& p) const {
  const auto& m = instance.turn;
  return {m[0] * p.x() + m[1] * p.y() + m[2] * p.z() + instance.shift[0],
          m[3] * p.x() + m[4] * p.y() + m[5] * p.z() + instance.shift[1],
          m[6] * p.x() + m[7] * p.y() + m[8] * p.z() + instance.shift[2]};
}

// The ball around a part lies beside the picture or behind the eye.
bool PlacedMeshes::is_outside(const Instance& instance, const VertexMesh::Part& part) const {
  const Float3 c = to_camera(instance, part.middle);
  const float reach = part.radius * 1.001f;
  if (c.z() + reach < kNearestDepth) return true;
  if (into_ && instance.up.dot(part.middle) + reach < instance.level) return true;
  // Past a side of the picture: `room` pixels from the middle, with a pixel to spare.
  const auto past = [&](float along, float focal, float room) {
    return along * focal - (room + 1) * c.z() > reach * std::hypot(focal, room + 1);
  };
  return past(c.x(), fx_, right_ - cx_) || past(-c.x(), fx_, cx_ - left_) ||
         past(c.y(), fy_, bottom_ - cy_) || past(-c.y(), fy_, cy_ - top_);
}

DrawnCorner PlacedMeshes::corner_at(const Float3& seen) const {
  const float near = 1.0f / seen.z();
  return {subpixel(cx_ + fx_ * seen.x() * near), subpixel(cy_ + fy_ * seen.y() * near), near};
}

// What of a triangle lies beyond the nearest depth, and before the mirror that is looked into.
bool PlacedMeshes::draw_cut(const Instance& instance, const VertexMesh::Part& part,
                            std::size_t first, SampleBuffer& out, std::uint32_t id) const {
  std::array<Float3, 5> left;
  std::size_t count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t i = part.indices[first + k];
    left[k] = {part.x[i], part.y[i], part.z[i]};
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
  for (std::size_t k = 0; k < count; ++k) left[k] = to_camera(instance, left[k]);
  cut([](const Float3& p) { return p.z() - kNearestDepth; });
  std::array<DrawnCorner, 5> corners;
  for (std::size_t k = 0; k < count; ++k) {
    left[k].z() = std::max(left[k].z(), kNearestDepth);
    corners[k] = corner_at(left[k]);
  }
  bool any_drawn = false;
  for (std::size_t k = 2; k < count; ++k) {
    const std::size_t b = into_ ? k : k - 1, c = into_ ? k - 1 : k;
    any_drawn |= out.draw(corners[0], corners[b], corners[c], id);
  }
  return any_drawn;
}

void PlacedMeshes::draw(std::size_t index, SampleBuffer& out, std::vector<DrawnTriangle>& drawn,
                        RowSpans* spans) {
  const Instance& instance = instances_[index];
  for (std::size_t p = 0; p < instance.mesh->parts.size(); ++p) {
    const VertexMesh::Part& part = instance.mesh->parts[p];
    if (part.indices.empty() || is_outside(instance, part)) continue;
    const std::size_t corners = part.x.size();
    x_.resize(std::max(x_.size(), corners));
    y_.resize(x_.size());
    nearness_.resize(x_.size());
    view_corners(part.x.data(), part.y.data(), part.z.data(), corners,
                 {instance.turn, instance.shift, fx_, fy_, cx_, cy_}, x_.data(), y_.data(),
                 nearness_.data());
    const auto end = static_cast<std::ptrdiff_t>(corners);
    const bool is_cut = *std::min_element(nearness_.begin(), nearness_.begin() + end) < 0;
    if (spans != nullptr) {
      int left = 0, right = width_ - 1, top = 0, bottom = height_ - 1;
      if (!is_cut) {
        const auto [x0, x1] = std::minmax_element(x_.begin(), x_.begin() + end);
        const auto [y0, y1] = std::minmax_element(y_.begin(), y_.begin() + end);
        left = std::max(left, *x0 / kSubpixels - 1);
        right = std::min(right, *x1 / kSubpixels + 1);
        top = std::max(top, *y0 / kSubpixels - 1);
        bottom = std::min(bottom, *y1 / kSubpixels + 1);
      }
      if (left > right || top > bottom) continue;
      spans->add(top, bottom, left, right);
    }
    const auto placed = static_cast<std::uint32_t>(instance.first_part + p);
    for (std::size_t first = 0; first + 2 < part.indices.size(); first += 3) {
      const std::uint32_t a = part.indices[first], b = part.indices[first + 1],
                          c = part.indices[first + 2];
      const auto id = static_cast<std::uint32_t>(drawn.size() + 1);
      const bool cut =
          into_ || (is_cut && (nearness_[a] < 0 || nearness_[b] < 0 || nearness_[c] < 0));
      const bool is_seen =
          cut ? draw_cut(instance, part, first, out, id)
              : out.draw({x_[a], y_[a], nearness_[a]}, {x_[b], y_[b], nearness_[b]},
                         {x_[c], y_[c], nearness_[c]}, id);
      if (is_seen) drawn.push_back({placed, static_cast<std::uint32_t>(first / 3)});
    }
  }
}

const Rgb& PlacedMeshes::lit(const PlacedPart& placed, std::uint32_t corner) {
  const std::size_t at = placed.first_corner + corner;
  const Instance& instance = instances_[placed.instance];
  if (lit_stamp_[at] == instance.stamp) return lit_[at];
  lit_stamp_[at] = instance.stamp;
  const VertexMesh::Part& part = *placed.part;
  const std::size_t n = std::size_t{3} * corner;
  const auto color =
      instance.lamps.color_of(part.material, {part.x[corner], part.y[corner], part.z[corner]},
                              {part.normals[n], part.normals[n + 1], part.normals[n + 2]});
  lit_[at] = Rgb{color[0], color[1], color[2], 1};
  return lit_[at];
}

SeenFace PlacedMeshes::face(std::uint32_t id, const DrawnTriangle& drawn) {
  const PlacedPart& placed = parts_[drawn.part];
  const VertexMesh::Part& part = *placed.part;
  const Instance& instance = instances_[placed.instance];
  SeenFace face;
  face.id = id;
  face.body = instance.body;
  face.texture = part.texture;
  face.mirror = part.mirror;
  std::array<Float3, 3> corners;
  std::array<std::uint32_t, 3> which{};
  for (std::size_t k = 0; k < 3; ++k) {
    which[k] = part.indices[3 * std::size_t{drawn.triangle} + k];
    corners[k] = to_camera(instance, {part.x[which[k]], part.y[which[k]], part.z[which[k]]});
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Float3 edge = corners[(k + 1) % 3].cross(corners[(k + 2) % 3]);
    face.edge[k] = {edge.x(), edge.y(), edge.z()};
    const Rgb& color = lit(placed, which[k]);
    face.by_across += edge.x() * color;
    face.by_down += edge.y() * color;
    face.at_middle += edge.z() * color;
    face.mean += color * (1.0f / 3);
    if (k == 0) face.volume = corners[0].dot(edge);
    if (part.texture == nullptr) continue;
    const float u = part.uv[std::size_t{2} * which[k]], v = part.uv[std::size_t{2} * which[k] + 1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      face.u[axis] += face.edge[k][axis] * u;
      face.v[axis] += face.edge[k][axis] * v;
    }
  }
  return face;
}

}  // namespace probe::render
