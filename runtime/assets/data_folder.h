// Where things are in a user's SimplerEnv / ManiSkill2_real2sim folder. The repository, its data
// folder or a folder above both may be given: the parts are recognised by their names.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::assets {

struct ModelInfo {
  std::array<double, 3> min{}, max{};  // m, at scale 1
  std::vector<double> scales;
  double density = 0;    // kg/m3
  std::string database;  // the file it stands in
};

struct DataFolder {
  std::map<std::string, std::filesystem::path> models;          // folder of each, by id
  std::map<std::string, ModelInfo> infos;                       // of the databases, by id
  std::map<std::string, std::filesystem::path> photos, stages;  // by file name
  std::optional<std::filesystem::path> urdf;                    // wx250s.urdf
  std::map<std::string, std::filesystem::path> urdfs;           // all descriptions, by file name
  std::vector<Failure> odd;  // databases and entries that cannot be used
};

// Looks at most six folders deep. Fails (kAsset) when `folder` is not there, and when it
// holds none of these, saying what was looked for; `robot`: which description, in words;
// `descriptions`: their file names.
Result<DataFolder> find_data(const std::string& folder, const std::string& robot,
                             std::span<const std::string_view> descriptions);

// {"id": {"bbox": {"min": [..], "max": [..]}, "scales": [..], "density": ..}, ..}; an entry that is
// there already stays. What cannot be used goes to `odd`.
void read_model_database(const std::filesystem::path& file, DataFolder& data);

}  // namespace probe::assets
