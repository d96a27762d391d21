#include "runtime/mjcf/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/mjcf/mass.h"
#include "runtime/mjcf/obj_file.h"

namespace probe::mjcf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMeshBytes = std::size_t{512} << 20;

Vec3 at(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void put(std::vector<float>& values, std::size_t i, const Vec3& v) {
  for (std::size_t k = 0; k < 3; ++k)
    values[3 * i + k] = static_cast<float>(v[static_cast<Eigen::Index>(k)]);
}

// Every triangle has corners of its own, and so one normal, as MuJoCo shows STL files.
scene::MeshPart faceted(const scene::MeshPart& part) {
  scene::MeshPart made;
  for (const std::uint32_t i : part.indices) {
    made.indices.push_back(static_cast<std::uint32_t>(made.indices.size()));
    for (std::size_t k = 0; k < 3; ++k) made.positions.push_back(part.positions[3 * i + k]);
  }
  return made;
}

// `elsewhere`: of a corner all of whose faces turn away from their mean.
void make_normals(scene::MeshPart& part, const Vec3& elsewhere) {
  const std::size_t count = part.positions.size() / 3;
  std::vector<Vec3> mean(count, Vec3::Zero());
  std::vector<Vec3> faces;  // twice the area along the normal
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    const Vec3 a = at(part.positions, part.indices[i]);
    const Vec3 face = (at(part.positions, part.indices[i + 1]) - a)
                          .cross(at(part.positions, part.indices[i + 2]) - a);
    faces.push_back(face);
    for (std::size_t k = 0; k < 3; ++k) mean[part.indices[i + k]] += face;
  }
  std::vector<Vec3> kept(count, Vec3::Zero());
  constexpr double kElsewhere = 0.8;
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    const Vec3& face = faces[i / 3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = part.indices[i + k];
      if (face.dot(mean[corner]) >= kElsewhere * face.norm() * mean[corner].norm())
        kept[corner] += face;
    }
  }
  part.normals.resize(part.positions.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double length = kept[i].norm();
    put(part.normals, i, length > 1e-15 ? Vec3(kept[i] / length) : elsewhere);
  }
}

}  // namespace

Result<scene::Mesh> msh_mesh(std::string_view bytes, const std::string& name,
                             const scene::MeshLimits& limits) {
  const auto fail = [&](std::string message) {
    return Failure{Fault::kAsset, std::move(message), name};
  };
  std::int32_t sizes[4] = {};
  if (bytes.size() < sizeof sizes) return fail("not a .msh mesh: no room for its sizes");
  std::memcpy(sizes, bytes.data(), sizeof sizes);
  const auto [vertices, normals, coordinates, faces] = std::to_array(sizes);
  if (vertices < 3 || faces < 1 || (normals != 0 && normals != vertices) ||
      (coordinates != 0 && coordinates != vertices))
    return fail(
        fmt::format("not a .msh mesh: {} vertices, {} normals, {} texture coordinates, {} faces",
                    vertices, normals, coordinates, faces));
  if (static_cast<std::size_t>(faces) > limits.triangles)
    return fail(fmt::format("has {} triangles, at most {}", faces, limits.triangles));
  const auto n = [](std::int32_t v) { return static_cast<std::size_t>(v); };
  const std::size_t expected =
      sizeof sizes + 4 * (3 * n(vertices) + 3 * n(normals) + 2 * n(coordinates) + 3 * n(faces));
  if (bytes.size() != expected)
    return fail(fmt::format("a .msh mesh of {} bytes whose sizes say {}", bytes.size(), expected));
  scene::Mesh mesh;
  mesh.name = name;
  mesh.materials.emplace_back();
  scene::MeshPart& part = mesh.parts.emplace_back();
  const char* from = bytes.data() + sizeof sizes;
  const auto take = [&](auto& to, std::size_t count) {
    to.resize(count);
    if (count == 0) return;
    std::memcpy(to.data(), from, 4 * count);
    from += 4 * count;
  };
  take(part.positions, 3 * n(vertices));
  take(part.normals, 3 * n(normals));
  take(part.uv, 2 * n(coordinates));
  take(part.indices, 3 * n(faces));
  for (const auto* values : {&part.positions, &part.normals, &part.uv}) {
    for (const float value : *values) {
      if (!std::isfinite(value)) return fail("has a number that is not finite");
    }
  }
  for (const std::uint32_t index : part.indices) {
    if (index >= n(vertices)) return fail("a face names a vertex that is not there");
  }
  return mesh;
}

