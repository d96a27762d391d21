#include "runtime/scene/mesh_import.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/GltfMaterial.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "runtime/base/apart.h"
#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/base/large.h"
#include "runtime/base/libm_binding.h"
#include "runtime/base/paths.h"
#include "runtime/scene/color.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_bytes.h"
#include "runtime/scene/mesh_counts.h"
#include "runtime/scene/mesh_references.h"
#include "runtime/scene/vertex_colors.h"

namespace probe::scene {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_GenNormals | aiProcess_FlipUVs |
                            aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices |
                            aiProcess_SortByPType | aiProcess_ImproveCacheLocality;

// What a mesh may cost. These are addresses: a million triangles, of which a STL file keeps every
// corner by itself at first, take more than 1.5 GiB of them and 0.93 GB of memory.
constexpr ApartLimits kReaderLimits{
    .memory = std::size_t{2} << 30, .answer = std::size_t{768} << 20, .clock_s = 120};

// Of all pictures that a mesh's materials show: one of the largest and half as much again.
constexpr std::size_t kMaxTexels = std::size_t{96} << 20;

Failure asset_failure(std::string message, const std::string& path) {
  return {.code = Fault::kAsset, .message = std::move(message), .where = path};
}

// An OBJ file with `.5` as `0.5` in the lines of vertices, where assimp counts no number that
// begins with a point. Nothing where it has none, which are nearly all.
std::optional<std::string> with_leading_zeros(const std::string& path) {
  const auto text = read_file(path, {.most = kMaxMeshBytes});
  if (!text) return std::nullopt;
  std::string out;
  std::size_t copied = 0;
  char before = '\n', of_line = ' ';
  for (std::size_t at = 0; at < text->size(); ++at) {
    const char c = (*text)[at];
    if (before == '\n') of_line = c;
    const bool is_bare = c == '.' && of_line == 'v' &&
                         (before == ' ' || before == '\t' || before == '-' || before == '+');
    if (is_bare) {
      out.append(*text, copied, at - copied).append("0");
      copied = at;
    }
    before = c;
  }
  if (copied == 0) return std::nullopt;
  return out.append(*text, copied);
}

// Lets assimp open the mesh and the files it names inside the asset folder, nothing else.
class NamedFiles : public Assimp::DefaultIOSystem {
 public:
  NamedFiles(const std::string& mesh, const std::vector<MeshReference>& references) {
    allowed_.insert(key(mesh));
    for (const MeshReference& reference : references) {
      if (!reference.path.empty()) allowed_.insert(key(reference.path));
    }
  }

  bool Exists(const char* path) const override { return !find(path).empty(); }
  Assimp::IOStream* Open(const char* path, const char* mode) override {
    const std::string file = find(path);
    if (file.empty()) return nullptr;
    if (lower_extension(file) == ".obj") {
      if (const auto text = with_leading_zeros(file)) {
        auto* bytes = new std::uint8_t[text->size()];
        std::copy(text->begin(), text->end(), bytes);
        return new Assimp::MemoryIOStream(bytes, text->size(), true);  // which then owns them
      }
    }
    return DefaultIOSystem::Open(file.c_str(), mode);
  }

 private:
  // assimp asks for buffers of glTF by their URI as it stands.
  std::string find(const std::string& path) const {
    for (const std::string& name : {path, percent_decoded(path)}) {
      if (allowed_.contains(key(name))) return name;
    }
    return "";
  }
  static std::string key(const std::string& path) {
    return fs::absolute(path).lexically_normal().string();
  }
  std::set<std::string> allowed_;
};

enum class UpAxis { kX, kY, kZ };

// What a Collada file says of itself; the asset element is at its beginning.
UpAxis read_up_axis(const std::string& path) {
  const auto read = read_file(path, {.most = std::size_t{1} << 16, .only_begin = true});
  const std::string head = read ? *read : std::string();
  const std::size_t at = head.find("<up_axis>");
  if (at == head.npos) return UpAxis::kY;  // Collada's default
  if (head.compare(at + 9, 1, "X") == 0) return UpAxis::kX;
  return head.compare(at + 9, 1, "Z") == 0 ? UpAxis::kZ : UpAxis::kY;
}

// Two bytes tell PNG from JPEG.
std::string mime_of(std::string_view bytes) {
  if (bytes.starts_with("\x89P")) return "image/png";
  return bytes.starts_with("\xff\xd8") ? "image/jpeg" : "";
}

// One file being read: assimp's scene and the mesh that grows from it.
class Import {
 public:
  Import(const aiScene& scene, const std::string& path, const Vec3& scale, const MeshLimits& limits,
         const std::vector<MeshReference>& references)
      : scene_(scene), path_(path), scale_(scale), limits_(limits), references_(references) {
    const std::string extension = lower_extension(path);
    gltf_ = extension == ".glb" || extension == ".gltf";
    if (extension == ".dae" && limits.turn_up_axis) up_ = read_up_axis(path);
  }

