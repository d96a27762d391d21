#include "runtime/assets/mujoco_seen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/trig.h"
#include "runtime/mjcf/mass.h"
#include "runtime/mjcf/read.h"
#include "runtime/scene/color.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;
using mjcf::Geom;
using mjcf::Shape;
using mjcf::Texture;

constexpr int kSlices = 28, kStacks = 16, kSquares = 4;  // MuJoCo's visual/quality

struct Corner {
  Vec3 position, normal;      // in the geom's frame, m
  Vec3 texel = Vec3::Zero();  // what texture coordinates are made from, or u and v
};
using Triangle = std::array<Corner, 3>;

// ---- shapes, in the geom's frame

void add_square(std::vector<Triangle>& out, const Vec3& middle, const Vec3& right, const Vec3& up,
                int across = kSquares, int along = kSquares) {
  const Vec3 normal = right.cross(up).normalized();
  const auto at = [&](int i, int k) {
    return Corner{middle + (2.0 * i / across - 1) * right + (2.0 * k / along - 1) * up, normal};
  };
  for (int i = 0; i < across; ++i) {
    for (int k = 0; k < along; ++k) {
      out.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      out.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
}

// Squares along a plane of half that size.
int lines_of(double half, double apart) {
  constexpr double kMost = 200;
  if (!(apart > 0)) return kSquares;
  return static_cast<int>(std::clamp(std::ceil(2 * half / apart - 1e-9), 1.0, kMost));
}

std::vector<Triangle> box_triangles(const Vec3& half) {
  std::vector<Triangle> out;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      const Vec3 right = half[side > 0 ? a : b] * Vec3::Unit(side > 0 ? a : b);
      const Vec3 up = half[side > 0 ? b : a] * Vec3::Unit(side > 0 ? b : a);
      add_square(out, side * half[axis] * Vec3::Unit(axis), right, up);
    }
  }
  return out;
}

// Rows of corners from below, closed about z; rows of one radius 0 are poles.
void add_turned(std::vector<Triangle>& out, const std::vector<std::array<double, 4>>& rows) {
  const auto at = [&](std::size_t row, int i) {
    const SinCos turn = portable_sincos_deg(360.0 * (i % kSlices) / kSlices);
    const auto& [radius, z, across, along] = rows[row];
    return Corner{Vec3(radius * turn.cos, radius * turn.sin, z),
                  Vec3(across * turn.cos, across * turn.sin, along)};
  };
  for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
    for (int i = 0; i < kSlices; ++i) {
      if (rows[r][0] > 0) out.push_back({at(r, i), at(r, i + 1), at(r + 1, i)});
      if (rows[r + 1][0] > 0) out.push_back({at(r, i + 1), at(r + 1, i + 1), at(r + 1, i)});
    }
  }
}

// A half of a ball or a whole one, its middle at `z`.
std::vector<std::array<double, 4>> ball_rows(double radius, double z, int from, int to) {
  std::vector<std::array<double, 4>> rows;
  for (int i = from; i <= to; ++i) {
    const SinCos at = portable_sincos_deg(90.0 * i / (kStacks / 2));
    const double across = std::abs(i) == kStacks / 2 ? 0 : at.cos;
    rows.push_back({radius * across, z + radius * at.sin, across, at.sin});
  }
  return rows;
}

