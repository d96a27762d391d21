#include "runtime/scene/hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <utility>

#include "runtime/base/trig.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace probe::scene {
namespace {

constexpr double kMillimetres = 1000.0;
constexpr std::size_t kMaxVertices = 64, kMaxFaces = 128, kMaxEdges = 160;

// Faces as polygons over the given points (millimetres), as Qhull reports them.
struct RawHull {
  struct Face {
    Vec3 normal;
    std::vector<int> loop;
  };
  std::vector<Face> faces;
};

// Runs Qhull with a merge tolerance in millimetres. False when the points span no volume.
bool run_qhull(const std::vector<Vec3>& points, double merge_mm, RawHull* out) {
  std::vector<coordT> coordinates;
  coordinates.reserve(points.size() * 3);
  for (const Vec3& p : points) {
    for (int k = 0; k < 3; ++k) coordinates.push_back(p[k]);
  }
  // Qhull writes its complaints into a memory stream: they are for a person at its own command
  // line.
  char* text = nullptr;
  std::size_t length = 0;
  FILE* messages = open_memstream(&text, &length);
  if (messages == nullptr) return false;
  char options[64];
  if (merge_mm > 0) {
    std::snprintf(options, sizeof options, "qhull C-%.6f", merge_mm);
  } else {
    std::snprintf(options, sizeof options, "qhull");
  }
  qhT context;
  qhT* qh = &context;
  qh_zero(qh, messages);
  const int code = qh_new_qhull(qh, 3, static_cast<int>(points.size()), coordinates.data(), False,
                                options, nullptr, messages);
  bool good = code == 0;
  if (good) {
    facetT* facet = nullptr;
    FORALLfacets {
      RawHull::Face face;
      face.normal = Vec3(facet->normal[0], facet->normal[1], facet->normal[2]);
      setT* ordered = qh_facet3vertex(qh, facet);
      vertexT* vertex = nullptr;
      vertexT** vertexp = nullptr;
      FOREACHvertex_(ordered) face.loop.push_back(qh_pointid(qh, vertex->point));
      qh_settempfree(qh, &ordered);
      out->faces.push_back(std::move(face));
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int remaining_long = 0, total_long = 0;
  qh_memfreeshort(qh, &remaining_long, &total_long);
  std::fclose(messages);
  std::free(text);
  return good;
}

// Turns loops counter-clockwise about their normals; false unless every edge joins exactly two
// faces.
bool orient_and_check(const std::vector<Vec3>& points, RawHull* hull) {
  std::map<std::pair<int, int>, int> directed;
  for (RawHull::Face& face : hull->faces) {
    if (face.loop.size() < 3) return false;
    Vec3 area = Vec3::Zero();
    const Vec3& first = points[static_cast<std::size_t>(face.loop[0])];
    for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
      const Vec3& a = points[static_cast<std::size_t>(face.loop[i])];
      const Vec3& b = points[static_cast<std::size_t>(face.loop[i + 1])];
      area += (a - first).cross(b - first);
    }
    if (area.dot(face.normal) < 0) std::reverse(face.loop.begin(), face.loop.end());
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
      if (++directed[{face.loop[i], face.loop[(i + 1) % face.loop.size()]}] > 1) return false;
    }
  }
  for (const auto& [edge, count] : directed) {
    if (!directed.contains({edge.second, edge.first})) return false;
  }
  return hull->faces.size() >= 4;
}

// A closed hull; merging that leaves holes (rare: slivers) is repeated with a smaller tolerance.
bool closed_hull(const std::vector<Vec3>& points, RawHull* out) {
  for (const double merge : {0.05, 0.02, 0.005, 0.0}) {
    RawHull hull;
    if (run_qhull(points, merge, &hull) && orient_and_check(points, &hull)) {
      *out = std::move(hull);
      return true;
    }
  }
  return false;
}

std::vector<int> used_points(const RawHull& hull) {
  std::vector<int> used;
  for (const RawHull::Face& face : hull.faces)
    used.insert(used.end(), face.loop.begin(), face.loop.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

double distance_outside(const std::vector<Vec3>& corners, const RawHull& hull, const Vec3& point) {
  double outside = -1e30;
  for (const RawHull::Face& face : hull.faces) {
    double offset = -1e30;
    for (const int i : face.loop) {
      offset = std::max(offset, face.normal.dot(corners[static_cast<std::size_t>(i)]));
    }
    outside = std::max(outside, face.normal.dot(point) - offset);
  }
  return outside;
}

// The best-fit plane's normal and a point on it.
std::pair<Vec3, Vec3> fit_plane(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(scatter);
  return {solver.eigenvectors().col(0), mean};
}

// Chooses at most `limit` of the points: the axis extremes, then always the one farthest outside
// the hull so far.
std::vector<Vec3> reduce_points(const std::vector<Vec3>& points, std::size_t limit) {
  constexpr double kGoodEnoughMm = 0.05;
  std::vector<Vec3> chosen;
  std::vector<bool> taken(points.size(), false);
  const auto take = [&](std::size_t i) {
    if (taken[i]) return;
    taken[i] = true;
    chosen.push_back(points[i]);
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t low = 0, high = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i][axis] < points[low][axis]) low = i;
      if (points[i][axis] > points[high][axis]) high = i;
    }
    take(low);
    take(high);
  }
  while (chosen.size() < limit) {
    RawHull hull;
    const bool solid = chosen.size() >= 4 && run_qhull(chosen, 0, &hull);
    const auto [normal, mean] = fit_plane(chosen);
    std::size_t best = points.size();
    double farthest = solid ? kGoodEnoughMm : 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (taken[i]) continue;
      const double d = solid ? distance_outside(chosen, hull, points[i])
                             : std::fabs(normal.dot(points[i] - mean));
      if (d > farthest) {
        farthest = d;
        best = i;
      }
    }
    if (best == points.size()) break;
    take(best);
  }
  return chosen;
}

