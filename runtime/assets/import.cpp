#include "runtime/assets/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <span>

#include "runtime/assets/catalogue_text.h"
#include "runtime/assets/data_folder.h"
#include "runtime/assets/known_models.h"
#include "runtime/assets/model_files.h"
#include "runtime/assets/output_folder.h"
#include "runtime/assets/robot_files.h"
#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/scene/glb_writer.h"
#include "runtime/scene/image.h"
#include "runtime/scene/photo_shape.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

constexpr double kBoxSlack = 0.005;  // m that a mesh may differ from its database entry
constexpr int kLargeTexture = 2048;
constexpr std::size_t kManyTriangles = 20'000;

// What a failure says, with the file's path relative to the data.
std::string short_text(const Failure& failure, const std::string& from) {
  std::string text = to_text(failure);
  const std::string prefix = fs::absolute(from).lexically_normal().string();
  if (const std::size_t at = text.find(prefix); at != text.npos) {
    text.erase(at, prefix.size());
    if (text.compare(at, 1, "/") == 0) text.erase(at, 1);
  }
  return text;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : "; ") + part;
  return out;
}

class Import {
 public:
  Import(const ImportOptions& options, DataFolder data, OutputFolder out)
      : options_(options), data_(std::move(data)), out_(std::move(out)) {
    limits_.asset_root = fs::absolute(options.from).lexically_normal().string();
    limits_.turn_up_axis = false;  // the simulator these files were made for does not
  }

  Result<ImportReport> run() {
    std::set<std::string> known;
    const bool is_google = options_.suite == ImportFor::kGoogle;
    const std::span<const KnownModel> models =
        is_google ? std::span<const KnownModel>(kGoogleModels) : kKnownModels;
    for (const KnownModel& model : models) {
      known.emplace(model.id);
      PROBE_TRY(add_model(std::string(model.id), std::string(model.folder), model.scale,
                          std::string(model.felt_as)));
    }
    if (is_google) {
      for (const std::string_view photo : kGooglePhotos) PROBE_TRY(add_photo(std::string(photo)));
      for (const KnownRobot& robot : kGoogleRobots) PROBE_TRY(add_robot(robot));
      for (const std::string_view name : kGoogleOwn) PROBE_TRY(take_own(std::string(name)));
    } else {
      for (const KnownScene& scene : kKnownScenes) PROBE_TRY(add_scene(scene));
      PROBE_TRY(add_robot());
    }
    // The rest of the models keep their names, but for those that a known one has been given.
    for (const auto& [id, folder] : data_.models) {
      if (known.contains(id)) continue;
      if (std::ranges::find(models, "objects/" + id, &KnownModel::folder) != models.end()) continue;
      const auto info = data_.infos.find(id);
      const double scale = info == data_.infos.end() ? 1 : info->second.scales.front();
      PROBE_TRY(add_model(id, "objects/" + id, scale));
    }
    for (const Failure& odd : data_.odd) {
      say(Verdict::kOdd, "database", short_text(odd, options_.from));
    }
    if (report_.files == 0) {
      return Failure{Fault::kAsset, "nothing in it can be used: " + report_.lines.front().text,
                     options_.from};
    }
    PROBE_TRY(write("objects.probe", catalogue_text(objects_), "the model databases"));
    report_.bytes = out_.bytes();
    PROBE_TRY(out_.finish());
    return std::move(report_);
  }

 private:
  void say(Verdict verdict, const std::string& name, std::string text) {
    report_.lines.push_back({verdict, name, std::move(text)});
  }

  Status write(const std::string& path, std::string_view bytes, const std::string& source) {
    PROBE_TRY(out_.write(path, bytes, source));
    ++report_.files;
    return {};
  }

  std::string relative(const fs::path& path) const {
    return path.lexically_relative(limits_.asset_root).generic_string();
  }

  // ---- models

  static std::string find_mesh(const fs::path& folder, const std::string& stem) {
    std::error_code error;
    for (const std::string_view extension : kMeshExtensions) {
      const fs::path file = folder / (stem + std::string(extension));
      if (fs::is_regular_file(file, error)) return file.string();
    }
    return "";
  }

