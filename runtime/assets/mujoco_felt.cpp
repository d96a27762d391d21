#include "runtime/assets/mujoco_felt.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runtime/base/trig.h"
#include "runtime/scene/hull.h"

namespace probe::assets {
namespace {

using mjcf::Geom;
using mjcf::Shape;

FeltPart box_part(const Vec3& half, const Pose& pose) {
  FeltPart part;
  for (int i = 0; i < 8; ++i) {
    const Vec3 signs(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    part.corners.push_back(pose.apply(signs.cwiseProduct(half)));
  }
  part.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  part.box = FeltPart::Box{half, pose};
  return part;
}

// A solid of revolution about z: rings of `sides` corners from below, closed by flat ends, or by
// poles where there are two.
struct Ring {
  double z = 0, radius = 0;
};
FeltPart turned_part(const std::vector<Ring>& rings, std::uint32_t sides,
                     const std::array<double, 2>* poles, const Vec3& stretch, const Pose& pose) {
  FeltPart part;
  const auto put = [&](double x, double y, double z) {
    part.corners.push_back(pose.apply(Vec3(x, y, z).cwiseProduct(stretch)));
  };
  for (const Ring& ring : rings) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const SinCos at = portable_sincos_deg(360.0 * i / sides);
      put(ring.radius * at.cos, ring.radius * at.sin, ring.z);
    }
  }
  const auto corner = [&](std::size_t ring, std::uint32_t i) {
    return static_cast<std::uint32_t>(ring) * sides + i % sides;
  };
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      part.triangles.push_back({corner(r, i), corner(r, i + 1), corner(r + 1, i)});
      part.triangles.push_back({corner(r, i + 1), corner(r + 1, i + 1), corner(r + 1, i)});
    }
  }
  const std::size_t last = rings.size() - 1;
  if (poles == nullptr) {
    for (std::uint32_t i = 1; i + 1 < sides; ++i) {
      part.triangles.push_back({corner(0, 0), corner(0, i + 1), corner(0, i)});
      part.triangles.push_back({corner(last, 0), corner(last, i), corner(last, i + 1)});
    }
    return part;
  }
  const auto south = static_cast<std::uint32_t>(part.corners.size());
  put(0, 0, (*poles)[0]);
  put(0, 0, (*poles)[1]);
  for (std::uint32_t i = 0; i < sides; ++i) {
    part.triangles.push_back({south, corner(0, i + 1), corner(0, i)});
    part.triangles.push_back({south + 1, corner(last, i), corner(last, i + 1)});
  }
  return part;
}

FeltPart ball_part(const Vec3& radii, const Pose& pose) {
  std::vector<Ring> rings;
  for (const double latitude : {-60.0, -30.0, 0.0, 30.0, 60.0}) {
    const SinCos at = portable_sincos_deg(latitude);
    rings.push_back({at.sin, at.cos});
  }
  constexpr std::array<double, 2> kPoles{-1, 1};
  return turned_part(rings, 12, &kPoles, radii, pose);
}

FeltPart capsule_part(double radius, double half, const Pose& pose) {
  std::vector<Ring> rings;
  for (const double latitude : {-60.0, -30.0, 0.0}) {
    const SinCos at = portable_sincos_deg(latitude);
    rings.push_back({radius * at.sin - half, radius * at.cos});
  }
  for (int i = 2; i >= 0; --i) {
    const Ring ring = rings[static_cast<std::size_t>(i)];
    rings.push_back({-ring.z, ring.radius});
  }
  const std::array<double, 2> poles{-half - radius, half + radius};
  return turned_part(rings, 10, &poles, Vec3::Ones(), pose);
}