ConvexPart to_part(const std::vector<Vec3>& points_mm, const RawHull& hull) {
  ConvexPart part;
  const std::vector<int> used = used_points(hull);
  std::vector<std::uint8_t> index(points_mm.size(), 0);
  for (std::size_t i = 0; i < used.size(); ++i) {
    index[static_cast<std::size_t>(used[i])] = static_cast<std::uint8_t>(i);
    part.vertices.push_back(points_mm[static_cast<std::size_t>(used[i])] / kMillimetres);
  }
  std::map<std::pair<int, int>, Vec3> left_normal;
  for (const RawHull::Face& raw : hull.faces) {
    ConvexPart::Face face;
    face.normal = raw.normal.normalized();
    for (std::size_t i = 0; i < raw.loop.size(); ++i) {
      const int a = raw.loop[i], b = raw.loop[(i + 1) % raw.loop.size()];
      face.loop.push_back(index[static_cast<std::size_t>(a)]);
      left_normal[{index[static_cast<std::size_t>(a)], index[static_cast<std::size_t>(b)]}] =
          face.normal;
    }
    part.faces.push_back(std::move(face));
  }
  for (const auto& [edge, normal] : left_normal) {
    if (edge.first > edge.second) continue;
    part.edges.push_back({static_cast<std::uint8_t>(edge.first),
                          static_cast<std::uint8_t>(edge.second), normal,
                          left_normal.at({edge.second, edge.first})});
  }
  return part;
}