  Result<Mesh> run() {
    PROBE_TRY(read_materials());
    PROBE_TRY(read_parts());
    PROBE_TRY(check_size());
    bake_colors();
    fold_constant_textures();
    drop_unused_textures();
    return std::move(mesh_);
  }

 private:
  Status read_materials() {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
      const aiMaterial& source = *scene_.mMaterials[i];
      Material material;
      aiColor4D color;
      if (source.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS ||
          source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS) {
        material.base_color = {color.r, color.g, color.b};
      }
      aiColor3D emission;
      if (source.Get(AI_MATKEY_COLOR_EMISSIVE, emission) == AI_SUCCESS) {
        material.emission = {emission.r, emission.g, emission.b};
      }
      PROBE_ASSIGN(material.base_color_texture,
                   find_texture(source, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}));
      PROBE_ASSIGN(material.emission_texture,
                   find_texture(source, {aiTextureType_EMISSIVE, aiTextureType_EMISSION_COLOR}));
      PROBE_TRY(read_surface(source, material));
      for (const float value :
           {material.base_color[0], material.base_color[1], material.base_color[2],
            material.emission[0], material.emission[1], material.emission[2], material.roughness,
            material.metallic, material.opacity}) {
        if (!std::isfinite(value)) {
          return asset_failure("material " + std::to_string(i) + " has a factor that is not finite",
                               path_);
        }
      }
      mesh_.materials.push_back(material);
    }
    if (mesh_.materials.empty()) mesh_.materials.emplace_back();
    return {};
  }

  // Roughness and metallic. glTF states them; Collada and OBJ say it with a specular colour and a
  // shininess.
  Status read_surface(const aiMaterial& source, Material& material) {
    if (gltf_) {
      source.Get(AI_MATKEY_ROUGHNESS_FACTOR, material.roughness);
      source.Get(AI_MATKEY_METALLIC_FACTOR, material.metallic);
      aiString blending;
      if (source.Get(AI_MATKEY_GLTF_ALPHAMODE, blending) == AI_SUCCESS &&
          std::string_view(blending.C_Str()) == "BLEND") {
        source.Get(AI_MATKEY_OPACITY, material.opacity);
        material.opacity = std::clamp(material.opacity, 0.0f, 1.0f);
      }
      aiColor3D gloss;
      if (source.Get(AI_MATKEY_GLOSSINESS_FACTOR, material.shininess) == AI_SUCCESS &&
          source.Get(AI_MATKEY_COLOR_SPECULAR, gloss) == AI_SUCCESS) {
        material.specular = gloss.r;
        material.shininess = std::clamp(material.shininess, 0.0f, 1.0f);
      }
      int index = -1;
      PROBE_ASSIGN(index, find_texture(source, {aiTextureType_METALNESS, aiTextureType_UNKNOWN}));
      if (index >= 0) {
        // We shade with constants: the texture counts by its means (G roughness, B metallic).
        double roughness = 0, metallic = 0;
        const Texture& texture = mesh_.textures[static_cast<std::size_t>(index)];
        for (std::size_t t = 0; t < texture.rgba.size(); t += 4) {
          roughness += texture.rgba[t + 1];
          metallic += texture.rgba[t + 2];
        }
        const double texels = 255.0 * static_cast<double>(texture.rgba.size() / 4);
        material.roughness *= static_cast<float>(roughness / texels);
        material.metallic *= static_cast<float>(metallic / texels);
      }
      return {};
    }
    aiColor3D specular;
    float shininess = 0;
    if (source.Get(AI_MATKEY_COLOR_SPECULAR, specular) == AI_SUCCESS &&
        source.Get(AI_MATKEY_SHININESS, shininess) == AI_SUCCESS) {
      const float gloss = std::min(1.0f, std::sqrt(std::max(0.0f, shininess) / 1000.0f));
      const float luma = 0.2125f * specular.r + 0.7154f * specular.g + 0.0721f * specular.b;
      material.roughness = std::clamp(1.0f - gloss * luma, 0.0f, 1.0f);
    }
    return {};
  }

  // Index into mesh_.textures of the first texture of one of these kinds, -1 if there is none.
  Result<int> find_texture(const aiMaterial& source, std::initializer_list<aiTextureType> kinds) {
    for (const aiTextureType kind : kinds) {
      aiString name;
      if (source.GetTexture(kind, 0, &name) != AI_SUCCESS || name.length == 0) continue;
      const auto known = texture_index_.find(name.C_Str());
      if (known != texture_index_.end()) return known->second;
      PROBE_ASSIGN(Texture texture, read_texture(name.C_Str()));
      const int index = static_cast<int>(mesh_.textures.size());
      mesh_.textures.push_back(std::move(texture));
      texture_index_.emplace(name.C_Str(), index);
      return index;
    }
    return -1;
  }

  Result<Texture> read_texture(const std::string& name) {
    const std::string where = path_ + " (texture " + name + ")";
    EncodedImage encoded;
    Result<Texture> texture = read_texture(name, where, encoded);
    if (texture && limits_.keep_encoded) {
      encoded.mime = mime_of(encoded.bytes);
      mesh_.encoded.push_back(std::move(encoded));
    }
    return texture;
  }

  Result<Texture> read_texture(const std::string& name, const std::string& where,
                               EncodedImage& encoded) {
    if (const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str())) {
      if (embedded->mHeight == 0) {  // a compressed file of mWidth bytes
        const auto* bytes = reinterpret_cast<const char*>(embedded->pcData);
        if (limits_.keep_encoded) encoded.bytes.assign(bytes, embedded->mWidth);
        return decode({reinterpret_cast<const std::byte*>(bytes), embedded->mWidth}, where);
      }
      const auto most = static_cast<unsigned>(allowed(kMaxImageSide));
      if (embedded->mWidth > most || embedded->mHeight > most) {
        return asset_failure(
            "the texture has more than " + std::to_string(most) + " pixels a side" + large_hint(),
            where);
      }
      Texture texture{static_cast<int>(embedded->mWidth), static_cast<int>(embedded->mHeight), {}};
      const std::size_t count = std::size_t{embedded->mWidth} * embedded->mHeight;
      texture.rgba.reserve(4 * count);
      for (std::size_t i = 0; i < count; ++i) {
        const aiTexel& texel = embedded->pcData[i];
        texture.rgba.insert(texture.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
      }
      return texture;
    }
    if (name.starts_with("*")) return asset_failure("the embedded texture is not there", where);

    PROBE_ASSIGN(const std::string file, find_reference(name, where));
    auto bytes = read_file(file, {.code = Fault::kAsset});
    if (!bytes) return asset_failure(bytes.failure().message, where);
    PROBE_ASSIGN(Texture texture, decode(std::as_bytes(std::span(*bytes)), where));
    if (limits_.keep_encoded) encoded.bytes = std::move(*bytes);
    return texture;
  }

  // One small file can name a large picture many times.
  Result<Texture> decode(std::span<const std::byte> bytes, const std::string& where) {
    PROBE_ASSIGN(const ImageSize size, image_size(bytes, where));
    texels_ += static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    if (texels_ > allowed(kMaxTexels)) {
      return asset_failure("the mesh's pictures have more than " +
                               std::to_string(allowed(kMaxTexels)) + " pixels in all" +
                               large_hint(),
                           where);
    }
    return decode_image(bytes, where);
  }

  // assimp may give back a decoded or otherwise tidied name, but means one of the files found.
  Result<std::string> find_reference(const std::string& name, const std::string& where) const {
    for (const MeshReference& reference : references_) {
      if (reference.written != name) continue;
      if (reference.path.empty()) return asset_failure(reference.problem, where);
      return reference.path;
    }
    const fs::path folder = fs::absolute(path_).lexically_normal().parent_path();
    auto file = resolve_inside(folder, name, reference_root(path_, limits_.asset_root));
    if (!file) return asset_failure(file.failure().message, where);
    for (const MeshReference& reference : references_) {
      if (reference.path == *file) return *file;
    }
    return asset_failure("the mesh file does not name this texture in a way that is understood",
                         where);
  }

  Status read_parts() {
    // (material, has uv, has colours) -> part
    std::map<std::tuple<unsigned, bool, bool>, std::size_t> part_of;
    std::size_t triangles = 0;
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
      const aiMesh& source = *scene_.mMeshes[m];
      if ((source.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0 || source.mNumFaces == 0)
        continue;
      triangles += source.mNumFaces;
      if (triangles > allowed(limits_.triangles)) {
        return asset_failure(
            "more than " + std::to_string(allowed(limits_.triangles)) + " triangles" + large_hint(),
            path_);
      }
      const bool has_uv = source.HasTextureCoords(0);
      const auto [place, fresh] = part_of.try_emplace(
          {source.mMaterialIndex, has_uv, source.HasVertexColors(0)}, mesh_.parts.size());
      if (fresh) {
        colors_.emplace_back();
        MeshPart part;
        part.material = source.mMaterialIndex < mesh_.materials.size()
                            ? static_cast<int>(source.mMaterialIndex)
                            : 0;
        mesh_.parts.push_back(std::move(part));
      }
      PROBE_TRY(append(source, mesh_.parts[place->second]));
      append_colors(source, colors_[place->second]);
    }
    if (triangles == 0) return asset_failure("the mesh has no triangles", path_);
    return {};
  }

  Status append(const aiMesh& source, MeshPart& part) {
    const std::size_t base = part.positions.size() / 3;
    const bool has_uv = source.HasTextureCoords(0);
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiVector3D p = source.mVertices[v];
      const Vec3 scaled = upright(p).cwiseProduct(scale_);
      Vec3 normal = Vec3::Zero();
      if (source.HasNormals()) {
        normal = upright(source.mNormals[v]).cwiseQuotient(scale_);
        const double length = normal.norm();
        normal = std::isfinite(length) && length > 1e-12 ? Vec3(normal / length) : Vec3::Zero();
      }
      for (int k = 0; k < 3; ++k) {
        const float position = static_cast<float>(scaled[k]);
        if (!std::isfinite(position)) {
          return asset_failure("vertex " + std::to_string(v) + " of part " +
                                   std::to_string(part.material) + " is not finite",
                               path_);
        }
        if (std::abs(position) > limits_.extent) {
          return asset_failure("vertex " + std::to_string(v) + " of part " +
                                   std::to_string(part.material) + " lies more than " +
                                   std::to_string(std::lround(limits_.extent)) +
                                   " m from the origin",
                               path_);
        }
        part.positions.push_back(position);
        part.normals.push_back(static_cast<float>(normal[k]));
      }
      if (has_uv) {
        const aiVector3D uv = source.mTextureCoords[0][v];
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
          return asset_failure("texture coordinate " + std::to_string(v) + " is not finite", path_);
        }
        part.uv.push_back(uv.x);
        part.uv.push_back(uv.y);
      }
    }
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      if (face.mNumIndices != 3) continue;
      for (int k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= source.mNumVertices) {
          return asset_failure(
              "triangle " + std::to_string(f) + " names a vertex that is not there", path_);
        }
        part.indices.push_back(static_cast<std::uint32_t>(base + face.mIndices[k]));
      }
      fill_missing_normals(part, part.indices.size() - 3);
    }
    return {};
  }

  Vec3 upright(const aiVector3D& p) const {
    if (up_ == UpAxis::kY) return {p.x, -p.z, p.y};
    if (up_ == UpAxis::kX) return {-p.y, -p.z, p.x};
    return {p.x, p.y, p.z};
  }

  Status check_size() const {
    const std::vector<float>& first = mesh_.parts[0].positions;
    for (const MeshPart& part : mesh_.parts) {
      for (std::size_t i = 0; i < part.positions.size(); ++i) {
        if (part.positions[i] != first[i % 3]) return {};
      }
    }
    return asset_failure("the mesh has no size: all vertices are at one point", path_);
  }

  // glTF's are linear factors of the colour; elsewhere they are display values in its place.
  void append_colors(const aiMesh& source, std::vector<LinearRgb>& colors) const {
    if (!source.HasVertexColors(0)) return;
    const std::array<float, 3> factor = source.mMaterialIndex < mesh_.materials.size()
                                            ? mesh_.materials[source.mMaterialIndex].base_color
                                            : std::array<float, 3>{1, 1, 1};
    const auto unit = [](float x) { return std::isfinite(x) ? std::clamp(x, 0.0f, 1.0f) : 0.0f; };
    const auto display = [&](float x) {
      return kSrgbToLinear[static_cast<std::size_t>(std::lround(255 * unit(x)))];
    };
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiColor4D& c = source.mColors[0][v];
      colors.push_back(
          gltf_ ? LinearRgb{unit(c.r * factor[0]), unit(c.g * factor[1]), unit(c.b * factor[2])}
                : LinearRgb{display(c.r), display(c.g), display(c.b)});
    }
  }

  // A texture wins over colours at vertices. Materials are shared by parts, so each gets its own.
  void bake_colors() {
    for (std::size_t i = 0; i < mesh_.parts.size(); ++i) {
      MeshPart& part = mesh_.parts[i];
      const Material& shared = mesh_.materials[static_cast<std::size_t>(part.material)];
      if (colors_[i].empty() || shared.base_color_texture >= 0 || shared.emission_texture >= 0) {
        continue;
      }
      Material own = shared;
      part.material = static_cast<int>(mesh_.materials.size());
      bake_vertex_colors(colors_[i], part, own, mesh_.textures);
      if (limits_.keep_encoded) mesh_.encoded.resize(mesh_.textures.size());
      mesh_.materials.push_back(own);
    }
  }

  // Vertices whose normal is missing or zero get that of a triangle they belong to.
  static void fill_missing_normals(MeshPart& part, std::size_t first) {
    const auto point = [&part](std::uint32_t i) {
      return Vec3(part.positions[3 * i], part.positions[3 * i + 1], part.positions[3 * i + 2]);
    };
    std::optional<Vec3> face;
    for (std::size_t k = first; k < first + 3; ++k) {
      float* normal = part.normals.data() + 3 * std::size_t{part.indices[k]};
      if (normal[0] != 0 || normal[1] != 0 || normal[2] != 0) continue;
      if (!face) {
        const Vec3 a = point(part.indices[first]);
        const Vec3 cross =
            (point(part.indices[first + 1]) - a).cross(point(part.indices[first + 2]) - a);
        face = cross.norm() > 0 ? Vec3(cross.normalized()) : Vec3(Vec3::UnitZ());
      }
      for (int j = 0; j < 3; ++j) normal[j] = static_cast<float>((*face)[j]);
    }
  }

  static bool has_varying_uv(const MeshPart& part) {
    for (std::size_t i = 2; i < part.uv.size(); ++i) {
      if (part.uv[i] != part.uv[i & 1]) return true;
    }
    return false;
  }

  // A texture without coordinates, or with the same one everywhere, is a colour: the sample at that
  // point. Materials are shared by parts, so a folded one is a copy.
  void fold_constant_textures() {
    for (MeshPart& part : mesh_.parts) {
      Material folded = mesh_.materials[static_cast<std::size_t>(part.material)];
      if (folded.base_color_texture < 0 && folded.emission_texture < 0) continue;
      if (has_varying_uv(part)) continue;
      const float u = part.uv.empty() ? 0.0f : part.uv[0];
      const float v = part.uv.empty() ? 0.0f : part.uv[1];
      const auto fold = [&](int& texture, std::array<float, 3>& factor) {
        if (texture < 0) return;
        const LinearRgb c = sample_texture(mesh_.textures[static_cast<std::size_t>(texture)], u, v);
        factor = {c.r, c.g, c.b};
        texture = -1;
      };
      fold(folded.base_color_texture, folded.base_color);
      fold(folded.emission_texture, folded.emission);
      part.material = static_cast<int>(mesh_.materials.size());
      mesh_.materials.push_back(folded);
      part.uv.clear();
    }
  }

  // Materials that no part uses and textures that no material uses would only cost memory and
  // change the hash.
  void drop_unused_textures() {
    std::vector<Material> materials;
    std::map<int, int> new_material;
    for (MeshPart& part : mesh_.parts) {
      const auto [place, fresh] =
          new_material.try_emplace(part.material, static_cast<int>(materials.size()));
      if (fresh) materials.push_back(mesh_.materials[static_cast<std::size_t>(part.material)]);
      part.material = place->second;
    }
    std::vector<Texture> textures;
    std::vector<EncodedImage> encoded;
    std::map<int, int> new_texture;
    const auto keep = [&](int& index) {
      if (index < 0) return;
      const auto [place, fresh] = new_texture.try_emplace(index, static_cast<int>(textures.size()));
      const auto old = static_cast<std::size_t>(index);
      if (fresh) textures.push_back(std::move(mesh_.textures[old]));
      if (fresh && limits_.keep_encoded) encoded.push_back(std::move(mesh_.encoded[old]));
      index = place->second;
    };
    for (Material& material : materials) {
      keep(material.base_color_texture);
      keep(material.emission_texture);
    }
    mesh_.materials = std::move(materials);
    mesh_.textures = std::move(textures);
    mesh_.encoded = std::move(encoded);
  }

  const aiScene& scene_;
  const std::string& path_;
  const Vec3 scale_;
  const MeshLimits& limits_;
  const std::vector<MeshReference>& references_;
  bool gltf_ = false;
  UpAxis up_ = UpAxis::kZ;  // of the coordinates as assimp gives them
  Mesh mesh_;
  std::vector<std::vector<LinearRgb>> colors_;  // of each part, one a vertex or none
  std::map<std::string, int> texture_index_;
  std::size_t texels_ = 0;
};

