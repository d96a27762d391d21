#include "runtime/export/dataset/lerobot.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <utility>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/export/parquet/writer.h"
#include "runtime/show/clip.h"

namespace probe::dataset::lerobot {
namespace {

// Rows of episodes/ that are gathered before they are written.
constexpr std::size_t kEpisodesTogether = 200;

// pandas reads the index, which alone has the texts, from this note; without it every instruction
// would be a number.
constexpr const char* kPandasNote =
    R"({"index_columns": ["task"], "column_indexes": [{"name": null, "field_name": null, )"
    R"("pandas_type": "unicode", "numpy_type": "object", "metadata": {"encoding": "UTF-8"}}], )"
    R"("columns": [{"name": "task_index", "field_name": "task_index", "pandas_type": "int64", )"
    R"("numpy_type": "int64", "metadata": null}, {"name": "task", "field_name": "task", )"
    R"("pandas_type": "unicode", "numpy_type": "object", "metadata": null}], )"
    R"("creator": {"library": "pyarrow", "version": "21.0.0"}, "pandas_version": "2.3.0"})";

Result<std::string> place_for(const std::string& dir, const std::string& path) {
  const std::filesystem::path file = std::filesystem::path(dir) / path;
  PROBE_TRY(make_folders(file.parent_path().string()));
  return file.string();
}

// A camera's.
struct Reel {
  show::Clip clip;
  Statistics statistics;
};
struct Reels final : Film {
  std::vector<Reel> cameras;

  void write(ByteWriter& bytes) const override {
    for (const auto& [clip, statistics] : cameras) {
      bytes.text({reinterpret_cast<const char*>(clip.header.data()), clip.header.size()});
      bytes.u32(static_cast<std::uint32_t>(clip.packets.size()));
      for (const show::Clip::Packet& packet : clip.packets) {
        bytes.u8(packet.is_key ? 1 : 0);
        bytes.text({reinterpret_cast<const char*>(packet.bytes.data()), packet.bytes.size()});
      }
      for (const std::vector<double>& values : statistics.values) bytes.reals(values);
      bytes.u64(static_cast<std::uint64_t>(statistics.count));
    }
  }
  static std::unique_ptr<Film> read(ByteReader& bytes,
                                    const std::vector<show::ClipFormat>& formats) {
    const auto some = [&bytes] {
      const std::string text = bytes.text();
      return std::vector<std::uint8_t>(text.begin(), text.end());
    };
    auto film = std::make_unique<Reels>();
    for (const show::ClipFormat& format : formats) {
      Reel reel;
      reel.clip.format = format;
      reel.clip.header = some();
      reel.clip.packets.resize(bytes.count(bytes.u32(), 1 + sizeof(std::uint32_t)));
      for (show::Clip::Packet& packet : reel.clip.packets) {
        packet.is_key = bytes.u8() != 0;
        packet.bytes = some();
      }
      for (std::vector<double>& values : reel.statistics.values) values = bytes.reals();
      reel.statistics.count = static_cast<std::int64_t>(bytes.u64());
      film->cameras.push_back(std::move(reel));
    }
    if (!bytes.ok()) return nullptr;
    return film;
  }
};

class ReelMaker final : public FilmMaker {
 public:
  ReelMaker(std::vector<std::unique_ptr<show::ClipEncoder>> encoders, std::size_t steps)
      : encoders_(std::move(encoders)),
        statistics_(encoders_.size()),
        sampled_(sampled_frames(steps)) {}

  Status add(std::span<const Picture> pictures) override {
    const bool is_sampled = next_ < sampled_.size() && sampled_[next_] == frame_;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const Picture& picture = pictures[i];
      PROBE_TRY(encoders_[i]->add(picture.rgb));
      if (is_sampled)
        statistics_[i].add(picture.rgb, picture.camera->width, picture.camera->height);
    }
    if (is_sampled) ++next_;
    ++frame_;
    return {};
  }

  Result<std::unique_ptr<Film>> finish() override {
    auto film = std::make_unique<Reels>();
    for (std::size_t i = 0; i < encoders_.size(); ++i) {
      PROBE_ASSIGN(show::Clip clip, encoders_[i]->finish());
      film->cameras.push_back({std::move(clip), statistics_[i].finish()});
    }
    return std::unique_ptr<Film>(std::move(film));
  }

