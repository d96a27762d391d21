#include "runtime/scene/glb_writer.h"

#include <algorithm>
#include <optional>

#include "runtime/base/json.h"
#include "runtime/scene/image.h"

namespace probe::scene {
namespace {

constexpr int kFloat = 5126, kUint16 = 5123, kUint32 = 5125;  // glTF component types
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;

// The binary chunk and the tables that describe it. x86 is little endian, as glTF is.
struct Binary {
  std::string bytes;
  Json views = Json::array();
  Json accessors = Json::array();

  template <typename Values>
  std::size_t add_view(const Values& values, int target) {
    const std::size_t offset = bytes.size();
    bytes.append(reinterpret_cast<const char*>(values.data()),
                 values.size() * sizeof(typename Values::value_type));
    const std::size_t length = bytes.size() - offset;
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
    if (target != 0) view["target"] = target;
    views.push_back(view);
    return views.size() - 1;
  }

  std::size_t add_accessor(std::size_t view, int component, std::size_t count, const char* type) {
    accessors.push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return accessors.size() - 1;
  }
};

Json add_primitive(Binary& binary, const GlbPart& part) {
  const std::size_t count = part.positions.size() / 3;
  const std::size_t position =
      binary.add_accessor(binary.add_view(part.positions, kArrayBuffer), kFloat, count, "VEC3");
  std::array<float, 3> low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = high[axis] = part.positions[axis];
    for (std::size_t i = axis; i < part.positions.size(); i += 3) {
      low[axis] = std::min(low[axis], part.positions[i]);
      high[axis] = std::max(high[axis], part.positions[i]);
    }
  }
  binary.accessors[position]["min"] = low;
  binary.accessors[position]["max"] = high;
  Json attributes = {{"POSITION", position}};
  attributes["NORMAL"] =
      binary.add_accessor(binary.add_view(part.normals, kArrayBuffer), kFloat, count, "VEC3");
  if (!part.uv.empty()) {
    attributes["TEXCOORD_0"] =
        binary.add_accessor(binary.add_view(part.uv, kArrayBuffer), kFloat, count, "VEC2");
  }
  std::size_t indices = 0;
  if (count < 65536) {
    const std::vector<std::uint16_t> narrow(part.indices.begin(), part.indices.end());
    indices = binary.add_accessor(binary.add_view(narrow, kElementBuffer), kUint16,
                                  part.indices.size(), "SCALAR");
  } else {
    indices = binary.add_accessor(binary.add_view(part.indices, kElementBuffer), kUint32,
                                  part.indices.size(), "SCALAR");
  }
  return {{"attributes", attributes}, {"indices", indices}, {"material", part.material}};
}

// Images of a document go into the file when the first material that shows them does.
struct Images {
  Binary& binary;
  const std::vector<EncodedImage>& encoded;
  std::vector<std::optional<std::size_t>> texture_of;  // by index into `encoded`
  Json images = Json::array(), textures = Json::array();

  std::size_t texture(int index) {
    const auto i = static_cast<std::size_t>(index);
    if (!texture_of[i]) {
      const std::size_t view = binary.add_view(encoded[i].bytes, 0);
      texture_of[i] = textures.size();
      textures.push_back({{"source", images.size()}, {"sampler", 0}});
      images.push_back({{"bufferView", view}, {"mimeType", encoded[i].mime}});
    }
    return *texture_of[i];
  }
};

Json to_json(const GlbMaterial& material, Images& images) {
  Json pbr;
  if (material.base_color_image >= 0) {
    pbr["baseColorTexture"] = {{"index", images.texture(material.base_color_image)}};
  } else {
    const auto& c = material.base_color;
    pbr["baseColorFactor"] = {c[0], c[1], c[2], material.opacity};
  }
  if (material.base_color_image >= 0 && material.opacity < 1)
    pbr["baseColorFactor"] = {1.0, 1.0, 1.0, material.opacity};
  pbr["metallicFactor"] = material.metallic;
  pbr["roughnessFactor"] = material.roughness;
  Json json = {{"name", material.name}, {"pbrMetallicRoughness", pbr}};
  if (material.opacity < 1) json["alphaMode"] = "BLEND";
  if (material.emission_image >= 0) {
    json["emissiveTexture"] = {{"index", images.texture(material.emission_image)}};
  }
  if (material.specular && material.shininess) {
    const double s = *material.specular;
    Json gloss = {{"specularFactor", {s, s, s}}, {"glossinessFactor", *material.shininess}};
    if (pbr.contains("baseColorTexture")) gloss["diffuseTexture"] = pbr["baseColorTexture"];
    if (pbr.contains("baseColorFactor")) gloss["diffuseFactor"] = pbr["baseColorFactor"];
    json["extensions"] = {{"KHR_materials_pbrSpecularGlossiness", gloss}};
  }
  const auto& glow = material.emission;
  if (glow != std::array<double, 3>{0, 0, 0}) json["emissiveFactor"] = {glow[0], glow[1], glow[2]};
  return json;
}

void append_u32(std::string& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((value >> shift) & 0xFF);
}

}  // namespace

