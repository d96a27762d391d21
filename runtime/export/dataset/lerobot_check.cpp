// A LeRobot dataset as it lies there, against what its traces make of it: rows and episodes in
// their order, files one row group at a time, so that memory does not grow with the dataset.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/export/dataset/findings.h"
#include "runtime/export/dataset/format_checks.h"
#include "runtime/export/dataset/lerobot.h"
#include "runtime/export/dataset/video_check.h"
#include "runtime/export/parquet/reader.h"
#include "runtime/show/clip.h"

namespace probe::dataset {
namespace {

using namespace lerobot;
using parquet::ReadColumn;

// Tables of one schema in several files, row group after row group.
class Groups {
 public:
  Groups(std::string dir, parquet::Schema schema, std::string (*path_of)(FileNumber))
      : dir_(std::move(dir)), schema_(std::move(schema)), path_of_(path_of) {}

  // The next group's columns, empty behind the last.
  Result<std::vector<ReadColumn>> next() {
    while (!reader_ || group_ == reader_->group_count()) {
      if (reader_) number_ = number_.next();
      const std::string path = dir_ + "/" + path_of_(number_);
      if (!is_file(path)) return std::vector<ReadColumn>();
      PROBE_ASSIGN(reader_, parquet::Reader::open(path));
      group_ = 0;
      if (reader_->schema() != schema_)
        return Failure{Fault::kIo, "has other columns than the dataset's features", path};
    }
    return reader_->read(group_++);
  }
  FileNumber number() const { return number_; }

 private:
  std::string dir_;
  parquet::Schema schema_;
  std::string (*path_of_)(FileNumber);
  std::optional<parquet::Reader> reader_;
  FileNumber number_;
  std::size_t group_ = 0;
};

// What is left of a video file to be looked at when all episodes are known.
struct VideoNeed {
  std::int64_t frames = 0;
  std::size_t camera = 0;
};

class LerobotCheck {
 public:
  LerobotCheck(std::string dir, NamedRuns runs, PicturesAgain* again)
      : dir_(std::move(dir)),
        runs_(std::move(runs)),
        shape_(runs_.shape()),
        features_(features_of(shape_)),
        data_(dir_, data_schema(features_), data_path),
        episodes_(dir_, episodes_schema(features_), episodes_path) {
    if (again != nullptr) pictures_.emplace(*again);
  }

  Result<CheckReport> check() {
    PROBE_TRY(read_tasks());
    const bool is_whole =
        each_episode(runs_, findings_, [&](const auto& named, const auto& wording, bool is_first) {
          return episode(named, wording, is_first);
        });
    if (!is_whole) return findings_.report;
    PROBE_TRY(nothing_is_left());
    videos();
    PROBE_TRY(info());
    PROBE_TRY(statistics());
    return findings_.report;
  }

 private:
  void problem(std::string text) { findings_.problem(std::move(text)); }
  void expect(bool is_so, const std::string& where, const std::string& what) {
    findings_.expect(is_so, where, what);
  }

  Status read_tasks() {
    const std::string path = dir_ + "/" + kTasksPath;
    PROBE_ASSIGN(const auto reader, parquet::Reader::open(path));
    expect(reader.schema() == tasks_schema(), path, "has other columns than task_index and task");
    expect(std::ranges::any_of(reader.notes(),
                               [](const auto& note) { return note.first == "pandas"; }),
           path, "has no note `pandas`, without which every instruction is read as a number");
    if (reader.schema() != tasks_schema()) return {};
    for (std::size_t group = 0; group < reader.group_count(); ++group) {
      PROBE_ASSIGN(const auto columns, reader.read(group));
      for (std::size_t i = 0; i < columns[0].wholes.size(); ++i) {
        expect(columns[0].wholes[i] == static_cast<std::int64_t>(tasks_.size()), path,
               fmt::format("row {} has task_index {}", tasks_.size(), columns[0].wholes[i]));
        tasks_.push_back(columns[1].texts[i]);
      }
    }
    return {};
  }

  Status episode(const NamedDemonstration& named, const std::string& wording, bool is_first) {
    const std::string where = fmt::format("episode {} ({})", findings_.report.episodes, named.name);
    if (episode_rows_.empty() || row_ == episode_rows_.front().rows()) {
      PROBE_ASSIGN(episode_rows_, episodes_.next());
      row_ = 0;
    }
    if (episode_rows_.empty()) return Failure{Fault::kIo, "the dataset ends before it", where};
    PROBE_ASSIGN(const auto rows, data_.next());
    if (rows.empty()) return Failure{Fault::kIo, "there are no rows of it", where};
    const auto length = static_cast<std::int64_t>(named.trace.steps.size());
    if (rows.front().rows() != static_cast<std::size_t>(length))
      return Failure{Fault::kIo,
                     fmt::format("has {} rows, its trace {} steps", rows.front().rows(), length),
                     where};
    check_rows(named, wording, rows, where);
    const auto stretches = check_episode_row(wording, length, is_first, where);
    if (!pictures_) {
      findings_.report.not_redrawn += length;
    } else if (is_first) {
      pictures_->check(findings_, named, stretches, where);
    }
    ++row_;
    return {};
  }