 private:
  std::vector<std::unique_ptr<show::ClipEncoder>> encoders_;
  std::vector<PictureStatistics> statistics_;
  std::vector<std::size_t> sampled_;
  std::size_t frame_ = 0, next_ = 0;
};

// A camera's video files, one after the other.
struct VideoFile {
  FileNumber number;
  std::unique_ptr<show::ClipJoiner> joiner;
  std::uint64_t bytes = 0;
  std::int64_t frames = 0;
};

// Where an episode's pictures are in them.
struct Stretch {
  FileNumber number;
  std::int64_t from = 0, to = 0;  // frames of the file
};

class LerobotLayout final : public Layout {
 public:
  LerobotLayout(std::string dir, const Shape& shape, const DatasetOptions& options)
      : dir_(std::move(dir)),
        shape_(shape),
        most_data_(options.most_data),
        most_video_(options.most_video),
        features_(features_of(shape)),
        data_rows_(data_schema(features_)),
        episode_rows_(episodes_schema(features_)),
        videos_(shape.cameras.size()),
        sums_(features_.size()) {
    for (const CameraShape& camera : shape_.cameras)
      formats_.push_back({camera.width, camera.height, shape_.fps});
  }

  Result<std::unique_ptr<FilmMaker>> film(std::size_t steps) const override {
    std::vector<std::unique_ptr<show::ClipEncoder>> encoders;
    for (const show::ClipFormat& format : formats_) {
      PROBE_ASSIGN(auto encoder, show::ClipEncoder::create(format));
      encoders.push_back(std::move(encoder));
    }
    return std::unique_ptr<FilmMaker>(std::make_unique<ReelMaker>(std::move(encoders), steps));
  }

  std::unique_ptr<Film> film_of(ByteReader& bytes) const override {
    return Reels::read(bytes, formats_);
  }

  Status add(const Demonstration& demonstration, std::unique_ptr<Film> film) override {
    const auto& reels = static_cast<const Reels&>(*film);
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < videos_.size(); ++i) {
      PROBE_ASSIGN(const Stretch stretch, put_video(i, reels.cameras[i].clip));
      stretches.push_back(stretch);
    }
    for (const std::string& wording : demonstration.wordings)
      PROBE_TRY(put_episode(demonstration, wording, reels, stretches));
    ++contents_.demonstrations;
    return {};
  }

  Result<Contents> finish() override {
    for (VideoFile& video : videos_) {
      if (video.joiner) PROBE_TRY(video.joiner->finish());
    }
    if (data_) PROBE_TRY(data_->finish());
    PROBE_TRY(flush_episodes());
    if (episodes_) PROBE_TRY(episodes_->finish());
    PROBE_TRY(write_tasks());
    PROBE_TRY(write_json(kStatsPath, stats_json()));
    PROBE_TRY(write_json(kInfoPath, info_json()));
    contents_.readme = readme();
    contents_.card =
        "---\ntask_categories:\n- robotics\ntags:\n- LeRobot\nconfigs:\n- config_name: default\n"
        "  data_files: data/*/*.parquet\n---\n\n";
    return contents_;
  }

 private:
  // A stretch never crosses files; the first one of a file begins at 0.
  Result<Stretch> put_video(std::size_t camera, const show::Clip& clip) {
    VideoFile& video = videos_[camera];
    if (video.joiner && video.bytes + clip.bytes() >= most_video_) {
      PROBE_TRY(video.joiner->finish());
      video = {video.number.next(), nullptr, 0, 0};
    }
    if (!video.joiner) {
      PROBE_ASSIGN(
          const std::string path,
          place_for(dir_, video_path(camera_feature(shape_.cameras[camera].name), video.number)));
      PROBE_ASSIGN(video.joiner, show::ClipJoiner::create(path, clip));
    }
    PROBE_TRY(video.joiner->add(clip));
    const Stretch stretch{video.number, video.frames,
                          video.frames + static_cast<std::int64_t>(clip.packets.size())};
    video.bytes += clip.bytes();
    video.frames = stretch.to;
    return stretch;
  }

  std::int64_t task_index(const std::string& wording) {
    const auto [found, is_new] =
        task_indices_.emplace(wording, static_cast<std::int64_t>(task_indices_.size()));
    if (is_new) tasks_.push_back(wording);
    return found->second;
  }

