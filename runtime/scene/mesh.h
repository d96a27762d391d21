// Meshes as pictures and physics need them: plain arrays, already scaled to metres, node transforms
// baked in.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::scene {

struct Texture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // sRGB bytes, row 0 on top (v = 0)
};

// Linear factors; a texture replaces its factor.
struct Material {
  std::array<float, 3> base_color{1, 1, 1};
  std::array<float, 3> emission{0, 0, 0};
  int base_color_texture = -1;  // index into Mesh::textures
  int emission_texture = -1;
  float roughness = 1;
  float metallic = 0;
  float f0 = 0.04f;
  // Share of what lies behind that it covers, 1 where a file does not say that it is blended. Its
  // highlights and its texture's alpha have no share of their own.
  float opacity = 1;
  // Of the law that lights vertices alone: strength of the highlight, and its exponent / 128.
  float specular = 0.5f, shininess = 0.5f;
};

// Triangles of one material. Float arrays, 3 (positions, normals) or 2 (uv) a vertex; uv may be
// empty.
struct MeshPart {
  int material = 0;
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> uv;
  std::vector<std::uint32_t> indices;  // 3 a triangle
};

// A picture as its file holds it.
struct EncodedImage {
  std::string bytes;
  std::string mime;  // "image/png", "image/jpeg"; empty: another format
};

struct Mesh {
  std::string name;  // path, for messages
  std::vector<MeshPart> parts;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  // As `textures` where the import was told to keep them, else empty. Bytes are empty for a texture
  // that has no file, such as baked vertex colours.
  std::vector<EncodedImage> encoded;
};

}  // namespace probe::scene