// Offsets, padded coordinates and box follow from vertices and normals.
void derive(ConvexPart* part) {
  for (ConvexPart::Face& face : part->faces) {
    face.offset = -1e30;
    for (const Vec3& v : part->vertices) face.offset = std::max(face.offset, face.normal.dot(v));
  }
  const std::size_t padded = (part->vertices.size() + 3) / 4 * 4;
  part->x.assign(padded, part->vertices[0].x());
  part->y.assign(padded, part->vertices[0].y());
  part->z.assign(padded, part->vertices[0].z());
  Vec3 low = part->vertices[0], high = low;
  for (std::size_t i = 0; i < part->vertices.size(); ++i) {
    const Vec3& v = part->vertices[i];
    part->x[i] = v.x();
    part->y[i] = v.y();
    part->z[i] = v.z();
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  part->center = 0.5 * (low + high);
  part->half = 0.5 * (high - low) + Vec3::Constant(part->round);
}

// Integrals of 1, x and x x^T over the part, by tetrahedra from the origin over fan triangles.
void integrate_mass(HullPart* hull) {
  const ConvexPart& part = hull->part;
  for (const ConvexPart::Face& face : part.faces) {
    const Vec3& a = part.vertices[face.loop[0]];
    for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
      const Vec3& b = part.vertices[face.loop[i]];
      const Vec3& c = part.vertices[face.loop[i + 1]];
      const double volume = a.dot(b.cross(c)) / 6.0;
      const Vec3 sum = a + b + c;
      hull->volume += volume;
      hull->moment += volume / 4.0 * sum;
      hull->second +=
          volume / 20.0 *
          (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
    }
  }
}

bool is_flat_or_tiny(const std::vector<Vec3>& points_mm) {
  if (points_mm.size() < 4) return true;
  Vec3 low = points_mm[0], high = low;
  for (const Vec3& p : points_mm) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if ((high - low).minCoeff() < 0.2) {
    // A thin part may be tilted as well; along an axis it is certainly too thin.
    return true;
  }
  const auto [normal, mean] = fit_plane(points_mm);
  double off_plane = 0;
  for (const Vec3& p : points_mm) off_plane = std::max(off_plane, std::fabs(normal.dot(p - mean)));
  return off_plane < 0.1;
}

}  // namespace

Result<HullPart> make_hull(std::span<const Vec3> points, const std::string& name,
                           int max_vertices) {
  if (max_vertices < 4 || max_vertices > static_cast<int>(kMaxVertices)) {
    return Failure{Fault::kAsset,
                   "a hull may have 4 to 64 vertices, asked for " + std::to_string(max_vertices),
                   name};
  }
  std::vector<Vec3> mm;
  mm.reserve(points.size());
  for (const Vec3& p : points) {
    if (!p.allFinite()) return Failure{Fault::kAsset, "a vertex is not a finite number", name};
    mm.push_back(p * kMillimetres);
  }
  if (is_flat_or_tiny(mm))
    return Failure{Fault::kAsset, "points are flat or closer than 0.2 mm, no solid", name};

  RawHull full;
  if (!closed_hull(mm, &full))
    return Failure{Fault::kAsset, "no convex hull can be made of the points", name};
  std::vector<Vec3> corners;
  for (const int i : used_points(full)) corners.push_back(mm[static_cast<std::size_t>(i)]);

  HullPart out;
  for (std::size_t limit = static_cast<std::size_t>(max_vertices); limit >= 8; limit -= 4) {
    const std::vector<Vec3> chosen =
        corners.size() > limit ? reduce_points(corners, limit) : corners;
    RawHull hull;
    if (!closed_hull(chosen, &hull)) continue;
    out = HullPart{};
    out.part = to_part(chosen, hull);
    // Triangles everywhere would exceed the edges at 64 vertices; then fewer vertices.
    if (out.part.faces.size() > kMaxFaces || out.part.edges.size() > kMaxEdges) continue;
    derive(&out.part);
    integrate_mass(&out);
    for (const Vec3& p : corners) {
      out.reduction_error =
          std::max(out.reduction_error, distance_outside(chosen, hull, p) / kMillimetres);
    }
    constexpr double kTinyVolume = 1e-10;  // 0.1 mm3
    if (!(out.volume > kTinyVolume)) return Failure{Fault::kAsset, "the hull has no volume", name};
    return out;
  }
  return Failure{Fault::kAsset, "the hull cannot be reduced to its vertex limit", name};
}