std::vector<Triangle> primitive_triangles(const Geom& geom) {
  constexpr int kHalf = kStacks / 2;
  const Vec3& size = geom.size;
  std::vector<Triangle> out;
  switch (geom.shape) {
    case Shape::kBox:
      return box_triangles(size);
    case Shape::kPlane:
      // The third size of a plane is how far its lines of corners lie apart.
      add_square(out, Vec3::Zero(), size[0] * Vec3::UnitX(), size[1] * Vec3::UnitY(),
                 lines_of(size[0], size[2]), lines_of(size[1], size[2]));
      break;
    case Shape::kSphere:
      add_turned(out, ball_rows(size[0], 0, -kHalf, kHalf));
      break;
    case Shape::kEllipsoid:
      add_turned(out, ball_rows(1, 0, -kHalf, kHalf));
      for (Triangle& triangle : out) {
        for (Corner& corner : triangle) {
          corner.position = corner.position.cwiseProduct(size);
          corner.normal = corner.normal.cwiseQuotient(size).normalized();
        }
      }
      break;
    case Shape::kCapsule: {
      auto rows = ball_rows(size[0], -size[1], -kHalf, 0);
      const auto top = ball_rows(size[0], size[1], 0, kHalf);
      rows.insert(rows.end(), top.begin(), top.end());
      add_turned(out, rows);
      break;
    }
    case Shape::kCylinder: {
      std::vector<std::array<double, 4>> rows;
      for (int i = 0; i <= kStacks; ++i)
        rows.push_back({size[0], (2.0 * i / kStacks - 1) * size[1], 1, 0});
      add_turned(out, rows);
      // From a pole outwards looks down, from a ring inwards up.
      add_turned(out, {{size[0], size[1], 0, 1}, {0, size[1], 0, 1}});
      add_turned(out, {{0, -size[1], 0, -1}, {size[0], -size[1], 0, -1}});
      break;
    }
    case Shape::kMesh:
      break;
  }
  return out;
}

std::vector<Triangle> mesh_triangles(const scene::Mesh& mesh) {
  std::vector<Triangle> out;
  for (const scene::MeshPart& part : mesh.parts) {
    const auto corner = [&](std::uint32_t i) {
      const auto three = [&](const std::vector<float>& of) {
        return Vec3(of[3 * i], of[3 * i + 1], of[3 * i + 2]);
      };
      Corner made{three(part.positions), three(part.normals)};
      if (!part.uv.empty()) made.texel = Vec3(part.uv[2 * i], part.uv[2 * i + 1], 0);
      return made;
    };
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3)
      out.push_back(
          {corner(part.indices[i]), corner(part.indices[i + 1]), corner(part.indices[i + 2])});
  }
  return out;
}

bool has_coordinates(const scene::Mesh& mesh) {
  return std::ranges::all_of(mesh.parts, [](const auto& part) { return !part.uv.empty(); });
}

// ---- textures

// Where MuJoCo lays textures on: primitives in their own frame, meshes in that of their inertia.
void put_texels(std::vector<Triangle>& triangles, const scene::Mesh* mesh) {
  Mat3 turn = Mat3::Identity();
  Vec3 middle = Vec3::Zero();
  if (mesh != nullptr) {
    const mjcf::MassProperties solid = mjcf::solid_of(*mesh, false);
    turn = mjcf::inertia_frame(solid.inertia);
    middle = solid.center;
  }
  for (Triangle& triangle : triangles) {
    for (Corner& corner : triangle) corner.texel = turn.transpose() * (corner.position - middle);
  }
}

Vec3 extent_of(const std::vector<Triangle>& triangles) {
  Vec3 extent = Vec3::Zero();
  for (const Triangle& triangle : triangles) {
    for (const Corner& corner : triangle) extent = extent.cwiseMax(corner.texel.cwiseAbs());
  }
  return extent.cwiseMax(1e-15);
}

// src/render/render_gl3.c, settexture: s = x / 2 - 1 / 2 of what is repeated.
void generate_2d(std::vector<Triangle>& triangles, const mjcf::Material& material,
                 const Vec3& extent) {
  const double across = material.repeat[0] / (material.uniform ? 1 : extent.x());
  const double down = material.repeat[1] / (material.uniform ? 1 : extent.y());
  for (Triangle& triangle : triangles) {
    for (Corner& corner : triangle)
      corner.texel =
          Vec3(0.5 * across * corner.texel.x() - 0.5, -0.5 * down * corner.texel.y() - 0.5, 0);
  }
}

Corner between(const Corner& a, const Corner& b, double t) {
  return {a.position + t * (b.position - a.position), a.normal + t * (b.normal - a.normal),
          a.texel + t * (b.texel - a.texel)};
}