  const ReadColumn* column_of(const std::vector<ReadColumn>& columns, std::string_view name) const {
    for (const ReadColumn& column : columns) {
      if (column.column.name == name) return &column;
    }
    return nullptr;
  }

  // The numbers of a frame.
  std::span<const double> reals(const std::vector<ReadColumn>& columns, std::string_view name,
                                std::size_t row) const {
    const ReadColumn& column = *column_of(columns, name);
    return std::span(column.reals)
        .subspan(column.begins[row], column.begins[row + 1] - column.begins[row]);
  }
  std::int64_t whole(const std::vector<ReadColumn>& columns, std::string_view name,
                     std::size_t row) const {
    return column_of(columns, name)->wholes[row];
  }
  bool flag(const std::vector<ReadColumn>& columns, std::string_view name, std::size_t row) const {
    return column_of(columns, name)->flags[row] != 0;
  }

  void check_rows(const NamedDemonstration& named, const std::string& wording,
                  const std::vector<ReadColumn>& rows, const std::string& where) {
    const auto& steps = named.trace.steps;
    const std::size_t joints = shape_.joints.size();
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const std::string at = fmt::format("{} frame {}", where, i);
      const bool is_last = i + 1 == steps.size(), is_success = is_last && named.success;
      const auto k = static_cast<std::int64_t>(i);
      expect(equal_singles(reals(rows, "action", i), steps[i].action), at,
             "action is not the trace's");
      expect(equal_singles(reals(rows, "observation.joints", i),
                           joints_before(named.trace, i, joints)),
             at, "observation.joints are not the trace's");
      expect_state(findings_, reals(rows, "observation.state", i), named.base,
                   sample_before(named.trace, i), at, "observation.state");
      const double reward[] = {is_success ? 1.0 : 0.0},
                   time[] = {static_cast<double>(k) / shape_.fps};
      expect(equal_singles(reals(rows, "next.reward", i), reward), at,
             "next.reward is not the verdict");
      expect(flag(rows, "next.success", i) == is_success, at, "next.success is not the verdict");
      expect(flag(rows, "next.done", i) == is_last, at,
             "next.done is not true in the last row alone");
      expect(equal_singles(reals(rows, "timestamp", i), time), at,
             "timestamp is not frame_index / fps");
      expect(whole(rows, "frame_index", i) == k, at, "frame_index does not count from 0");
      expect(whole(rows, "episode_index", i) == findings_.report.episodes, at,
             "episode_index is another");
      expect(whole(rows, "index", i) == findings_.report.frames + k, at,
             "index does not count all frames");
      const std::int64_t task = whole(rows, "task_index", i);
      expect(task >= 0 && static_cast<std::size_t>(task) < tasks_.size() &&
                 tasks_[static_cast<std::size_t>(task)] == wording,
             at, "task_index is not that of its wording");
    }
  }

  // Returns where its pictures are, of each camera.
  std::vector<VideoStretch> check_episode_row(const std::string& wording, std::int64_t length,
                                              bool is_first, const std::string& where) {
    std::vector<VideoStretch> stretches;
    const auto& rows = episode_rows_;
    expect(whole(rows, "episode_index", row_) == findings_.report.episodes, where,
           "episode_index is another");
    expect(whole(rows, "length", row_) == length, where, "length is not its trace's");
    expect(whole(rows, "dataset_from_index", row_) == findings_.report.frames &&
               whole(rows, "dataset_to_index", row_) == findings_.report.frames + length,
           where, "dataset_from_index, dataset_to_index are not its rows");
    expect(whole(rows, "data/chunk_index", row_) == data_.number().chunk &&
               whole(rows, "data/file_index", row_) == data_.number().file,
           where, "its rows are in another file than it says");
    const ReadColumn& tasks = *column_of(rows, "tasks");
    expect(tasks.begins[row_ + 1] - tasks.begins[row_] == 1 &&
               tasks.texts[tasks.begins[row_]] == wording,
           where, "tasks is not its wording");
    for (std::size_t i = 0; i < shape_.cameras.size(); ++i) {
      const std::string feature = camera_feature(shape_.cameras[i].name);
      const std::string key = "videos/" + feature;
      const FileNumber number{static_cast<int>(whole(rows, key + "/chunk_index", row_)),
                              static_cast<int>(whole(rows, key + "/file_index", row_))};
      const double from = reals(rows, key + "/from_timestamp", row_)[0];
      const double to = reals(rows, key + "/to_timestamp", row_)[0];
      VideoNeed& need = videos_[video_path(feature, number)];
      need.camera = i;
      const auto begin = static_cast<std::int64_t>(std::llround(from * shape_.fps));
      if (is_first) {
        expect(begin == need.frames, where, key + " does not begin where the episode before ends");
        need.frames = begin + length;
      }
      expect(std::abs(from - static_cast<double>(begin) / shape_.fps) < 1e-9 &&
                 std::abs(to - static_cast<double>(begin + length) / shape_.fps) < 1e-9 &&
                 begin + length == need.frames,
             where, key + " is not a stretch of its length");
      stretches.push_back({dir_ + "/" + video_path(feature, number), begin});
    }
    return stretches;
  }