Result<Mesh> load(const std::string& path, const Vec3& scale, const MeshLimits& limits) {
  PROBE_ASSIGN(const std::vector<MeshReference> references,
               mesh_references(path, limits.asset_root));
  if (limits.self_contained && !references.empty()) {
    return asset_failure("names `" + references.front().written +
                             "`, and a plan freezes one file a mesh: `vlaprobe assets pack` puts "
                             "all into one",
                         path);
  }
  for (const MeshReference& reference : references) {
    // A missing picture matters only if a material shows it; without the rest there is no mesh.
    const std::string extension = lower_extension(reference.written);
    if (reference.path.empty() && (extension == ".mtl" || extension == ".bin")) {
      return asset_failure(reference.problem, path + " (" + reference.written + ")");
    }
  }
  PROBE_TRY(check_counts(path));
  Assimp::Importer importer;
  importer.SetIOHandler(new NamedFiles(path, references));  // the importer owns it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(path, kSteps);
  if (scene == nullptr) {
    const std::string why = importer.GetErrorString();
    if (why.find("bad_alloc") != why.npos) throw std::bad_alloc();
    return asset_failure("cannot read the mesh: " + why, path);
  }
  if ((scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0) {
    return asset_failure("the mesh file is incomplete", path);
  }
  return Import(*scene, path, scale, limits, references).run();
}

}  // namespace