// What of a triangle lies in the pyramid over a face of the cube; its texels become u and v
// (OpenGL 2.1, table 3.19).
void cut_to_face(const Triangle& triangle, int face, std::vector<Triangle>& out) {
  const int axis = face / 2;
  const double sign = face % 2 == 0 ? 1 : -1;
  std::vector<Corner> left(triangle.begin(), triangle.end());
  for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
    for (const double side : {-1.0, 1.0}) {
      const auto height = [&](const Corner& c) {
        return sign * c.texel[axis] + side * c.texel[other];
      };
      std::vector<Corner> kept;
      for (std::size_t i = 0; i < left.size(); ++i) {
        const Corner& a = left[i];
        const Corner& b = left[(i + 1) % left.size()];
        const double ha = height(a), hb = height(b);
        if (ha >= 0) kept.push_back(a);
        if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) kept.push_back(between(a, b, ha / (ha - hb)));
      }
      left = std::move(kept);
    }
  }
  for (Corner& c : left) {
    const Vec3& p = c.texel;
    const double deep = std::max(std::abs(p[axis]), 1e-12);
    const double across = axis == 0 ? -sign * p.z() : axis == 1 ? p.x() : sign * p.x();
    const double down = axis == 1 ? sign * p.z() : -p.y();
    c.texel = Vec3((across / deep + 1) / 2, (down / deep + 1) / 2, 0);
  }
  for (std::size_t i = 1; i + 1 < left.size(); ++i) {
    const Vec3 area =
        (left[i].position - left[0].position).cross(left[i + 1].position - left[0].position);
    if (area.norm() > 1e-14) out.push_back({left[0], left[i], left[i + 1]});
  }
}

// ---- glTF

class Builder {
 public:
  Builder(const mjcf::Model& model, MujocoPictures& pictures, std::vector<std::string>& notes)
      : model_(model), pictures_(pictures), notes_(notes) {}

  Status add(const Geom& geom, const Pose& pose, const scene::Mesh* mesh) {
    std::vector<Triangle> triangles =
        mesh != nullptr ? mesh_triangles(*mesh) : primitive_triangles(geom);
    const mjcf::Material* material =
        geom.material == mjcf::kNone ? nullptr : &model_.materials[at(geom.material)];
    const Texture* texture = material == nullptr || material->texture == mjcf::kNone
                                 ? nullptr
                                 : &model_.textures[at(material->texture)];
    const bool own = mesh != nullptr && has_coordinates(*mesh);
    if (texture != nullptr && texture->builtin != Texture::Builtin::kFile) {
      mjcf::Rgba rgba = geom.rgba;
      for (std::size_t i = 0; i < 3; ++i) rgba[i] *= texture->rgb1[i];
      if (texture->builtin != Texture::Builtin::kFlat)
        notes_.push_back(model_.where(texture->at) +
                         ": a builtin gradient or checker is drawn as its first colour");
      return put(triangles, pose, color(rgba, material), false);
    }
    if (texture == nullptr) return put(triangles, pose, color(geom.rgba, material), false);
    if (texture->type == Texture::Type::k2d || own) {
      const std::string& file = texture->file;
      if (!own) {
        put_texels(triangles, mesh);
        generate_2d(triangles, *material, mesh != nullptr ? extent_of(triangles) : geom.size);
      } else if (texture->type != Texture::Type::k2d) {
        return put(triangles, pose, color(geom.rgba, material), false);
      }
      PROBE_ASSIGN(const std::size_t of, picture(*texture, file, geom.rgba, material));
      // MuJoCo mirrors on planes and the upper faces of boxes alone.
      const bool is_box = geom.shape == Shape::kBox;
      if (material->reflectance > 0 && (is_box || geom.shape == Shape::kPlane)) {
        const auto is_upper = [&](const Triangle& triangle) {
          return !is_box || triangle[0].normal.z() > 0.5;
        };
        std::vector<Triangle> upper, rest;
        for (const Triangle& triangle : triangles)
          (is_upper(triangle) ? upper : rest).push_back(triangle);
        if (!rest.empty()) PROBE_TRY(put(rest, pose, of, true));
        return put(upper, pose, mirror_of(of, material->reflectance), true);
      }
      return put(triangles, pose, of, true);
    }
    return add_cube(triangles, geom, pose, mesh, *material, *texture);
  }

