// Triangles of a Wavefront file for collision shapes: positions and faces only. A tiny reader of
// our own, because a general importer welds, splits or triangulates vertices as it likes, and
// components are defined by shared indices.
#include <charconv>
#include <numeric>
#include <sstream>

#include "runtime/base/file.h"
#include "runtime/base/large.h"
#include "runtime/scene/hull.h"
#include "runtime/scene/mesh_import.h"

namespace probe::scene {
namespace {

const MeshLimits kLimits;

// The vertex number of a face corner "7", "7/1", "7//3", "-1/2"; 0 when it is no number.
long corner_index(const std::string& word) {
  long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || (end != word.data() + word.size() && *end != '/')) return 0;
  return value;
}

std::uint32_t find_root(std::vector<std::uint32_t>* parent, std::uint32_t i) {
  while ((*parent)[i] != i) {
    (*parent)[i] = (*parent)[(*parent)[i]];
    i = (*parent)[i];
  }
  return i;
}

}  // namespace

Result<TriangleSoup> load_obj_triangles(const std::string& path, const Vec3& scale) {
  PROBE_ASSIGN(std::string text, read_file(path, {.code = Fault::kAsset}));
  std::istringstream file(std::move(text));
  TriangleSoup soup;
  std::string line, word;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto fail = [&](const std::string& what) {
      return Failure{Fault::kAsset, what, path + ":" + std::to_string(number)};
    };
    std::istringstream words(line);
    words >> word;
    if (words.fail()) continue;
    if (word == "v") {
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        // Read as words: streams refuse "nan", and the reader should learn which line it is on.
        if (!(words >> word)) return fail("a vertex has fewer than three numbers");
        char* end = nullptr;
        p[k] = std::strtod(word.c_str(), &end);
        if (end == word.c_str()) return fail("a vertex coordinate is not a number");
      }
      p = p.cwiseProduct(scale);
      if (!p.allFinite()) return fail("a vertex is not a finite number");
      if (p.cwiseAbs().maxCoeff() > kLimits.extent) {
        return fail("a vertex lies more than 1000 m from the origin");
      }
      soup.vertices.push_back(p);
    } else if (word == "f") {
      std::vector<std::uint32_t> loop;
      while (words >> word) {
        long index = corner_index(word);
        const long count = static_cast<long>(soup.vertices.size());
        if (index < 0) index += count + 1;
        if (index < 1 || index > count) return fail("a face names a vertex that is not there");
        loop.push_back(static_cast<std::uint32_t>(index - 1));
      }
      if (loop.size() < 3) return fail("a face has fewer than three corners");
      if (soup.indices.size() / 3 + loop.size() - 2 > allowed(kLimits.triangles)) {
        return fail("more than " + std::to_string(allowed(kLimits.triangles)) + " triangles" +
                    large_hint());
      }
      for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        soup.indices.insert(soup.indices.end(), {loop[0], loop[i], loop[i + 1]});
      }
    }
  }
  if (soup.indices.empty()) return Failure{Fault::kAsset, "the mesh has no faces", path};
  return soup;
}

Result<CollisionShape> make_mesh_shape(const TriangleSoup& mesh, const std::string& name,
                                       const HullOptions& options) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const std::uint32_t i : mesh.indices) {
    if (i >= mesh.vertices.size())
      return Failure{Fault::kAsset, "a face names a vertex that is not there", name};
    used[i] = true;
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = find_root(&parent, mesh.indices[i]);
      const std::uint32_t b = find_root(&parent, mesh.indices[i + k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  // Components in the order of their first vertex.
  std::vector<int> component_of_root(mesh.vertices.size(), -1);
  std::vector<std::vector<Vec3>> components;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!used[i]) continue;
    int& component = component_of_root[find_root(&parent, i)];
    if (component < 0) {
      component = static_cast<int>(components.size());
      components.emplace_back();
    }
    components[static_cast<std::size_t>(component)].push_back(mesh.vertices[i]);
  }
  return make_collision_shape(components, name, options);
}

Result<CollisionShape> load_collision_obj(const std::string& path, const Vec3& scale,
                                          const HullOptions& options) {
  PROBE_ASSIGN(const TriangleSoup soup, load_obj_triangles(path, scale));
  return make_mesh_shape(soup, path, options);
}

}  // namespace probe::scene
