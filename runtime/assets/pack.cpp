#include "runtime/assets/pack.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "runtime/assets/model_files.h"
#include "runtime/assets/output_folder.h"
#include "runtime/assets/robot_files.h"
#include "runtime/base/asset_path.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

Result<std::string> pack_robot(const PackOptions& options, const scene::MeshLimits& limits) {
  if (options.scale != 1 || !options.collision.empty()) {
    return Failure{Fault::kUsage, "a URDF says the scale and collision meshes itself",
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
  return fmt::format("{} and {} meshes", name, robot.meshes.size());
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

Result<std::string> pack_asset(const PackOptions& options) {
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
  const std::string name = fs::path(options.from).stem().string();
  PROBE_ASSIGN(const VisualFile seen, convert_visual(options.from, scale, limits, name));
  const std::string felt_from = find_collision(options);
  PROBE_ASSIGN(const CollisionFile felt,
               convert_collision(felt_from, scale, limits, felt_from == options.from));
  PROBE_ASSIGN(OutputFolder out, OutputFolder::create(options.to));
  PROBE_TRY(out.write("visual.glb", seen.glb, options.from));
  PROBE_TRY(out.write("collision.obj", felt.obj, felt_from));
  PROBE_TRY(out.finish(false));
  const auto corner = [](const Vec3& p) {
    return fmt::format("({:.4g}cm, {:.4g}cm, {:.4g}cm)", 100 * p.x() + 0.0, 100 * p.y() + 0.0,
                       100 * p.z() + 0.0);
  };
  return fmt::format("{} triangles, {} convex part{}, {}; box {} .. {}{}", seen.triangles,
                     felt.parts, felt.parts == 1 ? "" : "s", size_text(seen.extent.size()),
                     corner(seen.extent.min), corner(seen.extent.max),
                     felt.odd.empty() ? "" : "; " + felt.odd);
}

}  // namespace probe::assets