  scene::GlbDocument take(const std::string& name) {
    document_.name = name;
    document_.generator = kMujocoGenerator;
    return std::move(document_);
  }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  Status add_cube(std::vector<Triangle>& triangles, const Geom& geom, const Pose& pose,
                  const scene::Mesh* mesh, const mjcf::Material& material, const Texture& texture) {
    put_texels(triangles, mesh);
    const Vec3 extent = mesh != nullptr ? extent_of(triangles) : Vec3(geom.size.cwiseMax(1e-15));
    for (Triangle& triangle : triangles) {
      for (Corner& corner : triangle) {
        if (mesh == nullptr) corner.texel = corner.texel.cwiseQuotient(extent);
        if (material.uniform) corner.texel = corner.texel.cwiseProduct(extent);
      }
    }
    for (int face = 0; face < 6; ++face) {
      std::vector<Triangle> cut;
      for (const Triangle& triangle : triangles) cut_to_face(triangle, face, cut);
      if (cut.empty()) continue;
      const std::string& own = texture.faces[at(face)];
      const std::string& file = own.empty() ? texture.file : own;
      std::size_t of = 0;
      if (file.empty()) {
        of = color(geom.rgba, &material);
      } else {
        PROBE_ASSIGN(of, picture(texture, file, geom.rgba, &material));
      }
      PROBE_TRY(put(cut, pose, of, !file.empty()));
    }
    return {};
  }

  std::size_t color(const mjcf::Rgba& rgba, const mjcf::Material* material) {
    return material_of({"", rgba, surface(material)}, -1);
  }

  // Emission, specular, shininess.
  using Surface = std::array<double, 3>;
  static Surface surface(const mjcf::Material* material) {
    static const mjcf::Material kPlain;
    const mjcf::Material& of = material == nullptr ? kPlain : *material;
    return {of.emission, of.specular, of.shininess};
  }

  // The same material as a metal: what is flat of it mirrors by so much.
  std::size_t mirror_of(std::size_t of, double reflectance) {
    scene::GlbMaterial made = document_.materials[of];
    made.name = fmt::format("material_{}", document_.materials.size());
    made.metallic = std::min(reflectance, 1.0);
    document_.materials.push_back(std::move(made));
    return document_.materials.size() - 1;
  }

  Result<std::size_t> picture(const Texture& texture, const std::string& file,
                              const mjcf::Rgba& rgba, const mjcf::Material* material) {
    const Key key{
        file + (texture.flip_across ? "|across" : "") + (texture.flip_down ? "|down" : ""), rgba,
        surface(material)};
    const auto known = materials_.find(key);
    if (known != materials_.end()) return known->second;
    PROBE_ASSIGN(scene::EncodedImage image, pictures_.get(model_, texture, file, rgba));
    document_.images.push_back(std::move(image));
    return material_of(key, static_cast<int>(document_.images.size()) - 1);
  }