  // One row group an episode, as LeRobot's own files have it.
  Status put_episode(const Demonstration& demonstration, const std::string& wording,
                     const Reels& reels, const std::vector<Stretch>& stretches) {
    const std::size_t length = demonstration.steps.size();
    const std::int64_t task = task_index(wording);
    const std::int64_t from = contents_.frames;
    // Every feature's numbers, frame after frame, as they will be read.
    std::vector<std::vector<double>> numbers(features_.size());
    for (std::size_t frame = 0; frame < length; ++frame) {
      const Step& step = demonstration.steps[frame];
      const bool is_last = frame + 1 == length;
      const bool is_success = is_last && demonstration.success;
      const auto k = static_cast<std::int64_t>(frame);
      std::size_t at = shape_.cameras.size();
      const auto reals = [&](std::span<const double> values) {
        // A list of one would be a list; a feature of one is a number.
        if (features_[at].size() > 1) {
          data_rows_.reals(values);
        } else {
          data_rows_.real(values.front());
        }
        for (const double value : values)
          numbers[at].push_back(static_cast<double>(static_cast<float>(value)));
        ++at;
      };
      const auto flag = [&](bool value) {
        data_rows_.flag(value);
        numbers[at++].push_back(value ? 1 : 0);
      };
      const auto whole = [&](std::int64_t value) {
        data_rows_.whole(value);
        numbers[at++].push_back(static_cast<double>(value));
      };
      const double reward[] = {is_success ? 1.0 : 0.0};
      const double time[] = {static_cast<double>(k) / shape_.fps};
      reals(step.state);
      reals(step.joints);
      reals(step.action);
      reals(reward);
      flag(is_last);
      flag(is_success);
      reals(time);
      whole(k);
      whole(contents_.episodes);
      whole(from + k);
      whole(task);
    }
    PROBE_TRY(put_data());

    const std::string tasks[] = {wording};
    episode_rows_.whole(contents_.episodes).texts(tasks).whole(static_cast<std::int64_t>(length));
    episode_rows_.whole(data_number_.chunk).whole(data_number_.file);
    contents_.frames += static_cast<std::int64_t>(length);
    episode_rows_.whole(from).whole(contents_.frames);
    for (const Stretch& stretch : stretches) {
      episode_rows_.whole(stretch.number.chunk).whole(stretch.number.file);
      episode_rows_.real(static_cast<double>(stretch.from) / shape_.fps);
      episode_rows_.real(static_cast<double>(stretch.to) / shape_.fps);
    }
    for (std::size_t i = 0; i < features_.size(); ++i) {
      const Statistics statistics = features_[i].is_video()
                                        ? reels.cameras[i].statistics
                                        : statistics_of(numbers[i], features_[i].size());
      put_statistics(features_[i], statistics);
      sums_[i].add(statistics);
    }
    episode_rows_.whole(0).whole(0);
    ++contents_.episodes;
    if (episode_rows_.count() >= kEpisodesTogether) PROBE_TRY(flush_episodes());
    return {};
  }

  void put_statistics(const Feature& feature, const Statistics& statistics) {
    constexpr std::size_t kChannels[] = {3, 1, 1};
    for (const auto& values : statistics.values) {
      if (feature.is_video()) {
        episode_rows_.reals(values, kChannels);
      } else {
        episode_rows_.reals(values);
      }
    }
    const std::int64_t count[] = {statistics.count};
    episode_rows_.wholes(count);
  }

  Status put_data() {
    if (data_ && data_->bytes() + data_rows_.bytes() >= most_data_) {
      PROBE_TRY(data_->finish());
      data_.reset();
      data_number_ = data_number_.next();
    }
    if (!data_) {
      PROBE_ASSIGN(const std::string path, place_for(dir_, data_path(data_number_)));
      PROBE_ASSIGN(data_, parquet::Writer::create(path, data_rows_.schema()));
    }
    PROBE_TRY(data_->write(data_rows_));
    data_rows_.clear();
    return {};
  }

  // One file: a row is some kilobytes, so that 100 MB are tens of thousands of episodes.
  Status flush_episodes() {
    if (!episodes_) {
      PROBE_ASSIGN(const std::string path, place_for(dir_, episodes_path({})));
      PROBE_ASSIGN(episodes_, parquet::Writer::create(path, episode_rows_.schema()));
    }
    PROBE_TRY(episodes_->write(episode_rows_));
    episode_rows_.clear();
    return {};
  }

  Status write_tasks() {
    PROBE_ASSIGN(const std::string path, place_for(dir_, kTasksPath));
    PROBE_ASSIGN(auto writer,
                 parquet::Writer::create(path, tasks_schema(), {{"pandas", kPandasNote}}));
    parquet::Rows rows(tasks_schema());
    for (std::size_t i = 0; i < tasks_.size(); ++i)
      rows.whole(static_cast<std::int64_t>(i)).text(tasks_[i]);
    PROBE_TRY(writer->write(rows));
    return writer->finish();
  }

  Status write_json(const std::string& path, const Json& json) {
    PROBE_ASSIGN(const std::string file, place_for(dir_, path));
    const std::string text = json.dump(4) + "\n";
    return write_file(file, std::as_bytes(std::span(text)));
  }