bool is_mesh_extension(std::string_view extension) {
  return std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) !=
         kMeshExtensions.end();
}

Result<std::shared_ptr<const Mesh>> load_mesh(const std::string& path, const Vec3& scale,
                                              const MeshLimits& limits) {
  // assimp turns nodes by angles of its files.
  static constexpr std::string_view kAssimp[] = {"libassimp"};
  static const Result<TrigBinding> bound = bind_trigonometry(kAssimp);
  if (!bound) return bound.failure();
  if (!scale.allFinite() || (scale.array() == 0).any()) {
    return asset_failure("the scale of a mesh must be finite and not 0", path);
  }
  if (!is_file(path)) return asset_failure("there is no such mesh file", path);
  if (!is_mesh_extension(lower_extension(path))) {
    return asset_failure("meshes are read from glb, gltf, obj, dae and stl files", path);
  }
  std::error_code error;
  if (fs::file_size(path, error) > allowed(kMaxMeshBytes) || error) {
    return asset_failure("larger than " + std::to_string(allowed(kMaxMeshBytes) >> 20) +
                             " MiB, the most that is read" + large_hint(),
                         path);
  }
  // assimp catches its own exceptions, except that of an exhausted memory.
  const auto work = [&](const AnswerWriter& write) {
    const auto read = [&]() -> Result<Mesh> {
      try {
        return load(path, scale, limits);
      } catch (const std::bad_alloc&) {
        throw;
      } catch (const std::exception& exception) {
        return asset_failure(std::string("cannot read the mesh: ") + exception.what(), path);
      }
    };
    return write_import(read(), write);
  };
  ApartLimits most = kReaderLimits;
  most.cpu_s = limits.cpu_s;
  const auto answer = run_apart(work, most);
  if (!answer) return asset_failure("the mesh " + answer.failure().message, path);
  auto mesh = read_import(answer->bytes());
  if (!mesh) return asset_failure("the mesh makes its reader give half an answer", path);
  if (!*mesh) return mesh->failure();
  (*mesh)->name = path;
  return std::make_shared<const Mesh>(std::move(**mesh));
}

}  // namespace probe::scene
