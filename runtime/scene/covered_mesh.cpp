#include "runtime/scene/covered_mesh.h"

#include <algorithm>
#include <cmath>

#include "runtime/scene/color.h"

namespace probe::scene {
namespace {

Vec3 vec_at(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void append(std::vector<float>& to, const Vec3& value) {
  for (int k = 0; k < 3; ++k) to.push_back(static_cast<float>(value[k]));
}

// Texture coordinates of a point of a plane that looks along `normal`, in pictures; v grows down.
std::array<float, 2> laid_on(const Vec3& point, const Vec3& normal, double side) {
  const Vec3 size = normal.cwiseAbs();
  double across = point.x(), down = -point.z();
  if (size.z() >= size.x() && size.z() >= size.y()) {
    down = -point.y();
  } else if (size.x() >= size.y()) {
    across = point.y();
  }
  return {static_cast<float>(across / side), static_cast<float>(down / side)};
}

}  // namespace

Mesh painted_mesh(const Mesh& mesh, const std::array<std::uint8_t, 3>& rgb) {
  Mesh painted = mesh;
  painted.textures.clear();
  painted.encoded.clear();
  for (Material& material : painted.materials) {
    for (std::size_t k = 0; k < 3; ++k) material.base_color[k] = kSrgbToLinear[rgb[k]];
    material.emission = {0, 0, 0};
    material.base_color_texture = material.emission_texture = -1;
    material.metallic = 0;
  }
  for (MeshPart& part : painted.parts) part.uv.clear();
  return painted;
}

Mesh covered_mesh(const Mesh& mesh, const Texture& picture, double side,
                  const IsCovered& is_covered, std::size_t* covered) {
  Mesh made = mesh;
  made.encoded.clear();
  made.textures.push_back(picture);
  const int texture = static_cast<int>(made.textures.size()) - 1;
  const std::size_t parts = made.parts.size();
  std::size_t count = 0;
  for (std::size_t p = 0; p < parts; ++p) {
    const MeshPart& part = mesh.parts[p];
    MeshPart over;
    std::vector<std::uint32_t> left;
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      const std::uint32_t* const at = part.indices.data() + i;
      const Vec3 a = vec_at(part.positions, at[0]), b = vec_at(part.positions, at[1]),
                 c = vec_at(part.positions, at[2]);
      const Vec3 cross = (b - a).cross(c - a);
      const double area = cross.norm();
      const Vec3 normal = area > 0 ? Vec3(cross / area) : Vec3::UnitZ();
      if (!is_covered(a, b, c, normal)) {
        left.insert(left.end(), at, at + 3);
        continue;
      }
      ++count;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 point = vec_at(part.positions, at[k]);
        const std::array<float, 2> uv = laid_on(point, normal, side);
        over.indices.push_back(static_cast<std::uint32_t>(over.positions.size() / 3));
        append(over.positions, point);
        append(over.normals, vec_at(part.normals, at[k]));
        over.uv.insert(over.uv.end(), uv.begin(), uv.end());
      }
    }
    if (over.indices.empty()) continue;
    Material material = mesh.materials[static_cast<std::size_t>(part.material)];
    material.base_color_texture = texture;
    material.emission = {0, 0, 0};
    material.emission_texture = -1;
    material.metallic = 0;
    over.material = static_cast<int>(made.materials.size());
    made.materials.push_back(material);
    made.parts[p].indices = std::move(left);
    made.parts.push_back(std::move(over));
  }
  std::erase_if(made.parts, [](const MeshPart& part) { return part.indices.empty(); });
  if (covered != nullptr) *covered = count;
  return made;
}

}  // namespace probe::scene
