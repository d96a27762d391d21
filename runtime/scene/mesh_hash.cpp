#include "runtime/scene/mesh_hash.h"

#include <bit>
#include <span>

namespace probe::scene {
namespace {

template <typename T>
void feed(Hasher& hasher, const std::vector<T>& values) {
  hasher.u64(values.size());
  hasher.bytes(std::as_bytes(std::span(values)));
}

void feed(Hasher& hasher, float value) { hasher.u32(std::bit_cast<std::uint32_t>(value)); }

void feed(Hasher& hasher, const Texture& texture) {
  hasher.u32(static_cast<std::uint32_t>(texture.width));
  hasher.u32(static_cast<std::uint32_t>(texture.height));
  feed(hasher, texture.rgba);
}

}  // namespace

Sha256 mesh_hash(const Mesh& mesh) {
  Hasher hasher;
  hasher.text("mesh 1");
  hasher.u64(mesh.parts.size());
  for (const MeshPart& part : mesh.parts) {
    hasher.u32(static_cast<std::uint32_t>(part.material));
    feed(hasher, part.positions);
    feed(hasher, part.normals);
    feed(hasher, part.uv);
    feed(hasher, part.indices);
  }
  hasher.u64(mesh.materials.size());
  for (const Material& material : mesh.materials) {
    for (float value : material.base_color) feed(hasher, value);
    for (float value : material.emission) feed(hasher, value);
    hasher.u32(static_cast<std::uint32_t>(material.base_color_texture));
    hasher.u32(static_cast<std::uint32_t>(material.emission_texture));
    feed(hasher, material.roughness);
    feed(hasher, material.metallic);
    feed(hasher, material.f0);
    if (material.specular != 0.5f || material.shininess != 0.5f) {
      feed(hasher, material.specular);
      feed(hasher, material.shininess);
    }
    if (material.opacity != 1) {
      hasher.text("opacity");
      feed(hasher, material.opacity);
    }
  }
  hasher.u64(mesh.textures.size());
  for (const Texture& texture : mesh.textures) feed(hasher, texture);
  return hasher.finish();
}

}  // namespace probe::scene