CollisionShape assemble_shape(std::vector<HullPart> parts) {
  CollisionShape shape;
  Vec3 moment = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const HullPart& part : parts) {
    shape.volume += part.volume;
    moment += part.moment;
    second += part.second;
  }
  shape.center_of_mass = moment / shape.volume;
  const Mat3 central =
      second - shape.volume * shape.center_of_mass * shape.center_of_mass.transpose();
  shape.unit_inertia = central.trace() * Mat3::Identity() - central;
  for (HullPart& hull : parts) {
    for (Vec3& v : hull.part.vertices) {
      v -= shape.center_of_mass;
      shape.bounding_radius = std::max(shape.bounding_radius, v.norm() + hull.part.round);
    }
    derive(&hull.part);
    shape.parts.push_back(std::move(hull.part));
  }
  return shape;
}

CollisionShape shape_weighing(const CollisionShape& shape, double mass, const Vec3& center,
                              const Mat3& inertia) {
  CollisionShape out = shape;
  const Vec3 shift = shape.center_of_mass - center;
  out.center_of_mass = center;
  out.unit_inertia = inertia * (shape.volume / mass);
  out.bounding_radius = 0;
  for (ConvexPart& part : out.parts) {
    for (Vec3& v : part.vertices) {
      v += shift;
      out.bounding_radius = std::max(out.bounding_radius, v.norm() + part.round);
    }
    derive(&part);
  }
  return out;
}

Result<CollisionShape> make_collision_shape(const std::vector<std::vector<Vec3>>& components,
                                            const std::string& name, const HullOptions& options) {
  std::vector<std::vector<Vec3>> groups;
  if (options.single_hull) groups.emplace_back();
  for (const std::vector<Vec3>& component : components) {
    for (const Vec3& p : component) {
      if (!p.allFinite()) return Failure{Fault::kAsset, "a vertex is not a finite number", name};
    }
    if (options.single_hull) {
      groups[0].insert(groups[0].end(), component.begin(), component.end());
    } else {
      groups.push_back(component);
    }
  }
  std::vector<HullPart> parts;
  for (const std::vector<Vec3>& group : groups) {
    // A component without volume (a stray triangle, a decal) is no part of a solid; others may be.
    Result<HullPart> part = make_hull(group, name, options.max_vertices);
    if (part) parts.push_back(std::move(part).value());
  }
  if (parts.empty()) {
    return Failure{Fault::kAsset,
                   "no component of the mesh is a solid: all are flat, tiny or empty", name};
  }
  return assemble_shape(std::move(parts));
}

namespace {

// Edges with the normals of both their faces, from closed loops.
void add_edges(ConvexPart* part) {
  std::map<std::pair<int, int>, Vec3> left_normal;
  for (const ConvexPart::Face& face : part->faces) {
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
      left_normal[{face.loop[i], face.loop[(i + 1) % face.loop.size()]}] = face.normal;
    }
  }
  for (const auto& [edge, normal] : left_normal) {
    if (edge.first > edge.second) continue;
    part->edges.push_back({static_cast<std::uint8_t>(edge.first),
                           static_cast<std::uint8_t>(edge.second), normal,
                           left_normal.at({edge.second, edge.first})});
  }
}

CollisionShape solid_of(HullPart solid) {
  add_edges(&solid.part);
  derive(&solid.part);
  integrate_mass(&solid);
  return assemble_shape({std::move(solid)});
}

}  // namespace

CollisionShape make_box_shape(const Vec3& half) {
  HullPart box;
  for (int i = 0; i < 8; ++i) {
    box.part.vertices.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                                   i & 4 ? half.z() : -half.z());
  }
  constexpr std::array<std::array<std::uint8_t, 4>, 6> kLoops{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (std::size_t f = 0; f < kLoops.size(); ++f) {
    ConvexPart::Face face;
    face.normal = Vec3::Zero();
    face.normal[static_cast<Eigen::Index>(f / 2)] = f % 2 == 0 ? -1 : 1;
    face.loop.assign(kLoops[f].begin(), kLoops[f].end());
    box.part.faces.push_back(std::move(face));
  }
  return solid_of(std::move(box));
}

