// LeRobotDataset v3.0: Parquet tables, one H.264 mp4 of many episodes for each camera, JSON. Every
// wording of a demonstration is an episode of its own; all of them share its stretch of video.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/export/dataset/dataset.h"
#include "runtime/export/dataset/layout.h"
#include "runtime/export/dataset/statistics.h"
#include "runtime/export/parquet/schema.h"

namespace probe::dataset::lerobot {

inline constexpr const char* kVersion = "v3.0";
inline constexpr int kChunkSize = 1000;  // files in a folder

// A column of data/, or a camera's video, as info.json lists them in order.
struct Feature {
  std::string name;
  enum class Kind { kVideo, kReal32, kWhole, kFlag } kind = Kind::kReal32;
  std::vector<int> shape;  // height, width, 3 of a video
  std::vector<std::string> names = {};

  bool is_video() const { return kind == Kind::kVideo; }
  std::size_t size() const { return is_video() ? 3 : static_cast<std::size_t>(shape.front()); }
};
std::vector<Feature> features_of(const Shape& shape);
std::string camera_feature(const std::string& camera);

parquet::Schema data_schema(const std::vector<Feature>& features);
parquet::Schema episodes_schema(const std::vector<Feature>& features);
parquet::Schema tasks_schema();

// Which file of a kind: folder and number in it.
struct FileNumber {
  int chunk = 0, file = 0;
  FileNumber next() const {
    return file + 1 < kChunkSize ? FileNumber{chunk, file + 1} : FileNumber{chunk + 1, 0};
  }
};
std::string data_path(FileNumber number);  // below the dataset's folder
std::string video_path(const std::string& feature, FileNumber number);
std::string episodes_path(FileNumber number);
inline constexpr const char* kInfoPath = "meta/info.json";
inline constexpr const char* kStatsPath = "meta/stats.json";
inline constexpr const char* kTasksPath = "meta/tasks.parquet";

// Writes into `dir`, which is there and empty.
Result<std::unique_ptr<Layout>> open_layout(const std::string& dir, const Shape& shape,
                                            const DatasetOptions& options);

}  // namespace probe::dataset::lerobot