  Status add_model(const std::string& id, const std::string& name, double scale,
                   const std::string& felt_as = "") {
    const auto folder = data_.models.find(id);
    if (folder == data_.models.end()) return miss(name, "no model `" + id + "` in the data");
    const std::string seen = find_mesh(folder->second, "textured");
    std::string felt = find_mesh(folder->second, "collision");
    const bool is_unseen = id == kUnseenModel;
    if (seen.empty() && !is_unseen) {
      return miss(name, id + " has no textured.glb, .gltf, .dae, .obj or .stl");
    }
    // In the release both meshes are the same bytes, and a copy of it may keep only one of them.
    const auto plain = data_.models.find(felt_as);
    const bool from_plain = felt.empty() && plain != data_.models.end();
    if (from_plain) felt = find_mesh(plain->second, "collision");
    const Vec3 scales(scale, scale, scale);
    auto visual = is_unseen ? unseen_visual() : convert_visual(seen, scales, limits_, id);
    if (!visual) return miss(name, short_text(visual.failure(), options_.from));
    const bool from_visual = felt.empty();
    if (from_visual) felt = seen;
    auto collision = convert_collision(felt, scales, limits_, from_visual);
    if (!collision) return miss(name, short_text(collision.failure(), options_.from));

    PROBE_TRY(write(name + "/visual.glb", visual->glb, is_unseen ? id : relative(seen)));
    PROBE_TRY(write(name + "/collision.obj", collision->obj, relative(felt)));
    std::vector<std::string> odd = oddities(id, scale, *visual, *collision);
    if (from_plain && !from_visual) odd.push_back("felt as " + felt_as);
    if (is_unseen) odd.push_back("never drawn in the reference: the photo shows it");
    const std::string summary = fmt::format(
        "{}{}: {} triangles, {}{} convex part{}, {}", id,
        scale == 1 ? "" : fmt::format(" at {}", scale), visual->triangles,
        visual->largest_texture == 0 ? "" : fmt::format("{} px texture, ", visual->largest_texture),
        collision->parts, collision->parts == 1 ? "" : "s", size_text(collision->extent.size()));
    say(odd.empty() ? Verdict::kTaken : Verdict::kOdd, name,
        odd.empty() ? summary : summary + "; " + joined(odd));
    if (name.starts_with("objects/")) note_object(id, name.substr(8), scale, *collision);
    return {};
  }

  // A speck that no ray meets, for what is only felt.
  static Result<VisualFile> unseen_visual() {
    constexpr float kSpeck = 1e-4f;
    scene::GlbDocument document{std::string(kUnseenModel), kGenerator, {}, {{}}, {}};
    document.parts.push_back(
        {{0, 0, 0, kSpeck, 0, 0, 0, kSpeck, 0}, {0, 0, 1, 0, 0, 1, 0, 0, 1}, {}, {0, 1, 2}, 0});
    VisualFile file;
    file.glb = scene::glb_bytes(document);
    file.triangles = 1;
    return file;
  }

  std::vector<std::string> oddities(const std::string& id, double scale, const VisualFile& visual,
                                    const CollisionFile& collision) const {
    std::vector<std::string> odd;
    if (!collision.odd.empty()) odd.push_back(collision.odd);
    const auto info = data_.infos.find(id);
    if (info == data_.infos.end()) {
      odd.push_back("in no model database");
    } else {
      const ModelInfo& known = info->second;
      const Extent box{scale * Vec3(known.min.data()), scale * Vec3(known.max.data())};
      const auto differs = [&](const Extent& extent) {
        return (extent.min - box.min).cwiseAbs().maxCoeff() > kBoxSlack ||
               (extent.max - box.max).cwiseAbs().maxCoeff() > kBoxSlack;
      };
      if (id != kUnseenModel && differs(visual.extent)) {
        odd.push_back(
            "seen as " + size_text(visual.extent.size()) + ", the database says " +
            size_text(box.size()) +
            (visual.extent.size().isApprox(box.size(), 0.05) ? " about another origin" : ""));
      }
      if (differs(collision.extent)) {
        odd.push_back("felt as " + size_text(collision.extent.size()) + ", the database says " +
                      size_text(box.size()));
      }
      if (std::find(known.scales.begin(), known.scales.end(), scale) == known.scales.end()) {
        odd.push_back(fmt::format("the database has it at {}", fmt::join(known.scales, ", ")));
      }
      if (known.density <= 0) odd.push_back("the database gives no density");
    }
    if (visual.largest_texture > kLargeTexture) odd.push_back("large texture");
    if (visual.triangles > kManyTriangles) odd.push_back("many triangles");
    return odd;
  }

