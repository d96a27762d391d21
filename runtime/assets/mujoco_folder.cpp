#include "runtime/assets/mujoco_folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <numbers>
#include <set>

#include "runtime/assets/model_files.h"
#include "runtime/assets/mujoco_text.h"
#include "runtime/assets/output_folder.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

std::string made_of(const MujocoAsset& asset) {
  std::size_t bytes = 0;
  for (const MujocoFile& file : asset.files) bytes += file.bytes.size();
  std::string text = fmt::format("{}  {} files, {:.1f} MB", asset.name, asset.files.size(),
                                 static_cast<double>(bytes) / 1e6);
  if (asset.kind == MujocoKind::kBackdrop) return text;
  text += fmt::format("; {}, {:.4g} g", size_text(asset.high - asset.low), 1000 * asset.mass);
  for (const MujocoJoint& joint : asset.joints) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    text += joint.slides ? fmt::format("; {} slides {:.4g} .. {:.4g} cm", joint.name,
                                       100 * joint.lower, 100 * joint.upper)
            : joint.lower == joint.upper
                ? fmt::format("; {} turns", joint.name)
                : fmt::format("; {} turns {:.4g} .. {:.4g} deg", joint.name, kDegrees * joint.lower,
                              kDegrees * joint.upper);
  }
  return text;
}

}  // namespace

Result<MujocoFolder> make_mujoco_folder(const MujocoFolderOptions& options) {
  if (!options.name.empty() && options.files.size() > 1)
    return Failure{Fault::kUsage, "one name for several files", ""};
  if (!options.name.empty() && mujoco_identifier(options.name) != options.name)
    return Failure{
        Fault::kUsage,
        "a name has letters, digits and underscores, and a letter first: `" + options.name + "`",
        ""};
  PROBE_ASSIGN(OutputFolder out, OutputFolder::create(options.to));
  MujocoFolder made;
  std::set<std::string> taken;
  for (const std::string& file : options.files) {
    MujocoOptions one;
    one.file = file;
    one.merged_into = options.merged_into;
    one.kind = options.kind;
    const std::string stem =
        options.name.empty() ? mujoco_identifier(fs::path(file).stem().string()) : options.name;
    one.name = stem;
    for (int i = 2; !taken.insert(one.name).second; ++i) one.name = fmt::format("{}_{}", stem, i);
    PROBE_ASSIGN(const MujocoAsset asset, convert_mujoco(one));
    constexpr const char* kWords[] = {"", "object", "fixture", "backdrop"};
    made.lines.push_back({kWords[static_cast<std::size_t>(asset.kind)], made_of(asset)});
    for (const std::string& note : asset.notes) made.lines.push_back({"note", note});
    for (const MujocoFile& written : asset.files)
      PROBE_TRY(out.write(written.path, written.bytes, written.source));
    made.files += asset.files.size();
    if (asset.declaration.empty()) continue;
    std::string text =
        "# What it looks like and is good for is not in the file: colors, facts and phrases are "
        "yours to say.\n";
    text += asset.declaration;
    PROBE_TRY(out.write(asset.name + ".probe", text, file));
    ++made.files;
  }
  made.bytes = out.bytes();
  PROBE_TRY(out.finish());
  return made;
}

}  // namespace probe::assets
