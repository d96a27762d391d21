// Three small scanners: JSON of glTF, lines of OBJ and MTL, <init_from> of Collada. STL names
// nothing.
#include "runtime/scene/mesh_references.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/base/json.h"

namespace probe::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostReferences = 1024;

Result<std::string> read_text(const std::string& path) {
  return read_file(path, {.most = kMaxMeshBytes, .code = Fault::kAsset});
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// The JSON chunk of a binary glTF, which comes first; empty when there is none.
std::string_view json_chunk(std::string_view glb) {
  std::uint32_t length = 0;
  if (glb.size() < 20 || glb.substr(0, 4) != "glTF" || glb.substr(16, 4) != "JSON") return {};
  std::memcpy(&length, glb.data() + 12, 4);
  return glb.substr(20, length);
}

std::vector<std::string> named_by_gltf(std::string_view json) {
  std::vector<std::string> names;
  const auto root = Json::parse(json);
  if (!root.is_object()) return names;
  for (const char* table : {"buffers", "images"}) {
    const Json* list = root.find(table);
    if (list == nullptr || !list->is_array()) continue;
    for (const auto& entry : *list) {
      if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
      const std::string uri = entry["uri"].get<std::string>();
      if (!uri.starts_with("data:")) names.push_back(percent_decoded(uri));
    }
  }
  return names;
}

std::vector<std::string> named_by_collada(std::string_view text) {
  constexpr std::string_view kOpen = "<init_from", kClose = "</init_from>";
  std::vector<std::string> names;
  // Surfaces have an <init_from> too, which names an image of this library.
  const std::size_t library = text.find("<library_images");
  if (library == text.npos) return names;
  text = text.substr(library, text.find("</library_images>", library) - library);
  for (std::size_t at = text.find(kOpen); at != text.npos; at = text.find(kOpen, at + 1)) {
    const std::size_t from = text.find('>', at), to = text.find(kClose, at);
    if (from == text.npos || to == text.npos || from + 1 > to) continue;
    std::string_view name = text.substr(from + 1, to - from - 1);
    if (const std::size_t ref = name.find("<ref>"); ref != name.npos) {  // Collada 1.5
      name = name.substr(ref + 5, name.find("</ref>") - ref - 5);
    }
    name = trimmed(name);
    if (name.starts_with("file://")) name.remove_prefix(7);
    if (!name.empty()) names.push_back(percent_decoded(name));
  }
  return names;
}

// Calls `line(keyword, rest)` for each line that has both.
template <typename Line>
void each_line(std::string_view text, const Line& line) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view words = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t space = words.find_first_of(" \t");
    if (space == words.npos) continue;
    line(words.substr(0, space), trimmed(words.substr(space)));
  }
}

// The file at the end of "-s 1 1 1 -bm 0.5 wood.png". Names may hold blanks, options may not.
std::string_view after_options(std::string_view rest) {
  while (rest.starts_with("-")) {
    const std::string_view option = rest.substr(0, rest.find(' '));
    int values = 1;
    if (option == "-mm") values = 2;
    if (option == "-o" || option == "-s" || option == "-t") values = 3;
    for (int i = 0; i <= values; ++i) {
      const std::size_t space = rest.find(' ');
      if (space == rest.npos) return {};
      rest = trimmed(rest.substr(space));
    }
  }
  return rest;
}

class Scan {
 public:
  Scan(const std::string& path, const std::string& asset_root)
      : folder_(fs::absolute(path).lexically_normal().parent_path()),
        root_(reference_root(path, asset_root)) {}

  // The resolved path, empty when it cannot be used.
  std::string add(const std::string& written) {
    for (const MeshReference& known : found) {
      if (known.written == written) return known.path;
    }
    if (found.size() == kMostReferences) {
      too_many = true;
      return "";
    }
    auto resolved = resolve_inside(folder_, written, root_);
    if (resolved) {
      found.push_back({written, *resolved, ""});
    } else {
      found.push_back({written, "", resolved.failure().message});
    }
    return found.back().path;
  }

  Status obj(std::string_view text) {
    std::vector<std::string> libraries;
    each_line(text, [&](std::string_view keyword, std::string_view rest) {
      if (keyword != "mtllib" || libraries.size() > kMostReferences) return;
      if (std::find(libraries.begin(), libraries.end(), rest) == libraries.end())
        libraries.emplace_back(rest);
    });
    for (const std::string& library : libraries) {
      const std::string file = add(library);
      if (file.empty()) continue;
      PROBE_ASSIGN(const std::string materials, read_text(file));
      each_line(materials, [&](std::string_view keyword, std::string_view rest) {
        const bool names_map = keyword.starts_with("map_") || keyword.starts_with("bump") ||
                               keyword == "disp" || keyword == "norm" || keyword == "refl";
        if (!names_map) return;
        const std::string_view name = after_options(rest);
        if (!name.empty()) add(std::string(name));
      });
    }
    return {};
  }

  std::vector<MeshReference> found;
  bool too_many = false;

 private:
  fs::path folder_;
  std::string root_;
};

}  // namespace

std::string percent_decoded(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const int lower = c | 0x20;
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 &&
        digit(text[i + 2]) >= 0) {
      out += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string reference_root(const std::string& path, const std::string& asset_root) {
  if (!asset_root.empty()) return asset_root;
  return fs::absolute(path).lexically_normal().parent_path().parent_path().string();
}

Result<std::vector<MeshReference>> mesh_references(const std::string& path,
                                                   const std::string& root) {
  const std::string extension = lower_extension(path);
  Scan scan(path, root);
  if (extension == ".stl") return scan.found;
  PROBE_ASSIGN(const std::string text, read_text(path));
  if (extension == ".obj") PROBE_TRY(scan.obj(text));
  std::vector<std::string> names;
  if (extension == ".gltf") names = named_by_gltf(text);
  if (extension == ".glb") names = named_by_gltf(json_chunk(text));
  if (extension == ".dae") names = named_by_collada(text);
  for (const std::string& name : names) scan.add(name);
  if (scan.too_many) {
    return Failure{Fault::kAsset,
                   "names more than " + std::to_string(kMostReferences) + " other files", path};
  }
  return std::move(scan.found);
}

}  // namespace probe::scene
