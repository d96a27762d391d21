#include "compiler/geometry/mesh_origin.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace probe::sema {

namespace fs = std::filesystem;

namespace {
// As `assets pack` reads them.
constexpr std::array<std::string_view, 5> kEndings = {".obj", ".glb", ".gltf", ".dae", ".stl"};
}  // namespace

std::string origin_of(const AssetRoot& asset_root, const std::string& text,
                      const std::string& mesh) {
  const std::string path = "objects/" + mesh, folder = asset_root.holder(path);
  const auto is_same = [&](const fs::path& place) {
    std::error_code error;
    return fs::equivalent(folder, place, error);
  };
  fs::path beside = fs::path(text).parent_path();
  if (beside.empty()) beside = ".";
  if (is_same(beside) || is_same(beside / "assets")) return "`" + path + "` beside the text";
  if (std::getenv("VLAPROBE_ASSETS") == nullptr) {
    const auto own = find_asset_root();
    if (own.ok() && is_same(own->holder(path))) return "`" + path + "` of the program's own assets";
  }
  return "`" + path + "` of `" + folder + "`";
}

std::string file_beside(const std::string& text, const std::string& mesh) {
  const fs::path folder = fs::path(text).parent_path();
  std::error_code error;
  for (const fs::path& place : {folder, folder / "assets", folder / "assets/objects"}) {
    if (fs::is_regular_file(place / mesh, error)) return (place / mesh).string();
    for (const std::string_view ending : kEndings) {
      const fs::path file = place / (mesh + std::string(ending));
      if (fs::is_regular_file(file, error)) return file.string();
    }
  }
  return "";
}

std::string pack_advice(const std::string& text, const std::string& mesh) {
  const std::string found = file_beside(text, mesh);
  const std::string file = found.empty() ? "FILE.obj" : found;
  std::string name = fs::path(mesh).stem().string();
  if (!name.starts_with("my_")) name = "my_" + name;
  const fs::path objects = fs::path(text).parent_path() / "assets/objects";
  return "a mesh is a folder: `vlaprobe assets pack " + file + " -o " + (objects / name).string() +
         "` makes one, and `mesh \"" + name + "\"` is then " +
         (found.empty() ? "FILE.obj" : "`" + fs::path(found).filename().string() + "`");
}

}  // namespace probe::sema
