// Binary glTF 2.0 files: one node without a transform, one mesh, one primitive a part, everything
// embedded. Axes and units are those of the arrays. Same input, same bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

struct GlbMaterial {
  std::string name;
  std::array<double, 3> base_color{1, 1, 1};  // linear; written where there is no texture
  std::array<double, 3> emission{0, 0, 0};
  int base_color_image = -1, emission_image = -1;  // index into GlbDocument::images
  double roughness = 1, metallic = 0;
  double opacity = 1;  // below 1: blended
  // Of fixed-function OpenGL: KHR_materials_pbrSpecularGlossiness, where they are said.
  std::optional<double> specular, shininess;
};

struct GlbPart {
  std::vector<float> positions, normals, uv;  // 3, 3, 2 floats a vertex; uv may be empty
  std::vector<std::uint32_t> indices;
  std::size_t material = 0;
};

struct GlbDocument {
  std::string name, generator;
  std::vector<GlbPart> parts;
  std::vector<GlbMaterial> materials;
  std::vector<EncodedImage> images;
};

std::string glb_bytes(const GlbDocument& document);

// A mesh that was imported with its encoded textures (MeshLimits::keep_encoded); textures without
// PNG or JPEG bytes are written as PNG.
Result<std::string> glb_bytes(const Mesh& mesh, const std::string& name,
                              const std::string& generator);

}  // namespace probe::scene