  using Key = std::tuple<std::string, mjcf::Rgba, Surface>;
  std::size_t material_of(const Key& key, int image) {
    const auto [found, is_new] = materials_.try_emplace(key, document_.materials.size());
    if (!is_new) return found->second;
    scene::GlbMaterial made;
    made.name = fmt::format("material_{}", document_.materials.size());
    const auto& [file, rgba, surface] = key;
    const double glow = surface[0];
    made.specular = surface[1];
    made.shininess = std::min(surface[2], 1.0);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto byte = [](double value) {
        return static_cast<std::size_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
      };
      made.base_color[i] = scene::kSrgbToLinear[byte(rgba[i])];
      made.emission[i] = scene::kSrgbToLinear[byte(glow * rgba[i])];
    }
    made.base_color_image = image;
    made.roughness = 1;
    made.metallic = 0;
    made.opacity = rgba[3];
    document_.materials.push_back(std::move(made));
    return found->second;
  }

  Status put(const std::vector<Triangle>& triangles, const Pose& pose, std::size_t material,
             bool has_texels) {
    scene::GlbPart part;
    part.material = material;
    // Corners that are the same in all they have are one.
    std::map<std::array<float, 8>, std::uint32_t> known;
    for (const Triangle& triangle : triangles) {
      for (const Corner& corner : triangle) {
        const Vec3 p = pose.apply(corner.position);
        const Vec3 n = (pose.rotation * corner.normal).normalized();
        const auto f = [](double v) { return static_cast<float>(v) + 0.0f; };
        const std::array<float, 8> all{f(p.x()),
                                       f(p.y()),
                                       f(p.z()),
                                       f(n.x()),
                                       f(n.y()),
                                       f(n.z()),
                                       has_texels ? f(corner.texel.x()) : 0,
                                       has_texels ? f(corner.texel.y()) : 0};
        const auto [found, is_new] =
            known.try_emplace(all, static_cast<std::uint32_t>(part.positions.size() / 3));
        if (is_new) {
          part.positions.insert(part.positions.end(), all.begin(), all.begin() + 3);
          part.normals.insert(part.normals.end(), all.begin() + 3, all.begin() + 6);
          if (has_texels) part.uv.insert(part.uv.end(), all.begin() + 6, all.end());
        }
        part.indices.push_back(found->second);
      }
    }
    document_.parts.push_back(std::move(part));
    return {};
  }

  const mjcf::Model& model_;
  MujocoPictures& pictures_;
  std::vector<std::string>& notes_;
  scene::GlbDocument document_;
  std::map<Key, std::size_t> materials_;
};

std::string mime_of(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  return "";
}

void flip(scene::Texture& picture, bool across, bool down) {
  const auto pixel = [&](int x, int y) {
    return picture.rgba.begin() + 4 * (static_cast<std::ptrdiff_t>(y) * picture.width + x);
  };
  for (int y = 0; across && y < picture.height; ++y) {
    for (int x = 0; x < picture.width / 2; ++x)
      std::swap_ranges(pixel(x, y), pixel(x, y) + 4, pixel(picture.width - 1 - x, y));
  }
  for (int y = 0; down && y < picture.height / 2; ++y)
    std::swap_ranges(pixel(0, y), pixel(0, y) + 4 * picture.width,
                     pixel(0, picture.height - 1 - y));
}

}  // namespace

std::set<int> seen_groups(const std::vector<MujocoLink>& links) {
  std::set<int> groups;
  for (const MujocoLink& link : links) {
    for (const Placed<Geom>& placed : link.geoms) {
      if (!placed.it->can_touch()) groups.insert(placed.it->group);
    }
  }
  std::erase_if(groups, [](int group) { return group < 0 || group > 2; });
  if (groups.empty()) groups = {0, 1, 2};
  return groups;
}

Result<scene::EncodedImage> MujocoPictures::get(const mjcf::Model& model, const Texture& texture,
                                                const std::string& file, const mjcf::Rgba& rgba) {
  const auto fail = [&](const std::string& message) {
    return Failure{Fault::kAsset, "texture `" + file + "`: " + message, model.where(texture.at)};
  };
  auto known = pictures_.find(file);
  if (known == pictures_.end()) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return fail("no such file");
    constexpr std::size_t kMostBytes = std::size_t{256} << 20;
    auto bytes = read_file(file, {.most = kMostBytes, .code = Fault::kAsset, .only_begin = false});
    if (!bytes) return fail(bytes.failure().message);
    auto decoded = scene::decode_image(std::as_bytes(std::span(*bytes)), file);
    if (!decoded) return fail(decoded.failure().message);
    Picture picture;
    picture.encoded = {*std::move(bytes), ""};
    picture.encoded.mime = mime_of(picture.encoded.bytes);
    picture.decoded = *std::move(decoded);
    known = pictures_.emplace(file, std::move(picture)).first;
  }
  const Picture& picture = known->second;
  const bool white = rgba[0] == 1 && rgba[1] == 1 && rgba[2] == 1;
  if (white && !texture.flip_across && !texture.flip_down && !picture.encoded.mime.empty())
    return picture.encoded;
  scene::Texture changed = picture.decoded;
  flip(changed, texture.flip_across, texture.flip_down);
  for (std::size_t i = 0; i < changed.rgba.size(); i += 4) {
    for (std::size_t k = 0; k < 3; ++k)
      changed.rgba[i + k] = static_cast<std::uint8_t>(std::lround(changed.rgba[i + k] * rgba[k]));
  }
  PROBE_ASSIGN(std::string bytes, scene::png_bytes(changed));
  return scene::EncodedImage{std::move(bytes), "image/png"};
}

