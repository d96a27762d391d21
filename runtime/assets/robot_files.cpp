#include "runtime/assets/robot_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include "runtime/assets/model_files.h"

#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/robot/urdf.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

// The value of `name="value"` or 'value' in an element's text; empty when it is not there.
std::string attribute(std::string_view element, std::string_view name) {
  for (std::size_t at = element.find(name); at != element.npos; at = element.find(name, at + 1)) {
    std::size_t i = at + name.size();
    while (i < element.size() && (element[i] == ' ' || element[i] == '=')) ++i;
    if (i >= element.size() || (element[i] != '"' && element[i] != '\'')) continue;
    const std::size_t end = element.find(element[i], i + 1);
    if (end == element.npos) return "";
    return std::string(element.substr(i + 1, end - i - 1));
  }
  return "";
}

}  // namespace

Result<std::string> replace_meshes(
    const std::string& text, const std::function<Result<std::string>(const MeshElement&)>& rename) {
  std::string out;
  bool in_collision = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = std::min(text.find('<', at), text.size());
    out.append(text, at, open - at);
    if (open == text.size()) break;
    const bool is_comment = text.compare(open, 4, "<!--") == 0;
    std::size_t end = is_comment ? text.find("-->", open) : text.find('>', open);
    if (end == text.npos) return Failure{Fault::kUrdf, "an element is not closed", ""};
    end += is_comment ? 3 : 1;
    const std::string_view element(text.data() + open, end - open);
    if (element.starts_with("<collision")) in_collision = true;
    if (element.starts_with("</collision")) in_collision = false;
    if (element.starts_with("<mesh") && element.find("filename") != element.npos) {
      PROBE_ASSIGN(const std::string name, rename({attribute(element, "filename"),
                                                   attribute(element, "scale"), in_collision}));
      out += "<mesh filename=\"" + name + "\"";
      out += element.ends_with("/>") ? "/>" : ">";
    } else {
      out += element;
    }
    at = end;
  }
  return out;
}

Result<std::string> resolve_urdf_file(const std::string& folder, const std::string& written,
                                      const std::string& root) {
  constexpr std::string_view kPackage = "package://";
  if (!written.starts_with(kPackage)) return resolve_inside(folder, written, root);
  const std::string inside = written.substr(kPackage.size());
  const std::string package = inside.substr(0, inside.find('/'));
  for (fs::path above = fs::absolute(folder).lexically_normal(); above.has_relative_path();
       above = above.parent_path()) {
    if (above.filename() != package) continue;
    return resolve_inside(above.parent_path(), inside, root);
  }
  return Failure{Fault::kAsset, "no folder above the description is called `" + package + "`",
                 written};
}

Result<RobotFiles> convert_robot(const std::string& urdf, const scene::MeshLimits& limits) {
  PROBE_TRY(robot::load_urdf(urdf));
  PROBE_ASSIGN(const std::string text, read_file(urdf));
  const std::string folder = fs::absolute(urdf).lexically_normal().parent_path().string();
  RobotFiles robot;
  std::map<std::string, std::string> names;  // by file, scale and use
  std::set<std::string> taken;
  auto replaced = replace_meshes(text, [&](const MeshElement& element) -> Result<std::string> {
    const char* use = element.is_collision ? "_collision.obj" : ".glb";
    std::string& name = names[element.file + "|" + element.scale + "|" + use];
    if (!name.empty()) return name;
    PROBE_ASSIGN(const std::string path,
                 resolve_urdf_file(folder, element.file, limits.asset_root));
    Vec3 scale(1, 1, 1);
    if (!element.scale.empty() &&
        std::sscanf(element.scale.c_str(), "%lf %lf %lf", &scale[0], &scale[1], &scale[2]) != 3) {
      return Failure{Fault::kUrdf, "a mesh has the scale `" + element.scale + "`", urdf};
    }
    const std::string stem = "meshes/" + fs::path(path).stem().string();
    name = stem + use;
    // The same file at another scale, or another of the same name.
    for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}{}", stem, i, use);
    RobotFiles::File file{name, "", path, false};
    if (element.is_collision) {
      PROBE_ASSIGN(CollisionFile felt, convert_collision(path, scale, limits, false));
      file.bytes = std::move(felt.obj);
    } else {
      PROBE_ASSIGN(VisualFile seen, convert_visual(path, scale, limits, stem));
      file.bytes = std::move(seen.glb);
      file.is_untextured = seen.largest_texture == 0;
    }
    robot.meshes.push_back(std::move(file));
    return name;
  });
  if (!replaced) return replaced.failure();
  robot.urdf = *std::move(replaced);
  return robot;
}

}  // namespace probe::assets
