// What stands where in a LeRobot dataset, and what its columns are called.
#include <fmt/format.h>

#include "runtime/export/dataset/lerobot.h"

namespace probe::dataset::lerobot {

std::string camera_feature(const std::string& camera) { return "observation.images." + camera; }

std::vector<Feature> features_of(const Shape& shape) {
  using Kind = Feature::Kind;
  const auto texts = [](const auto& names) {
    return std::vector<std::string>(names.begin(), names.end());
  };
  std::vector<Feature> all;
  for (const CameraShape& camera : shape.cameras) {
    all.push_back({camera_feature(camera.name),
                   Kind::kVideo,
                   {camera.height, camera.width, 3},
                   {"height", "width", "channels"}});
  }
  all.push_back(
      {"observation.state", Kind::kReal32, {static_cast<int>(kStateSize)}, texts(kStateNames)});
  all.push_back(
      {"observation.joints", Kind::kReal32, {static_cast<int>(shape.joints.size())}, shape.joints});
  all.push_back(
      {"action", Kind::kReal32, {static_cast<int>(shape.action_size)}, action_names(shape)});
  all.push_back({"next.reward", Kind::kReal32, {1}});
  all.push_back({"next.done", Kind::kFlag, {1}});
  all.push_back({"next.success", Kind::kFlag, {1}});
  // Those that every dataset has, last.
  all.push_back({"timestamp", Kind::kReal32, {1}});
  all.push_back({"frame_index", Kind::kWhole, {1}});
  all.push_back({"episode_index", Kind::kWhole, {1}});
  all.push_back({"index", Kind::kWhole, {1}});
  all.push_back({"task_index", Kind::kWhole, {1}});
  return all;
}

parquet::Schema data_schema(const std::vector<Feature>& features) {
  parquet::Schema schema;
  for (const Feature& feature : features) {
    if (feature.is_video()) continue;
    const parquet::Type type = feature.kind == Feature::Kind::kReal32 ? parquet::Type::kReal32
                               : feature.kind == Feature::Kind::kFlag ? parquet::Type::kFlag
                                                                      : parquet::Type::kWhole;
    schema.push_back({feature.name, type, feature.size() > 1 ? 1 : 0});
  }
  return schema;
}

parquet::Schema episodes_schema(const std::vector<Feature>& features) {
  using parquet::Type;
  parquet::Schema schema = {
      {"episode_index", Type::kWhole, 0},   {"tasks", Type::kText, 1},
      {"length", Type::kWhole, 0},          {"data/chunk_index", Type::kWhole, 0},
      {"data/file_index", Type::kWhole, 0}, {"dataset_from_index", Type::kWhole, 0},
      {"dataset_to_index", Type::kWhole, 0}};
  for (const Feature& feature : features) {
    if (!feature.is_video()) continue;
    const std::string video = "videos/" + feature.name;
    schema.push_back({video + "/chunk_index", Type::kWhole, 0});
    schema.push_back({video + "/file_index", Type::kWhole, 0});
    schema.push_back({video + "/from_timestamp", Type::kReal64, 0});
    schema.push_back({video + "/to_timestamp", Type::kReal64, 0});
  }
  for (const Feature& feature : features) {
    for (const std::string_view name : kStatisticNames)
      schema.push_back({fmt::format("stats/{}/{}", feature.name, name), Type::kReal64,
                        feature.is_video() ? 3 : 1});
    schema.push_back({fmt::format("stats/{}/count", feature.name), Type::kWhole, 1});
  }
  schema.push_back({"meta/episodes/chunk_index", Type::kWhole, 0});
  schema.push_back({"meta/episodes/file_index", Type::kWhole, 0});
  return schema;
}

parquet::Schema tasks_schema() {
  return {{"task_index", parquet::Type::kWhole, 0}, {"task", parquet::Type::kText, 0}};
}

namespace {
std::string numbered(std::string_view folder, FileNumber number, std::string_view ending) {
  return fmt::format("{}/chunk-{:03}/file-{:03}.{}", folder, number.chunk, number.file, ending);
}
}  // namespace

std::string data_path(FileNumber number) { return numbered("data", number, "parquet"); }
std::string video_path(const std::string& feature, FileNumber number) {
  return numbered("videos/" + feature, number, "mp4");
}
std::string episodes_path(FileNumber number) {
  return numbered("meta/episodes", number, "parquet");
}

}  // namespace probe::dataset::lerobot