std::string glb_bytes(const GlbDocument& document) {
  Binary binary;
  Images images{binary, document.images, {}};
  images.texture_of.resize(document.images.size());
  Json primitives = Json::array();
  std::vector<Json> materials(document.materials.size());
  for (const GlbPart& part : document.parts) {
    primitives.push_back(add_primitive(binary, part));
    Json& material = materials[part.material];
    if (material.is_null()) material = to_json(document.materials[part.material], images);
  }
  Json root = {{"asset", {{"version", "2.0"}, {"generator", document.generator}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"name", document.name}, {"mesh", 0}}}},
               {"meshes", {{{"name", document.name}, {"primitives", primitives}}}},
               {"materials", materials}};
  if (std::ranges::any_of(materials, [](const Json& m) { return m.contains("extensions"); }))
    root["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  if (!images.images.empty()) {
    root["textures"] = images.textures;
    root["images"] = images.images;
    root["samplers"] = {{{"wrapS", 10497}, {"wrapT", 10497}}};  // repeat
  }
  root["accessors"] = binary.accessors;
  root["bufferViews"] = binary.views;
  root["buffers"] = {{{"byteLength", binary.bytes.size()}}};
  std::string json = root.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  append_u32(out, 2);
  append_u32(out, 12 + 8 + json.size() + 8 + binary.bytes.size());
  append_u32(out, json.size());
  out += "JSON" + json;
  append_u32(out, binary.bytes.size());
  out += std::string("BIN\0", 4) + binary.bytes;
  return out;
}

Result<std::string> glb_bytes(const Mesh& mesh, const std::string& name,
                              const std::string& generator) {
  GlbDocument document{name, generator, {}, {}, {}};
  for (std::size_t i = 0; i < mesh.textures.size(); ++i) {
    if (i < mesh.encoded.size() && !mesh.encoded[i].mime.empty()) {
      document.images.push_back(mesh.encoded[i]);
      continue;
    }
    PROBE_ASSIGN(std::string png, png_bytes(mesh.textures[i]));
    document.images.push_back({std::move(png), "image/png"});
  }
  const auto wide = [](const std::array<float, 3>& c) {
    return std::array<double, 3>{c[0], c[1], c[2]};
  };
  for (const Material& material : mesh.materials) {
    // An emission texture counts only with a factor above 0 in other programs.
    const bool glows = material.emission_texture >= 0;
    document.materials.push_back({"material" + std::to_string(document.materials.size()),
                                  wide(material.base_color),
                                  glows ? std::array<double, 3>{1, 1, 1} : wide(material.emission),
                                  material.base_color_texture,
                                  material.emission_texture,
                                  material.roughness,
                                  material.metallic,
                                  material.opacity,
                                  {},
                                  {}});
  }
  for (const MeshPart& part : mesh.parts) {
    document.parts.push_back({part.positions, part.normals, part.uv, part.indices,
                              static_cast<std::size_t>(part.material)});
  }
  return glb_bytes(document);
}

}  // namespace probe::scene
