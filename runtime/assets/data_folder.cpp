#include "runtime/assets/data_folder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/file.h"
#include "runtime/base/json.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;
constexpr int kDepth = 6;

bool read_point(const Json& box, const char* name, std::array<double, 3>& out) {
  if (!box.is_object() || !box.contains(name) || !box[name].is_array() || box[name].size() != 3) {
    return false;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!box[name][k].is_number()) return false;
    out[k] = box[name][k].get<double>();
  }
  return true;
}

// Empty when the entry is good, else what is wrong with it.
std::string read_info(const Json& entry, ModelInfo& info) {
  if (!entry.is_object() || !entry.contains("bbox") ||
      !read_point(entry["bbox"], "min", info.min) || !read_point(entry["bbox"], "max", info.max)) {
    return "has no bbox with min and max of three numbers";
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double size = info.max[k] - info.min[k];
    if (!std::isfinite(size) || size <= 0) return "has a box without size";
    if (size > 100) return "has a box of more than 100 m";
  }
  if (const Json* scales = entry.find("scales"); scales != nullptr && scales->is_array()) {
    for (const Json& scale : *scales) {
      if (!scale.is_number() || !(scale.get<double>() > 0))
        return "has a scale that is not above 0";
      info.scales.push_back(scale.get<double>());
    }
  }
  if (info.scales.empty()) info.scales.push_back(1);
  if (const Json* density = entry.find("density"); density != nullptr && density->is_number()) {
    info.density = density->get<double>();
  }
  if (!std::isfinite(info.density) || info.density < 0) return "has a density below 0";
  return "";
}

bool has_name(const fs::path& path, std::string_view name) { return path.filename() == name; }

// Databases in the order in which they win: those of the WidowX tasks first.
int rank(const fs::path& database) {
  const std::string name = database.filename().string();
  if (name == "info_bridge_custom_aqua.json") return 0;
  return name.starts_with("info_bridge") ? 1 : 2;
}

struct Finder {
  DataFolder& data;
  std::vector<fs::path> databases{};

  // Holds folders and nothing else: a shelf of further models.
  static bool is_shelf(const fs::path& folder) {
    std::error_code error;
    bool has_folder = false;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (!entry.is_directory(error)) return false;
      has_folder = true;
    }
    return has_folder;
  }

  void models_below(const fs::path& folder) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.is_directory(error) && !is_shelf(entry.path())) {
        data.models.try_emplace(entry.path().filename().string(), entry.path());
      }
    }
  }

  static void files_below(const fs::path& folder, std::map<std::string, fs::path>& out) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.is_regular_file(error)) {
        out.try_emplace(entry.path().filename().string(), entry.path());
      }
    }
  }

  // One folder; the ones below it in order of their names.
  void look(const fs::path& folder, int depth) {
    std::vector<fs::path> below;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const fs::path& path = entry.path();
      const std::string name = path.filename().string();
      if (entry.is_directory(error)) {
        if (!name.starts_with(".") && !entry.is_symlink(error)) below.push_back(path);
      } else if (name.starts_with("info_") && path.extension() == ".json") {
        databases.push_back(path);
      } else if (path.extension() == ".urdf") {
        data.urdfs.try_emplace(name, path);
        if (name == "wx250s.urdf" && !data.urdf) data.urdf = path;
      }
    }
    std::sort(below.begin(), below.end());
    for (const fs::path& path : below) {
      if (has_name(path, "models")) {
        models_below(path);
      } else if (has_name(path, "real_inpainting")) {
        files_below(path, data.photos);
      } else if (has_name(path, "stages")) {
        files_below(path, data.stages);
      } else if (depth > 1) {
        look(path, depth - 1);
      }
    }
  }
};

}  // namespace

void read_model_database(const fs::path& file, DataFolder& data) {
  const auto text = read_file(file.string(), {.code = Fault::kAsset});
  if (!text) {
    data.odd.push_back(text.failure());
    return;
  }
  const Json root = Json::parse(*text).sorted();
  if (!root.is_object()) {
    data.odd.push_back({Fault::kAsset, "is not a JSON object of models", file.string()});
    return;
  }
  for (const auto& [id, entry] : root.items()) {
    ModelInfo info;
    info.database = file.filename().string();
    const std::string wrong = read_info(entry, info);
    if (wrong.empty()) {
      data.infos.try_emplace(id, std::move(info));
    } else {
      data.odd.push_back({Fault::kAsset, "`" + id + "` " + wrong, file.string()});
    }
  }
}

Result<DataFolder> find_data(const std::string& folder, const std::string& robot,
                             std::span<const std::string_view> descriptions) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return Failure{Fault::kAsset, "is not a folder", folder};
  DataFolder data;
  Finder finder{data};
  // The folder itself may be one of the parts.
  const fs::path given = fs::absolute(folder).lexically_normal();
  finder.look(given, kDepth);
  std::stable_sort(finder.databases.begin(), finder.databases.end(),
                   [](const fs::path& a, const fs::path& b) {
                     return std::pair(rank(a), a.string()) < std::pair(rank(b), b.string());
                   });
  for (const fs::path& file : finder.databases) read_model_database(file, data);
  const bool has_robot = std::ranges::any_of(
      descriptions, [&](std::string_view name) { return data.urdfs.contains(std::string(name)); });
  if (data.models.empty() && data.photos.empty() && !has_robot && data.stages.empty()) {
    return Failure{Fault::kAsset,
                   "no SimplerEnv data in it: looked six folders deep for `models` (a folder a "
                   "model), `real_inpainting`, `stages` and " +
                       robot,
                   folder};
  }
  return data;
}

}  // namespace probe::assets
