#include "assets/make/files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "runtime/base/check.h"
#include "runtime/base/json.h"
#include "runtime/base/sha256.h"
#include "runtime/scene/glb_writer.h"
#include "runtime/scene/image.h"

namespace probe::make {
namespace {

// Vertices with equal bits are stored once, in order of first use.
scene::GlbPart index_surface(const Surface& surface) {
  scene::GlbPart out;
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

// Rounded before it is printed, so that no "-0.000000" appears.
double to_micrometre(double metres) { return std::floor(metres * 1e6 + 0.5) / 1e6 + 0.0; }

}  // namespace

std::string glb_bytes(const std::string& name, const std::vector<Part>& parts) {
  scene::GlbDocument document;
  document.name = name;
  document.generator = "vlaprobe make_assets";
  for (const Part& part : parts) {
    const Material& material = part.material;
    scene::GlbMaterial& written = document.materials.emplace_back();
    written.name = material.name;
    (material.is_baked ? written.emission : written.base_color) = material.base_color;
    if (material.is_baked) written.base_color = {0, 0, 0};
    written.roughness = material.roughness;
    scene::GlbPart& arrays = document.parts.emplace_back(index_surface(part.surface));
    arrays.material = document.materials.size() - 1;
    if (material.texture) {
      (material.is_baked ? written.emission_image : written.base_color_image) =
          static_cast<int>(document.images.size());
      const Image& image = *material.texture;
      auto png =
          scene::png_bytes(image.width, image.height, image.rgb, scene::PngEffort::kSmallest);
      PROBE_CHECK(png.ok(), "a texture has the size that it says");
      document.images.push_back({std::move(png).value(), "image/png"});
    } else {
      arrays.uv.clear();
    }
  }
  return scene::glb_bytes(document);
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
    if (error)
      return Failure{Fault::kIo, "cannot make the folder: " + error.message(), path.string()};
    std::ofstream out(path, std::ios::binary);
    out.write(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
    out.close();
    if (!out) return Failure{Fault::kIo, "cannot write the file", path.string()};
  }
  return {};
}

}  // namespace probe::make