  Status nothing_is_left() {
    PROBE_ASSIGN(const auto rows, data_.next());
    expect(rows.empty(), "data", "has rows behind the last episode");
    if (!episode_rows_.empty() && row_ < episode_rows_.front().rows())
      problem("meta/episodes: has episodes behind the last demonstration");
    PROBE_ASSIGN(const auto more, episodes_.next());
    expect(more.empty(), "meta/episodes", "has episodes behind the last demonstration");
    return {};
  }

  void videos() {
    for (const auto& [path, need] : videos_) {
      const auto facts = show::read_video_facts(dir_ + "/" + path);
      if (!facts) {
        problem(to_text(facts.failure()));
        continue;
      }
      const CameraShape& camera = shape_.cameras[need.camera];
      expect(facts->codec == "h264", path, "is not H.264 but " + facts->codec);
      expect(facts->width == camera.width && facts->height == camera.height, path,
             "has pictures of another size");
      expect(facts->frames == need.frames, path,
             fmt::format("has {} frames, its episodes {}", facts->frames, need.frames));
      expect(facts->is_even && facts->frames_per_second == shape_.fps, path,
             "its frames are not evenly spaced at the dataset's rate");
    }
  }

  Result<Json> read_json(const char* path) const {
    PROBE_ASSIGN(const std::string text, read_file(dir_ + "/" + path));
    Json json = Json::parse(text);
    if (!json.is_object()) return Failure{Fault::kIo, "is no JSON object", dir_ + "/" + path};
    return json;
  }

  Status info() {
    PROBE_ASSIGN(const Json json, read_json(kInfoPath));
    const auto is = [&](const char* key, const Json& wanted) {
      expect(json.contains(key) && json.at(key) == wanted, kInfoPath,
             fmt::format("`{}` is not {}", key, wanted.dump()));
    };
    is("codebase_version", kVersion);
    is("fps", shape_.fps);
    is("total_episodes", findings_.report.episodes);
    is("total_frames", findings_.report.frames);
    is("total_tasks", tasks_.size());
    is("robot_type", shape_.robot);
    is("chunks_size", kChunkSize);
    Json splits = Json::object();
    splits["train"] = fmt::format("0:{}", findings_.report.episodes);
    is("splits", splits);
    const Json* features = json.find("features");
    if (features == nullptr || features->items().size() != features_.size()) {
      problem(std::string(kInfoPath) + ": `features` are not the dataset's");
      return {};
    }
    for (std::size_t i = 0; i < features_.size(); ++i) {
      const auto& [name, feature] = features->items()[i];
      expect(name == features_[i].name && feature.contains("shape") &&
                 feature.at("shape") == Json(features_[i].shape),
             kInfoPath, fmt::format("feature {} is not `{}`", i, features_[i].name));
    }
    return {};
  }

  // Numbers that a policy divides by: finite, and in their order.
  Status statistics() {
    PROBE_ASSIGN(const Json json, read_json(kStatsPath));
    for (const Feature& feature : features_) {
      const std::string where = std::string(kStatsPath) + " `" + feature.name + "`";
      const Json* of = json.find(feature.name);
      if (of == nullptr) {
        problem(where + ": is not there");
        continue;
      }
      for (std::size_t i = 0; i < feature.size(); ++i) {
        const auto number = [&](std::string_view name) -> double {
          const Json* values = of->find(name);
          if (values == nullptr || !values->is_array() || values->size() != feature.size())
            return NAN;
          const Json* value = values->begin() + i;
          while (value->is_array() && value->size() == 1) value = value->begin();
          return value->is_number() ? value->get<double>() : NAN;
        };
        constexpr std::string_view kOrder[] = {"min", "q01", "q10", "q50", "q90", "q99", "max"};
        for (std::size_t k = 1; k < std::size(kOrder); ++k)
          expect(number(kOrder[k - 1]) <= number(kOrder[k]), where,
                 fmt::format("{} is not below {}", kOrder[k - 1], kOrder[k]));
        expect(number("min") <= number("mean") && number("mean") <= number("max"), where,
               "mean is not between min and max");
        expect(number("std") >= 0 && std::isfinite(number("std")), where, "std is no deviation");
      }
    }
    return {};
  }

  std::string dir_;
  NamedRuns runs_;
  Shape shape_;
  std::vector<Feature> features_;
  Groups data_, episodes_;
  std::vector<std::string> tasks_;
  std::vector<ReadColumn> episode_rows_;
  std::size_t row_ = 0;  // of these
  std::map<std::string, VideoNeed> videos_;
  std::optional<VideoCheck> pictures_;  // nothing: they are not looked at
  Findings findings_;
};

}  // namespace

Result<CheckReport> check_lerobot(const std::string& dir, NamedRuns runs, PicturesAgain* again) {
  return LerobotCheck(dir, std::move(runs), again).check();
}

}  // namespace probe::dataset