Result<std::string> seen_link(const mjcf::Model& model, const MujocoLink& link,
                              const std::set<int>& groups, const std::string& name,
                              MujocoMeshes& meshes, MujocoPictures& pictures,
                              std::vector<std::string>& notes) {
  Builder builder(model, pictures, notes);
  bool any = false;
  for (const Placed<Geom>& placed : link.geoms) {
    const Geom& geom = *placed.it;
    if (!groups.contains(geom.group) || geom.rgba[3] == 0) continue;
    const std::string where = model.where(geom.at) + ": ";
    // What is seen through is drawn into some of a pixel's four samples.
    const double quarters = std::round(4 * geom.rgba[3]);
    if (quarters == 0) {
      notes.push_back(fmt::format("{}a geom of opacity {:g} is not drawn", where, geom.rgba[3]));
      continue;
    }
    if (quarters != 4 * geom.rgba[3])
      notes.push_back(fmt::format("{}a geom of opacity {:g} is drawn as one of {:g}", where,
                                  geom.rgba[3], quarters / 4));
    if (geom.shape == Shape::kPlane && (geom.size[0] == 0 || geom.size[1] == 0)) {
      notes.push_back(where + "a plane without end is not drawn");
      continue;
    }
    const scene::Mesh* mesh = nullptr;
    if (geom.shape == Shape::kMesh) {
      PROBE_ASSIGN(mesh, meshes.get(geom.mesh));
    }
    PROBE_TRY(builder.add(geom, placed.pose, mesh));
    any = true;
  }
  if (!any) return std::string();
  const scene::GlbDocument document = builder.take(name);
  const bool has_triangles = std::ranges::any_of(
      document.parts, [](const scene::GlbPart& part) { return !part.indices.empty(); });
  return has_triangles ? scene::glb_bytes(document) : std::string();
}

Result<std::map<std::string, std::string>> seen_bodies(
    const std::string& file, const std::string& merged_into,
    const std::map<std::string, std::string>& names, std::vector<std::string>& notes) {
  PROBE_ASSIGN(const mjcf::Model model, mjcf::read_model(file, {merged_into}));
  scene::MeshLimits limits;
  limits.asset_root = fs::absolute(file).lexically_normal().parent_path().parent_path().string();
  MujocoMeshes meshes(model, limits);
  MujocoPictures pictures;
  std::map<std::string, MujocoLink> links;
  for (const auto& [body, name] : names) {
    const auto found = std::ranges::find(model.bodies, body, &mjcf::Body::name);
    if (found == model.bodies.end())
      return Failure{Fault::kAsset, "there is no body `" + body + "`", file};
    MujocoLink& link = links[name];
    for (const Geom& geom : found->geoms) link.geoms.push_back({&geom, geom.pose});
  }
  std::vector<MujocoLink> all;
  for (const auto& [name, link] : links) all.push_back(link);
  const std::set<int> groups = seen_groups(all);
  std::map<std::string, std::string> made;
  for (const auto& [name, link] : links) {
    PROBE_ASSIGN(std::string glb, seen_link(model, link, groups, name, meshes, pictures, notes));
    if (!glb.empty()) made[name] = std::move(glb);
  }
  return made;
}

}  // namespace probe::assets