CollisionShape make_cylinder_shape(double radius, double half_length) {
  constexpr int kSides = 32;
  constexpr double kPi = std::numbers::pi;
  HullPart prism;
  ConvexPart::Face bottom{-Vec3::UnitZ(), 0, {}}, top{Vec3::UnitZ(), 0, {}};
  for (int i = 0; i < kSides; ++i) {  // bottom corners are even, top ones odd
    const SinCos corner = portable_sincos(2 * kPi * i / kSides);
    const SinCos middle = portable_sincos(2 * kPi * (i + 0.5) / kSides);
    prism.part.vertices.emplace_back(radius * corner.cos, radius * corner.sin, -half_length);
    prism.part.vertices.emplace_back(radius * corner.cos, radius * corner.sin, half_length);
    const auto low = static_cast<std::uint8_t>(2 * i);
    const auto next = static_cast<std::uint8_t>(2 * ((i + 1) % kSides));
    ConvexPart::Face side{Vec3(middle.cos, middle.sin, 0), 0, {}};
    side.loop = {low, next, static_cast<std::uint8_t>(next + 1),
                 static_cast<std::uint8_t>(low + 1)};
    prism.part.faces.push_back(std::move(side));
    top.loop.push_back(static_cast<std::uint8_t>(low + 1));
    bottom.loop.insert(bottom.loop.begin(), low);
  }
  prism.part.faces.push_back(std::move(bottom));
  prism.part.faces.push_back(std::move(top));
  return solid_of(std::move(prism));
}

CollisionShape make_capsule_shape(double radius, double half_length) {
  constexpr double kPi = std::numbers::pi;
  const double r = radius, h = half_length;
  HullPart capsule;
  capsule.part.round = r;
  if (h > 0) capsule.part.vertices = {Vec3(0, 0, -h), Vec3(0, 0, h)};
  if (!(h > 0)) capsule.part.vertices = {Vec3::Zero()};
  derive(&capsule.part);
  // A cylinder and two half balls.
  const double cap = 2.0 / 3.0 * kPi * r * r * r, tube = 2 * kPi * r * r * h;
  capsule.volume = tube + 2 * cap;
  const double across = tube * r * r / 4 + 2 * cap * r * r / 5;
  const double along =
      tube * h * h / 3 + 2 * (cap * h * h + 2 * h * kPi * r * r * r * r / 4 + cap * r * r / 5);
  capsule.second = Vec3(across, across, along).asDiagonal();
  return assemble_shape({std::move(capsule)});
}

CollisionShape make_sphere_shape(double radius) { return make_capsule_shape(radius, 0); }

CollisionShape join_shapes(std::vector<PlacedShape> shapes) {
  CollisionShape joined;
  Vec3 moment = Vec3::Zero();
  for (const PlacedShape& placed : shapes) {
    joined.volume += placed.shape.volume;
    moment += placed.shape.volume * placed.pose.apply(placed.shape.center_of_mass);
  }
  joined.center_of_mass = moment / joined.volume;
  for (PlacedShape& placed : shapes) {
    const Mat3 turn = placed.pose.rotation.toRotationMatrix();
    const Vec3 shift = placed.pose.apply(placed.shape.center_of_mass) - joined.center_of_mass;
    const Mat3 outer = shift * shift.transpose();
    joined.unit_inertia += turn * placed.shape.unit_inertia * turn.transpose() +
                           placed.shape.volume * (outer.trace() * Mat3::Identity() - outer);
    for (ConvexPart& part : placed.shape.parts) {
      for (Vec3& v : part.vertices) {
        v = turn * v + shift;
        joined.bounding_radius = std::max(joined.bounding_radius, v.norm() + part.round);
      }
      for (ConvexPart::Face& face : part.faces) face.normal = turn * face.normal;
      for (ConvexPart::Edge& edge : part.edges) {
        edge.normal_a = turn * edge.normal_a;
        edge.normal_b = turn * edge.normal_b;
      }
      derive(&part);
      joined.parts.push_back(std::move(part));
    }
  }
  return joined;
}

}  // namespace probe::scene
