#include "assets/make/files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "runtime/base/sha256.h"

namespace probe::make {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUint16 = 5123, kUint32 = 5125;  // glTF component types
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;

// The binary chunk and the tables that describe it. x86 is little endian, as glTF is.
struct Binary {
  std::string bytes;
  Json views = Json::array();
  Json accessors = Json::array();

  template <typename T>
  std::size_t add_view(const std::vector<T>& values, int target) {
    const std::size_t offset = bytes.size();
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
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

// Vertices with equal bits are stored once, in order of first use.
struct Indexed {
  std::vector<float> positions, normals, uv;
  std::vector<std::uint32_t> indices;
};

Indexed index_surface(const Surface& surface) {
  Indexed out;
  std::map<std::array<float, 8>, std::uint32_t> seen;
  for (const Triangle& t : surface) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 8> v{};
      for (int axis = 0; axis < 3; ++axis) {
        // + 0.0 turns a negative zero into zero.
        v[static_cast<std::size_t>(axis)] = static_cast<float>(t.position[k][axis] + 0.0);
        v[static_cast<std::size_t>(axis) + 3] = static_cast<float>(t.normal[k][axis] + 0.0);
      }
      v[6] = static_cast<float>(t.uv[k][0] + 0.0);
      v[7] = static_cast<float>(t.uv[k][1] + 0.0);
      const auto next = static_cast<std::uint32_t>(seen.size());
      const auto [at, is_new] = seen.emplace(v, next);
      if (is_new) {
        out.positions.insert(out.positions.end(), v.begin(), v.begin() + 3);
        out.normals.insert(out.normals.end(), v.begin() + 3, v.begin() + 6);
        out.uv.insert(out.uv.end(), v.begin() + 6, v.end());
      }
      out.indices.push_back(at->second);
    }
  }
  return out;
}

Json add_primitive(Binary& binary, const Indexed& mesh, std::size_t material, bool has_uv) {
  const std::size_t count = mesh.positions.size() / 3;
  const std::size_t position =
      binary.add_accessor(binary.add_view(mesh.positions, kArrayBuffer), kFloat, count, "VEC3");
  std::array<float, 3> low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = high[axis] = mesh.positions[axis];
    for (std::size_t i = axis; i < mesh.positions.size(); i += 3) {
      low[axis] = std::min(low[axis], mesh.positions[i]);
      high[axis] = std::max(high[axis], mesh.positions[i]);
    }
  }
  binary.accessors[position]["min"] = low;
  binary.accessors[position]["max"] = high;
  Json attributes = {{"POSITION", position}};
  attributes["NORMAL"] =
      binary.add_accessor(binary.add_view(mesh.normals, kArrayBuffer), kFloat, count, "VEC3");
  if (has_uv) {
    attributes["TEXCOORD_0"] =
        binary.add_accessor(binary.add_view(mesh.uv, kArrayBuffer), kFloat, count, "VEC2");
  }
  std::size_t indices = 0;
  if (count < 65536) {
    const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
    indices = binary.add_accessor(binary.add_view(narrow, kElementBuffer), kUint16,
                                  mesh.indices.size(), "SCALAR");
  } else {
    indices = binary.add_accessor(binary.add_view(mesh.indices, kElementBuffer), kUint32,
                                  mesh.indices.size(), "SCALAR");
  }
  return {{"attributes", attributes}, {"indices", indices}, {"material", material}};
}

// Rounded before it is printed, so that no "-0.000000" appears.
double to_micrometre(double metres) { return std::floor(metres * 1e6 + 0.5) / 1e6 + 0.0; }

void append_u32(std::string& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((value >> shift) & 0xFF);
}

}  // namespace

std::string glb_bytes(const std::string& name, const std::vector<Part>& parts) {
  Binary binary;
  Json primitives = Json::array(), materials = Json::array();
  Json images = Json::array(), textures = Json::array();
  for (const Part& part : parts) {
    primitives.push_back(add_primitive(binary, index_surface(part.surface), materials.size(),
                                       part.material.texture.has_value()));
    Json pbr;
    if (part.material.texture) {
      const std::string png = png_bytes(*part.material.texture);
      const std::size_t view = binary.add_view(std::vector<char>(png.begin(), png.end()), 0);
      pbr["baseColorTexture"] = {{"index", textures.size()}};
      textures.push_back({{"source", images.size()}, {"sampler", 0}});
      images.push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    } else {
      const Colour& c = part.material.base_color;
      pbr["baseColorFactor"] = {c[0], c[1], c[2], 1.0};
    }
    pbr["metallicFactor"] = 0.0;
    pbr["roughnessFactor"] = part.material.roughness;
    Json material = {{"name", part.material.name}, {"pbrMetallicRoughness", pbr}};
    const Colour& glow = part.material.emission;
    if (glow != Colour{0, 0, 0}) material["emissiveFactor"] = {glow[0], glow[1], glow[2]};
    materials.push_back(material);
  }
  Json root = {{"asset", {{"version", "2.0"}, {"generator", "vlaprobe make_assets"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"name", name}, {"mesh", 0}}}},
               {"meshes", {{{"name", name}, {"primitives", primitives}}}},
               {"materials", materials}};
  if (!images.empty()) {
    root["textures"] = textures;
    root["images"] = images;
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

std::string obj_bytes(const std::vector<Polyhedron>& parts) {
  std::string out = "# Convex parts, metres, z up. Made by make_assets.\n";
  std::size_t first = 1;
  for (const Polyhedron& part : parts) {
    out += "o " + part.name + "\n";
    for (const Vec3& p : part.vertices) {
      std::array<char, 96> line{};
      std::snprintf(line.data(), line.size(), "v %.6f %.6f %.6f\n", to_micrometre(p.x()),
                    to_micrometre(p.y()), to_micrometre(p.z()));
      out += line.data();
    }
    for (const std::vector<int>& loop : part.faces) {
      out += "f";
      for (const int i : loop) {
        out += ' ';
        out += std::to_string(first + static_cast<std::size_t>(i));
      }
      out += "\n";
    }
    first += part.vertices.size();
  }
  return out;
}

std::string manifest_bytes(const std::vector<OutputFile>& files) {
  std::vector<const OutputFile*> sorted;
  for (const OutputFile& file : files) sorted.push_back(&file);
  std::sort(sorted.begin(), sorted.end(),
            [](const OutputFile* a, const OutputFile* b) { return a->path < b->path; });
  Json list = Json::array();
  for (const OutputFile* file : sorted) {
    list.push_back({{"path", file->path},
                    {"bytes", file->bytes.size()},
                    {"sha256", to_hex(sha256(file->bytes))}});
  }
  return Json{{"files", list}}.dump(1) + "\n";
}

Status write_files(const std::string& folder, std::vector<OutputFile> files) {
  files.push_back({"manifest.json", manifest_bytes(files)});
  for (const OutputFile& file : files) {
    const std::filesystem::path path = std::filesystem::path(folder) / file.path;
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) return Failure{"io", "cannot make the folder: " + error.message(), path.string()};
    std::ofstream out(path, std::ios::binary);
    out.write(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
    out.close();
    if (!out) return Failure{"io", "cannot write the file", path.string()};
  }
  return {};
}

}  // namespace probe::make
