#include "runtime/assets/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/assets/identifier.h"
#include "runtime/assets/model_files.h"
#include "runtime/assets/output_folder.h"
#include "runtime/assets/robot_files.h"
#include "runtime/base/asset_path.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

Result<Packed> pack_robot(const PackOptions& options, const scene::MeshLimits& limits) {
  if (options.scale != 1 || !options.collision.empty() || !options.up.empty() || options.hollow) {
    return Failure{Fault::kUsage, "a URDF says scale, axes and collision meshes itself",
                   options.from};
  }
  PROBE_ASSIGN(const RobotFiles robot, convert_robot(options.from, limits));
  PROBE_ASSIGN(OutputFolder out, OutputFolder::create(options.to));
  for (const RobotFiles::File& file : robot.meshes) {
    PROBE_TRY(out.write(file.path, file.bytes, file.source));
  }
  const std::string name = fs::path(options.from).filename().string();
  PROBE_TRY(out.write(name, robot.urdf, options.from));
  PROBE_TRY(out.finish(false));
  return Packed{fmt::format("{} and {} meshes", name, robot.meshes.size()), {}, {}};
}

// The turn that brings the axis to z.
Result<Pose> upright(const PackOptions& options) {
  Pose pose;
  if (options.up.empty() || options.up == "z") return pose;
  if (options.up != "x" && options.up != "y")
    return Failure{Fault::kUsage, "--up is one of x, y and z, not `" + options.up + "`", ""};
  const std::string kind = lower_extension(options.from);
  if (kind != ".obj" && kind != ".stl")
    return Failure{Fault::kUsage, "--up is for obj and stl: a " + kind.substr(1) +
                                      " says itself which axis points up",
                   options.from};
  const double half = std::sqrt(0.5);  // a quarter turn about x, or back about y
  pose.rotation = options.up == "y" ? Quat(half, half, 0, 0) : Quat(half, 0, -half, 0);
  return pose;
}

// To a micrometre, more than a mesh's floats are good for after a turn.
std::string corner(const Vec3& p) {
  const auto rounded = [](double metres) { return std::round(1e6 * metres) / 1e4 + 0.0; };
  return fmt::format("({:.6g}cm, {:.6g}cm, {:.6g}cm)", rounded(p.x()), rounded(p.y()),
                     rounded(p.z()));
}

// Things on a table are between a grain and the table; empty of one that is.
std::string size_doubt(const PackOptions& options, const Vec3& size) {
  constexpr double kLargest = 2, kSmallest = 0.002;  // m
  const double longest = size.maxCoeff();
  if (longest <= kLargest && longest >= kSmallest) return "";
  const double factor = longest > kLargest ? (longest > 20 ? 0.001 : 0.01) : 1000;
  return fmt::format("it is {:.3g} m long: with `--scale {:g}` it would be {:.3g} cm", longest,
                     options.scale * factor, 100 * longest * factor);
}

std::vector<std::string> doubts_of(const PackOptions& options, const Vec3& size,
                                   const CollisionFile& felt) {
  constexpr double kFilled = 0.25;
  std::vector<std::string> doubts;
  if (std::string doubt = size_doubt(options, size); !doubt.empty())
    doubts.push_back(std::move(doubt));
  if (felt.filled > kFilled && !options.hollow) {
    doubts.push_back(
        fmt::format("what is felt is convex and fills its hollows ({:.0f} % of it is no part of the "
                    "mesh): nothing goes in; `--hollow` splits what is open upwards",
                    100 * felt.filled));
  }
  return doubts;
}

// To be pasted; what a mesh does not say is a guess to look at.
std::string text_of(const PackOptions& options, const Extent& extent) {
  fs::path folder = fs::path(options.to).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();  // a slash at the end
  const std::string name = identifier_of(folder.filename().string(), "my");
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return fmt::format(
      "object {} {{\n  mesh \"{}\"\n  box {} .. {}\n  density 500kg/m3  # a guess, as is the next "
      "line\n  friction 0.5\n  rest yaw 0deg, yaw 90deg  # how it lies in a layout that turns things\n"
      "  unseen\n  name \"{}\"\n}}\n",
      name, folder.filename().string(), corner(extent.min), corner(extent.max),
      words);
}

// Who finds an object that is packed there.
std::string finders(const PackOptions& options) {
  fs::path folder = fs::path(options.to).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  const std::string name = folder.filename().string();
  if (folder.parent_path().filename() != "objects") {
    return fmt::format("a text finds it as objects/{0} in a folder of assets: `-o assets/objects/{0}` "
                       "puts it there",
                       name);
  }
  const auto shown = [](const fs::path& path) { return path.empty() ? "." : path.string(); };
  const fs::path root = folder.parent_path().parent_path();
  const fs::path texts = root.filename() == "assets" ? root.parent_path() : root;
  return fmt::format("texts in `{}` find it; for others: `--assets {}`", shown(texts), shown(root));
}

// The mesh that is felt: the one named, or one called collision beside the one that is seen.
std::string find_collision(const PackOptions& options) {
  if (!options.collision.empty()) return options.collision;
  std::error_code error;
  for (const std::string_view extension : kMeshExtensions) {
    const fs::path file =
        fs::path(options.from).parent_path() / ("collision" + std::string(extension));
    if (fs::is_regular_file(file, error)) return file.string();
  }
  return options.from;
}

}  // namespace

Result<Packed> pack_asset(const PackOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale)) {
    return Failure{Fault::kUsage, "the scale must be above 0", ""};
  }
  const fs::path folder = fs::absolute(options.from).lexically_normal().parent_path();
  scene::MeshLimits limits;
  limits.asset_root = folder.parent_path().string();
  if (lower_extension(options.from) == ".urdf") {
    // Descriptions often name their meshes through the folder of a package above them.
    limits.asset_root = folder.parent_path().parent_path().string();
    return pack_robot(options, limits);
  }
  const Vec3 scale(options.scale, options.scale, options.scale);
  PROBE_ASSIGN(const Pose place, upright(options));
  const std::string name = fs::path(options.from).stem().string();
  PROBE_ASSIGN(const VisualFile seen, convert_visual(options.from, scale, limits, name, place));
  const std::string felt_from = find_collision(options);
  PROBE_ASSIGN(const CollisionFile felt,
               convert_collision(felt_from, scale, limits, felt_from == options.from, place,
                                 options.hollow));
  if (options.refuses_odd_size) {
    if (const std::string doubt = size_doubt(options, seen.extent.size()); !doubt.empty())
      return Failure{Fault::kUsage, doubt + "; `--scale 1` packs it as it is", options.from};
  }
  PROBE_ASSIGN(OutputFolder out, OutputFolder::create(options.to));
  PROBE_TRY(out.write("visual.glb", seen.glb, options.from));
  PROBE_TRY(out.write("collision.obj", felt.obj, felt_from));
  PROBE_TRY(out.finish(false));
  const Vec3 size = seen.extent.size();
  return Packed{fmt::format("{} triangles, {} convex part{}, {}; box {} .. {}{}", seen.triangles,
                            felt.parts, felt.parts == 1 ? "" : "s", size_text(size),
                            corner(seen.extent.min), corner(seen.extent.max),
                            felt.odd.empty() ? "" : "; " + felt.odd),
                doubts_of(options, size, felt), text_of(options, seen.extent), finders(options)};
}

}  // namespace probe::assets
