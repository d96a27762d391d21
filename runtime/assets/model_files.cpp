#include "runtime/assets/model_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/assets/hollow.h"
#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/glb_writer.h"

namespace probe::assets {
namespace {

void grow(Extent& extent, const Vec3& p, bool first) {
  extent.min = first ? p : Vec3(extent.min.cwiseMin(p));
  extent.max = first ? p : Vec3(extent.max.cwiseMax(p));
}

void move(scene::Mesh& mesh, const Pose& place) {
  const Mat3 turn = place.rotation.toRotationMatrix();
  for (scene::MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i < part.positions.size(); i += 3) {
      const Vec3 p = turn * Vec3(part.positions[i], part.positions[i + 1], part.positions[i + 2]) +
                     place.position;
      const Vec3 n = turn * Vec3(part.normals[i], part.normals[i + 1], part.normals[i + 2]);
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = i + static_cast<std::size_t>(k);
        part.positions[at] = static_cast<float>(p[k]);
        part.normals[at] = static_cast<float>(n[k]);
      }
    }
  }
}

// Nine digits bring a float back; vertices stay shared as they are, so components do too.
std::string obj_text(const scene::TriangleSoup& soup) {
  std::string out = fmt::format("# Convex parts, metres. Made by {}.\n", kGenerator);
  for (const Vec3& p : soup.vertices) {
    out += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
  }
  for (std::size_t i = 0; i + 2 < soup.indices.size(); i += 3) {
    out += fmt::format("f {} {} {}\n", soup.indices[i] + 1, soup.indices[i + 1] + 1,
                       soup.indices[i + 2] + 1);
  }
  return out;
}

// The hull of a shape's only part, as triangles in the model frame.
scene::TriangleSoup hull_triangles(const scene::CollisionShape& shape) {
  scene::TriangleSoup soup;
  add_triangles(shape.parts.front(), shape.center_of_mass, soup);
  return soup;
}

}  // namespace

Extent extent_of(const scene::Mesh& mesh) {
  Extent extent;
  bool first = true;
  for (const scene::MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i < part.positions.size(); i += 3) {
      grow(extent, {part.positions[i], part.positions[i + 1], part.positions[i + 2]}, first);
      first = false;
    }
  }
  return extent;
}

Extent extent_of(const scene::TriangleSoup& soup) {
  Extent extent;
  bool first = true;
  for (const std::uint32_t i : soup.indices) {
    grow(extent, soup.vertices[i], first);
    first = false;
  }
  return extent;
}

std::string size_text(const Vec3& size) {
  return fmt::format("{:.3g} x {:.3g} x {:.3g} cm", 100 * size.x(), 100 * size.y(), 100 * size.z());
}

Result<VisualFile> convert_visual(const std::string& path, const Vec3& scale,
                                  const scene::MeshLimits& limits, const std::string& name,
                                  const Pose& place) {
  scene::MeshLimits keeping = limits;
  keeping.keep_encoded = true;
  PROBE_ASSIGN(const auto loaded, scene::load_mesh(path, scale, keeping));
  scene::Mesh mesh = *loaded;
  if (place.position != Vec3::Zero() || place.rotation.w() != 1) move(mesh, place);
  VisualFile file;
  file.extent = extent_of(mesh);
  for (const scene::MeshPart& part : mesh.parts) file.triangles += part.indices.size() / 3;
  for (const scene::Texture& texture : mesh.textures) {
    file.largest_texture = std::max({file.largest_texture, texture.width, texture.height});
  }
  PROBE_ASSIGN(file.glb, scene::glb_bytes(mesh, name, kGenerator));
  return file;
}

Result<CollisionFile> convert_collision(const std::string& path, const Vec3& scale,
                                        const scene::MeshLimits& limits, bool from_visual,
                                        const Pose& place, bool hollow) {
  PROBE_ASSIGN(scene::TriangleSoup soup, scene::load_triangles(path, scale, limits));
  for (Vec3& p : soup.vertices) p = place.apply(p);
  CollisionFile file;
  const double enclosed = enclosed_volume(soup);
  if (hollow) {
    PROBE_ASSIGN(soup, split_hollow(soup, path));
  }
  file.extent = extent_of(soup);
  PROBE_ASSIGN(scene::CollisionShape shape, scene::make_mesh_shape(soup, path));
  if (from_visual) file.odd = "no collision mesh, its convex parts are taken from the picture mesh";
  if (shape.parts.size() > scene::kMaxCollisionParts) {
    file.odd =
        fmt::format("{} falls into {} pieces: one hull round everything is felt",
                    from_visual ? "no collision mesh and the picture mesh" : "the collision mesh",
                    shape.parts.size());
    PROBE_ASSIGN(shape, scene::make_mesh_shape(soup, path, {.single_hull = true}));
    soup = hull_triangles(shape);
  }
  file.parts = shape.parts.size();
  if (enclosed > 0 && shape.volume > enclosed) file.filled = 1 - enclosed / shape.volume;
  file.obj = obj_text(soup);
  return file;
}

}  // namespace probe::assets