  void note_object(const std::string& id, const std::string& folder, double scale,
                   const CollisionFile& collision) {
    CatalogueObject object{folder, collision.extent.min, collision.extent.max, 1000};
    if (const auto info = data_.infos.find(id); info != data_.infos.end()) {
      object.min = scale * Vec3(info->second.min.data());
      object.max = scale * Vec3(info->second.max.data());
      if (info->second.density > 0) object.density = info->second.density;
    }
    objects_.push_back(object);
  }

  // ---- scenes

  struct Photo {
    std::string bytes;  // as in its file
    scene::ImageSize size;
  };
  // Decodes all of it: one that is cut off is told now, and not by a run.
  static Result<Photo> read_photo(const fs::path& path) {
    PROBE_ASSIGN(std::string bytes, read_file(path.string()));
    PROBE_ASSIGN(const scene::Texture texture,
                 scene::decode_image(std::as_bytes(std::span(bytes)), path.string()));
    return Photo{std::move(bytes), {texture.width, texture.height}};
  }

  Status add_scene(const KnownScene& scene) {
    const std::string name = "scenes/" + std::string(scene.name);
    const auto photo = data_.photos.find(std::string(scene.photo));
    const auto stage = data_.stages.find(std::string(scene.stage));
    std::vector<std::string> taken, odd;
    if (photo != data_.photos.end()) {
      const auto read = read_photo(photo->second);
      if (!read) return miss(name, short_text(read.failure(), options_.from));
      const std::string extension = lower_extension(photo->second);
      PROBE_TRY(write(name + "/photo" + extension, read->bytes, relative(photo->second)));
      const scene::ImageSize size = read->size;
      taken.push_back(fmt::format("photo {}, {} x {}", scene.photo, size.width, size.height));
      if (const auto defect = scene::photo_defect(size, kBridgeWidth, kBridgeHeight)) {
        odd.push_back(*defect);
      } else if (size.width != kBridgeWidth || size.height != kBridgeHeight) {
        odd.push_back(fmt::format("the camera's picture is {} x {}: the photo is scaled to it",
                                  kBridgeWidth, kBridgeHeight));
      }
    } else {
      odd.push_back("no photo " + std::string(scene.photo));
    }
    if (stage != data_.stages.end()) {
      const Pose place{Vec3(kStageOffset.data()), Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0)};
      auto visual = convert_visual(stage->second.string(), {1, 1, 1}, limits_,
                                   std::string(scene.name), place);
      if (visual) {
        PROBE_TRY(write(name + "/visual.glb", visual->glb, relative(stage->second)));
        taken.push_back(fmt::format("stage {}, {} triangles", scene.stage, visual->triangles));
      } else {
        odd.push_back(short_text(visual.failure(), options_.from));
      }
    } else {
      odd.push_back("no stage " + std::string(scene.stage) +
                    ": the table is in no depth picture and hides nothing");
    }
    if (taken.empty()) return miss(name, joined(odd));
    say(odd.empty() ? Verdict::kTaken : Verdict::kOdd, name,
        joined(taken) + (odd.empty() ? "" : "; " + joined(odd)));
    return {};
  }

  // A photo alone. One of another shape is taken by nobody: the picture would be of other places.
  Status add_photo(const std::string& file) {
    const std::string name = "scenes/google/" + file;
    const auto photo = data_.photos.find(file);
    if (photo == data_.photos.end()) return miss(name, "no photo " + file);
    const auto read = read_photo(photo->second);
    if (!read) return miss(name, short_text(read.failure(), options_.from));
    if (const auto defect = scene::photo_defect(read->size, kGoogleWidth, kGoogleHeight))
      return miss(name, *defect);
    PROBE_TRY(write(name, read->bytes, relative(photo->second)));
    say(Verdict::kTaken, name, fmt::format("{} x {}", read->size.width, read->size.height));
    return {};
  }

  // ---- robot

  Status add_robot(const KnownRobot& known) {
    const std::string folder = "robots/google_released";
    const std::string name = folder + "/" + std::string(known.name) + ".urdf";
    const auto urdf = data_.urdfs.find(std::string(known.file));
    if (urdf == data_.urdfs.end()) return miss(name, "no " + std::string(known.file));
    const auto robot = convert_robot(urdf->second.string(), limits_);
    if (!robot) return miss(name, short_text(robot.failure(), options_.from));
    for (const RobotFiles::File& file : robot->meshes) {
      if (known.is_colouring && file.is_untextured)
        return miss(name, relative(file.source) + " has no texture: it would be plain");
    }
    // Colourings share meshes of one name: each has a folder of its own.
    const std::string own = "meshes/" + std::string(known.name) + "/";
    for (const RobotFiles::File& file : robot->meshes) {
      const std::string below = own + file.path.substr(file.path.rfind('/') + 1);
      PROBE_TRY(write(folder + "/" + below, file.bytes, relative(file.source)));
    }
    std::string text = robot->urdf;
    for (std::size_t at = 0; (at = text.find("filename=\"meshes/", at)) != text.npos;) {
      at += std::string_view("filename=\"").size();
      text.replace(at, std::string_view("meshes/").size(), own);
    }
    PROBE_TRY(write(name, text, relative(urdf->second)));
    say(Verdict::kTaken, name,
        fmt::format("{}: {} mesh files", known.file, robot->meshes.size()));
    return {};
  }

  Status add_robot() {
    const std::string name = "robots/widowx";
    if (!data_.urdf) return miss(name, "no wx250s.urdf in the data");
    const auto robot = convert_robot(data_.urdf->string(), limits_);
    if (!robot) return miss(name, short_text(robot.failure(), options_.from));
    for (const RobotFiles::File& file : robot->meshes) {
      PROBE_TRY(write(name + "/" + file.path, file.bytes, relative(file.source)));
    }
    PROBE_TRY(write(name + "/wx250s.urdf", robot->urdf, relative(*data_.urdf)));
    say(Verdict::kTaken, name,
        fmt::format("{}: {} mesh files", data_.urdf->filename().string(), robot->meshes.size()));
    return {};
  }

  // ---- what is not there

  // Says so, and takes ours if that was asked for.
  Status miss(const std::string& name, const std::string& why) {
    std::error_code error;
    const std::string& from = options_.fill_from;
    if (from.empty() || !fs::is_directory(fs::path(from) / name, error)) {
      say(Verdict::kMissing, name, why);
      return {};
    }
    PROBE_TRY(copy_ours(name, from));
    say(Verdict::kFilled, name, why + ": vlaprobe's own is taken");
    return {};
  }

  // What the suite is written for and no data has: nothing is missing in the data.
  Status take_own(const std::string& name) {
    std::error_code error;
    for (const std::string& folder : options_.own) {
      if (!fs::is_directory(fs::path(folder) / name, error)) continue;
      PROBE_TRY(copy_ours(name, folder));
      say(Verdict::kOwn, name, "vlaprobe's: no release has it in that form");
      return {};
    }
    say(Verdict::kMissing, name, "the suite's own");
    return {};
  }

  Status copy_ours(const std::string& name, const std::string& from) {
    std::error_code error;
    std::vector<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(from) / name, error)) {
      if (entry.is_regular_file(error)) paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
    for (const fs::path& path : paths) {
      PROBE_ASSIGN(const std::string bytes, read_file(path.string()));
      const std::string below = path.lexically_relative(from).generic_string();
      PROBE_TRY(out_.write(below, bytes, "vlaprobe's own " + below));
    }
    return {};
  }

  const ImportOptions& options_;
  DataFolder data_;
  OutputFolder out_;
  scene::MeshLimits limits_;
  ImportReport report_;
  std::vector<CatalogueObject> objects_;
};

}  // namespace

const char* to_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kTaken:
      return "taken";
    case Verdict::kOdd:
      return "odd";
    case Verdict::kMissing:
      return "missing";
    case Verdict::kFilled:
      return "filled";
    case Verdict::kOwn:
      return "own";
  }
  return "";
}

Result<ImportReport> import_data(const ImportOptions& options) {
  const bool is_google = options.suite == ImportFor::kGoogle;
  std::vector<std::string_view> descriptions{"wx250s.urdf"};
  if (is_google) {
    descriptions.clear();
    for (const KnownRobot& robot : kGoogleRobots) descriptions.push_back(robot.file);
  }
  PROBE_ASSIGN(DataFolder data,
               find_data(options.from, is_google ? "the Google robot's `.urdf`" : "`wx250s.urdf`",
                         descriptions));
  PROBE_ASSIGN(OutputFolder out, OutputFolder::create(options.to));
  return Import(options, std::move(data), std::move(out)).run();
}

}  // namespace probe::assets
