#include "runtime/world/clip.h"

#include <cmath>

namespace probe::world {
namespace {

using scene::ConvexPart;

constexpr double kSameFacing =
    -0.985;  // merged hulls have slivers: every face this antiparallel is incident
constexpr double kDuplicate = 1e-4;  // m

struct Polygon {
  static constexpr int kMax = 160;  // 64 corners of the face and one more for each side that cuts
  int count = 0;
  std::array<Vec3, kMax> points;

  void add(const Vec3& p) {
    if (count < kMax) points[static_cast<std::size_t>(count++)] = p;
  }
};

// Keeps the part of the polygon with side . x <= offset.
void cut(const Polygon& in, const Vec3& side, double offset, Polygon* out) {
  out->count = 0;
  if (in.count == 0) return;
  const Vec3* from = &in.points[static_cast<std::size_t>(in.count - 1)];
  double from_distance = side.dot(*from) - offset;
  for (int i = 0; i < in.count; ++i) {
    const Vec3* to = &in.points[static_cast<std::size_t>(i)];
    const double to_distance = side.dot(*to) - offset;
    if ((from_distance <= 0) != (to_distance <= 0)) {
      out->add(*from + from_distance / (from_distance - to_distance) * (*to - *from));
    }
    if (to_distance <= 0) out->add(*to);
    from = to;
    from_distance = to_distance;
  }
}

Vec3 placed(const ConvexPart& hull, std::uint8_t vertex, bool is_b, const RelativePose& pose) {
  return is_b ? Vec3(pose.axes * hull.vertices[vertex] + pose.offset) : hull.vertices[vertex];
}

}  // namespace

void clip_faces(const ConvexPart& a, const ConvexPart& b, const RelativePose& b_in_a,
                const FaceRef& reference, double margin, Candidates* out) {
  out->count = 0;
  const bool of_b = reference.of_b;
  const ConvexPart& base = of_b ? b : a;
  const ConvexPart& other = of_b ? a : b;
  const ConvexPart::Face& face = base.faces[static_cast<std::size_t>(reference.face)];
  const Vec3 n = of_b ? Vec3(b_in_a.axes * face.normal) : face.normal;
  const double offset = of_b ? face.offset + n.dot(b_in_a.offset) : face.offset;
  out->normal = of_b ? n : Vec3(-n);

  // The most antiparallel face, and all nearly as antiparallel to the reference.
  const Vec3 in_other = of_b ? n : Vec3(b_in_a.axes.transpose() * n);
  std::size_t most = 0;
  double least = 2;
  for (std::size_t i = 0; i < other.faces.size(); ++i) {
    const double c = other.faces[i].normal.dot(in_other);
    if (c < least) {
      least = c;
      most = i;
    }
  }
  Polygon first, second;
  for (std::size_t i = 0; i < other.faces.size(); ++i) {
    if (i != most && other.faces[i].normal.dot(in_other) >= kSameFacing) continue;
    Polygon* polygon = &first;
    Polygon* spare = &second;
    polygon->count = 0;
    for (const std::uint8_t v : other.faces[i].loop) polygon->add(placed(other, v, !of_b, b_in_a));
    Vec3 from = placed(base, face.loop.back(), of_b, b_in_a);
    for (const std::uint8_t v : face.loop) {
      const Vec3 to = placed(base, v, of_b, b_in_a);
      const Vec3 side = (to - from).cross(n);
      cut(*polygon, side, side.dot(to), spare);
      std::swap(polygon, spare);
      from = to;
      if (polygon->count == 0) break;
    }
    for (int k = 0; k < polygon->count; ++k) {
      const Vec3& x = polygon->points[static_cast<std::size_t>(k)];
      const double gap = n.dot(x) - offset;
      if (gap >= margin || out->count == Candidates::kMax) continue;
      const Vec3 middle = x - (0.5 * gap) * n;
      bool known = false;
      for (int m = 0; m < out->count && !known; ++m) {
        known = (out->points[static_cast<std::size_t>(m)].middle - middle).squaredNorm() <
                kDuplicate * kDuplicate;
      }
      if (known) continue;
      const Vec3 on_face = x - gap * n;
      Candidate& c = out->points[static_cast<std::size_t>(out->count++)];
      c.on_a = of_b ? x : on_face;
      c.on_b = of_b ? on_face : x;
      c.middle = middle;
      c.gap = gap;
      c.id = -1;
    }
  }
}

}  // namespace probe::world