Result<scene::Mesh> load_mesh_file(const Model& model, const MeshAsset& asset,
                                   const scene::MeshLimits& limits) {
  const std::string where = model.where(asset.at);
  const auto fail = [&](const std::string& message) {
    return Failure{Fault::kAsset, "mesh `" + asset.file + "`: " + message, where};
  };
  std::error_code error;
  if (!fs::is_regular_file(asset.file, error)) return fail("no such file");
  scene::Mesh mesh;
  bool has_facets = false;
  const std::string extension = lower_extension(asset.file);
  if (extension == ".msh") {
    auto bytes =
        read_file(asset.file, {.most = kMostMeshBytes, .code = Fault::kAsset, .only_begin = false});
    if (!bytes) return fail(bytes.failure().message);
    auto read = msh_mesh(*bytes, asset.file, limits);
    if (!read) return fail(read.failure().message);
    mesh = *std::move(read);
  } else if (extension == ".obj") {
    auto bytes =
        read_file(asset.file, {.most = kMostMeshBytes, .code = Fault::kAsset, .only_begin = false});
    if (!bytes) return fail(bytes.failure().message);
    auto read = read_obj(*bytes, asset.file, limits.triangles);
    if (!read) return fail(to_text(read.failure()));
    mesh = *std::move(read);
  } else if (extension == ".stl") {
    const auto read = scene::load_mesh(asset.file, {1, 1, 1}, limits);
    if (!read) return fail(read.failure().message);
    mesh.parts = (*read)->parts;
    has_facets = true;
  } else {
    return fail("a mesh is .msh, .stl or .obj");
  }
  mesh.name = asset.file;
  mesh.textures.clear();
  mesh.encoded.clear();
  mesh.materials.assign(1, scene::Material{});
  const Mat3 turn = asset.turn.toRotationMatrix().transpose();
  const bool mirrors = asset.scale.prod() < 0;
  for (scene::MeshPart& part : mesh.parts) {
    part.material = 0;
    if (has_facets) part = faceted(part);
    for (std::size_t i = 0; i < part.positions.size() / 3; ++i) {
      const Vec3 p = (turn * (at(part.positions, i) - asset.origin)).cwiseProduct(asset.scale);
      if (!(p.cwiseAbs().maxCoeff() <= limits.extent))
        return fail(fmt::format("lies farther than {} m from its origin", limits.extent));
      put(part.positions, i, p);
    }
    for (std::size_t i = 0; i < part.normals.size() / 3; ++i) {
      const Vec3 n = (turn * at(part.normals, i)).cwiseQuotient(asset.scale);
      const double length = n.norm();
      put(part.normals, i, length > 0 ? Vec3(n / length) : Vec3(Vec3::UnitZ()));
    }
    if (mirrors) {
      for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3)
        std::swap(part.indices[i + 1], part.indices[i + 2]);
    }
  }
  // MuJoCo makes normals after it turned a mesh into the frame of its inertia, and where none is
  // left over it takes that frame's z.
  const auto lacks = [](const scene::MeshPart& part) { return part.normals.empty(); };
  if (std::ranges::any_of(mesh.parts, lacks)) {
    const Vec3 along = inertia_frame(solid_of(mesh, false).inertia).col(2);
    for (scene::MeshPart& part : mesh.parts) {
      if (lacks(part)) make_normals(part, along);
    }
  }
  return mesh;
}

}  // namespace probe::mjcf