Result<FeltPart> hull_part(const mjcf::Model& model, const Geom& geom, const Pose& pose,
                           const scene::Mesh& mesh, std::vector<std::string>& notes) {
  std::vector<Vec3> points;
  for (const scene::MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i + 2 < part.positions.size(); i += 3)
      points.push_back(
          pose.apply({part.positions[i], part.positions[i + 1], part.positions[i + 2]}));
  }
  const std::string where = model.where(geom.at);
  PROBE_ASSIGN(const scene::HullPart hull, scene::make_hull(points, where, kMostCorners));
  FeltPart made;
  made.corners = hull.part.vertices;
  for (const scene::ConvexPart::Face& face : hull.part.faces) {
    for (std::size_t k = 1; k + 1 < face.loop.size(); ++k)
      made.triangles.push_back({face.loop[0], face.loop[k], face.loop[k + 1]});
  }
  if (hull.reduction_error > 1e-4)
    notes.push_back(
        fmt::format("{}: the hull of mesh `{}` is felt by {} corners, up to {:.2g} mm within",
                    where, model.meshes[static_cast<std::size_t>(geom.mesh)].name,
                    made.corners.size(), 1000 * hull.reduction_error));
  return made;
}

// Two of the same corners are one: nothing is felt twice.
bool is_same(const FeltPart& a, const FeltPart& b) {
  return a.corners.size() == b.corners.size() &&
         std::ranges::equal(a.corners, b.corners,
                            [](const Vec3& p, const Vec3& q) { return (p - q).norm() < 1e-9; });
}

}  // namespace

Result<std::vector<FeltPart>> felt_parts(const mjcf::Model& model, const MujocoLink& link,
                                         MujocoMeshes& meshes, bool keep_doubles,
                                         std::vector<std::string>& notes) {
  std::vector<FeltPart> parts;
  std::map<std::string, int> rounded;
  std::size_t twice = 0;
  for (const Placed<Geom>& placed : link.geoms) {
    const Geom& geom = *placed.it;
    if (!geom.can_touch()) continue;
    FeltPart part;
    const Vec3& size = geom.size;
    switch (geom.shape) {
      case Shape::kBox:
        part = box_part(size, placed.pose);
        part.kind = "box";
        break;
      case Shape::kSphere:
        part = ball_part(Vec3::Constant(size[0]), placed.pose);
        part.kind = "sphere";
        break;
      case Shape::kEllipsoid:
        part = ball_part(size, placed.pose);
        part.kind = "ellipsoid";
        break;
      case Shape::kCapsule:
        part = capsule_part(size[0], size[1], placed.pose);
        part.kind = "capsule";
        break;
      case Shape::kCylinder:
        part = turned_part({{-size[1], size[0]}, {size[1], size[0]}}, 32, nullptr, Vec3::Ones(),
                           placed.pose);
        part.kind = "cylinder";
        break;
      case Shape::kMesh: {
        PROBE_ASSIGN(const scene::Mesh* mesh, meshes.get(geom.mesh));
        PROBE_ASSIGN(part, hull_part(model, geom, placed.pose, *mesh, notes));
        part.kind = "mesh";
        break;
      }
      case Shape::kPlane:
        notes.push_back(model.where(geom.at) + ": a plane is not felt as a part of a thing");
        continue;
    }
    if (std::ranges::any_of(parts, [&](const FeltPart& known) { return is_same(known, part); })) {
      ++twice;
      if (!keep_doubles) continue;
    }
    if (part.kind != "box" && part.kind != "mesh") ++rounded[part.kind];
    parts.push_back(std::move(part));
  }
  const std::string at = link.geoms.empty() ? "" : model.where(link.geoms.front().it->at) + ": ";
  for (const auto& [kind, count] : rounded)
    notes.push_back(fmt::format("{}{} {}{} felt as polyhedra whose corners lie on them", at, count,
                                kind, count == 1 ? " is" : "s are"));
  if (twice > 0)
    notes.push_back(fmt::format("{}{} geom{} where another of the same size {}: {}", at, twice,
                                twice == 1 ? " stands" : "s stand", twice == 1 ? "does" : "do",
                                keep_doubles ? "all are felt, as all weigh" : "felt once"));
  return parts;
}

std::string felt_obj(const std::vector<FeltPart>& parts) {
  std::string out = fmt::format("# Convex parts, metres. Made by {}.\n", kMujocoGenerator);
  std::size_t first = 1;
  for (const FeltPart& part : parts) {
    for (const Vec3& p : part.corners)
      out += fmt::format("v {:.12g} {:.12g} {:.12g}\n", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
    for (const auto& t : part.triangles)
      out += fmt::format("f {} {} {}\n", first + t[0], first + t[1], first + t[2]);
    first += part.corners.size();
  }
  return out;
}

}  // namespace probe::assets
