#include "runtime/render/mesh_geometry.h"

#include <algorithm>
#include <cmath>

namespace probe::render {
namespace {

Failure mesh_failure(const scene::Mesh& mesh, const std::string& message) {
  return {.code = Fault::kRender, .message = message, .where = mesh.name};
}

TriangleData make_triangle(const scene::MeshPart& part, std::size_t first) {
  TriangleData t{};
  const std::size_t a = part.indices[first], b = part.indices[first + 1],
                    c = part.indices[first + 2];
  Vec3 e1, e2;
  for (std::size_t k = 0; k < 3; ++k) {
    t.p0[k] = part.positions[3 * a + k];
    t.e1[k] = part.positions[3 * b + k] - t.p0[k];
    t.e2[k] = part.positions[3 * c + k] - t.p0[k];
    t.n0[k] = part.normals[3 * a + k];
    t.n1[k] = part.normals[3 * b + k];
    t.n2[k] = part.normals[3 * c + k];
    e1[static_cast<Eigen::Index>(k)] = t.e1[k];
    e2[static_cast<Eigen::Index>(k)] = t.e2[k];
  }
  const Vec3 cross = e1.cross(e2);
  const double length = cross.norm();
  for (std::size_t k = 0; k < 3; ++k) {
    t.g[k] = length > 0 ? static_cast<float>(cross[static_cast<Eigen::Index>(k)] / length) : 0.0f;
  }
  if (!part.uv.empty()) {
    for (std::size_t k = 0; k < 2; ++k) {
      t.uv0[k] = part.uv[2 * a + k];
      t.uv1[k] = part.uv[2 * b + k];
      t.uv2[k] = part.uv[2 * c + k];
    }
  }
  return t;
}

// What covers less than half shows nothing here: a ray meets a surface or does not. A mesh of such
// parts alone is shown whole.
std::vector<bool> shown_parts(const scene::Mesh& mesh) {
  std::vector<bool> shown;
  for (const scene::MeshPart& part : mesh.parts) {
    const auto of = static_cast<std::size_t>(part.material);
    shown.push_back(of >= mesh.materials.size() || mesh.materials[of].opacity >= 0.5f);
  }
  if (std::ranges::find(shown, true) == shown.end()) shown.assign(shown.size(), true);
  return shown;
}

}  // namespace

Status check_texture(const scene::Mesh& mesh, int index) {
  if (index < 0) return {};
  if (static_cast<std::size_t>(index) >= mesh.textures.size()) {
    return mesh_failure(mesh, "a material names texture " + std::to_string(index) + " of " +
                                  std::to_string(mesh.textures.size()));
  }
  const scene::Texture& texture = mesh.textures[static_cast<std::size_t>(index)];
  const bool sized = texture.width > 0 && texture.height > 0;
  if (!sized || texture.rgba.size() != 4 * static_cast<std::size_t>(texture.width) *
                                           static_cast<std::size_t>(texture.height)) {
    return mesh_failure(mesh,
                        "texture " + std::to_string(index) + " has not width x height texels");
  }
  return {};
}

Status check_part(const scene::Mesh& mesh, const scene::MeshPart& part) {
  const std::size_t vertices = part.positions.size() / 3;
  if (part.material < 0 || static_cast<std::size_t>(part.material) >= mesh.materials.size()) {
    return mesh_failure(mesh, "a part names a material that is not there");
  }
  if (part.positions.size() != 3 * vertices || part.normals.size() != 3 * vertices ||
      (!part.uv.empty() && part.uv.size() != 2 * vertices) || part.indices.size() % 3 != 0) {
    return mesh_failure(mesh, "a part's arrays differ in length");
  }
  for (const std::uint32_t index : part.indices) {
    if (index >= vertices) return mesh_failure(mesh, "a triangle names a vertex that is not there");
  }
  for (const auto* values : {&part.positions, &part.normals, &part.uv}) {
    for (const float value : *values) {
      if (!std::isfinite(value)) return mesh_failure(mesh, "a vertex is not finite");
    }
  }
  for (const float value : part.uv) {
    // Far beyond any tiling; a float has no fraction left there.
    if (std::abs(value) > 1e6f)
      return mesh_failure(mesh, "a texture coordinate is beyond a million");
  }
  return {};
}

Result<std::shared_ptr<const MeshGeometry>> MeshGeometry::build(
    std::shared_ptr<const scene::Mesh> mesh) {
  auto geometry = std::make_shared<MeshGeometry>();
  PROBE_ASSIGN(geometry->device, EmbreeDevice::shared());
  const FlushDenormals guard;
  RTCDevice device = geometry->device->get();
  geometry->scene.reset(rtcNewScene(device));
  rtcSetSceneFlags(geometry->scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(geometry->scene.get(), RTC_BUILD_QUALITY_HIGH);

  std::size_t triangles = 0;
  const std::vector<bool> shown = shown_parts(*mesh);
  // Embree keeps pointers into the parts, so the vector must not move afterwards.
  geometry->parts.resize(mesh->parts.size());
  for (std::size_t p = 0; p < mesh->parts.size(); ++p) {
    const scene::MeshPart& source = mesh->parts[p];
    PROBE_TRY(check_part(*mesh, source));
    MeshGeometry::Part& part = geometry->parts[p];
    part.material = mesh->materials[static_cast<std::size_t>(source.material)];
    PROBE_TRY(check_texture(*mesh, part.material.base_color_texture));
    PROBE_TRY(check_texture(*mesh, part.material.emission_texture));
    if (!shown[p]) continue;
    if (part.material.base_color_texture >= 0) {
      part.base_color = &mesh->textures[static_cast<std::size_t>(part.material.base_color_texture)];
    }
    if (part.material.emission_texture >= 0) {
      part.emission = &mesh->textures[static_cast<std::size_t>(part.material.emission_texture)];
    }
    part.indices = source.indices;
    part.positions = source.positions;
    part.positions.resize(source.positions.size() + 4, 0.0f);
    const std::size_t vertices = source.positions.size() / 3;
    part.x.resize(vertices);
    part.y.resize(vertices);
    part.z.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      part.x[v] = source.positions[3 * v];
      part.y[v] = source.positions[3 * v + 1];
      part.z[v] = source.positions[3 * v + 2];
      part.reach = std::max(part.reach, std::hypot(part.x[v], part.y[v], part.z[v]));
    }
    part.triangles.reserve(part.indices.size() / 3);
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      part.triangles.push_back(make_triangle(source, i));
    }
    triangles += part.triangles.size();

    const GeometryPtr handle(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(handle.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               part.positions.data(), 0, 3 * sizeof(float), vertices);
    rtcSetSharedGeometryBuffer(handle.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               part.indices.data(), 0, 3 * sizeof(std::uint32_t),
                               part.triangles.size());
    rtcSetGeometryBuildQuality(handle.get(), RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(handle.get());
    rtcAttachGeometryByID(geometry->scene.get(), handle.get(), static_cast<unsigned>(p));
  }
  if (triangles == 0) return mesh_failure(*mesh, "the mesh has no triangles");
  rtcCommitScene(geometry->scene.get());
  PROBE_TRY(geometry->device->check("building the ray structure of " + mesh->name));
  geometry->mesh = std::move(mesh);
  return std::shared_ptr<const MeshGeometry>(std::move(geometry));
}

}  // namespace probe::render