  Json stats_json() const {
    Json json = Json::object();
    for (std::size_t i = 0; i < features_.size(); ++i) {
      const Statistics& total = sums_[i].total();
      Json of = Json::object();
      for (std::size_t k = 0; k < kStatisticNames.size(); ++k) {
        Json values = Json::array();
        for (const double value : total.values[k]) {
          values.push_back(features_[i].is_video() ? Json::array({Json::array({value})})
                                                   : Json(value));
        }
        of[kStatisticNames[k]] = std::move(values);
      }
      of["count"] = Json::array({total.count});
      json[features_[i].name] = std::move(of);
    }
    return json;
  }

  Json feature_json(const Feature& feature) const {
    constexpr const char* kTypes[] = {"video", "float32", "int64", "bool"};
    Json json;
    json["dtype"] = kTypes[static_cast<std::size_t>(feature.kind)];
    json["shape"] = feature.shape;
    json["names"] = feature.names.empty() ? Json(nullptr) : Json(feature.names);
    if (!feature.is_video()) return json;
    Json info;
    info["video.height"] = feature.shape[0];
    info["video.width"] = feature.shape[1];
    info["video.codec"] = "h264";
    info["video.pix_fmt"] = "yuv420p";
    info["video.fps"] = shape_.fps;
    info["video.channels"] = 3;
    info["has_audio"] = false;
    info["video.g"] = show::ClipFormat{}.group;
    info["video.crf"] = show::ClipFormat{}.quality;
    info["is_depth_map"] = false;
    json["info"] = std::move(info);
    return json;
  }

  Json info_json() const {
    Json json;
    json["codebase_version"] = kVersion;
    json["fps"] = shape_.fps;
    Json features = Json::object();
    for (const Feature& feature : features_) features[feature.name] = feature_json(feature);
    json["features"] = std::move(features);
    json["total_episodes"] = contents_.episodes;
    json["total_frames"] = contents_.frames;
    json["total_tasks"] = tasks_.size();
    json["chunks_size"] = kChunkSize;
    json["data_files_size_in_mb"] = 100;
    json["video_files_size_in_mb"] = 200;
    json["data_path"] = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet";
    json["video_path"] = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4";
    json["robot_type"] = shape_.robot;
    json["splits"] = Json::object();
    json["splits"]["train"] = fmt::format("0:{}", contents_.episodes);
    return json;
  }

  std::string readme() const {
    return "A [LeRobotDataset](https://github.com/huggingface/lerobot) " + std::string(kVersion) +
           ": `LeRobotDataset(repo_id, root=DIR)`.\n\n"
           "| feature | |\n|---|---|\n"
           "| `observation.images.*` | what the policy saw before its action; H.264, yuv420p |\n"
           "| `observation.state` | tool centre point in the robot's base frame: x, y, z (m), "
           "roll, pitch, yaw (rad, Rz Ry Rx); gripper, 0 closed to 1 open |\n"
           "| `observation.joints` | rad and m |\n"
           "| `action` | " +
           action_meaning(shape_) +
           " |\n"
           "| `next.reward`, `next.success` | 1 and true in the last step of an episode that "
           "succeeded |\n\n"
           "Episodes of one demonstration in several wordings share its stretch of video.\n";
  }

  std::string dir_;
  Shape shape_;
  std::uint64_t most_data_, most_video_;
  std::vector<Feature> features_;
  std::vector<show::ClipFormat> formats_;
  parquet::Rows data_rows_, episode_rows_;
  std::unique_ptr<parquet::Writer> data_, episodes_;
  FileNumber data_number_;
  std::vector<VideoFile> videos_;
  std::vector<StatisticsSum> sums_;  // by feature
  std::map<std::string, std::int64_t> task_indices_;
  std::vector<std::string> tasks_;
  Contents contents_;
};

}  // namespace

Result<std::unique_ptr<Layout>> open_layout(const std::string& dir, const Shape& shape,
                                            const DatasetOptions& options) {
  for (const CameraShape& camera : shape.cameras) {
    if (camera.width % 2 != 0 || camera.height % 2 != 0) {
      return Failure{Fault::kUsage,
                     fmt::format("pictures of camera `{}` are {} x {}, and a video has even sides",
                                 camera.name, camera.width, camera.height),
                     "--size"};
    }
    if (camera.name.find('/') != std::string::npos)
      return Failure{Fault::kUsage, "a feature's name has no slash", camera.name};
  }
  return std::unique_ptr<Layout>(std::make_unique<LerobotLayout>(dir, shape, options));
}

}  // namespace probe::dataset::lerobot
