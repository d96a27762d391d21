#include "runtime/export/dataset/rlds.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/paths.h"
#include "runtime/export/dataset/packed_film.h"
#include "runtime/export/dataset/tfrecord.h"
#include "runtime/robot/rotation.h"
#include "runtime/scene/image.h"
#include "runtime/store/episode_key.h"

namespace probe::dataset::rlds {
namespace {

class PngMaker final : public FilmMaker {
 public:
  explicit PngMaker(std::size_t cameras) : film_(std::make_unique<PackedFilm>()) {
    film_->cameras.resize(cameras);
  }
  Status add(std::span<const Picture> pictures) override {
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const CameraShape& camera = *pictures[i].camera;
      PROBE_ASSIGN(std::string png, scene::png_bytes(camera.width, camera.height, pictures[i].rgb,
                                                     scene::PngEffort::kQuick));
      film_->cameras[i].push_back(std::move(png));
    }
    return {};
  }
  Result<std::unique_ptr<Film>> finish() override {
    return std::unique_ptr<Film>(std::move(film_));
  }

 private:
  std::unique_ptr<PackedFilm> film_;
};

// Bridge's: roll, pitch, yaw of the change in place of a rotation vector; gripper 0 closed .. 1
// open. Joints are as they are.
robot::Action bridge_action(const Shape& shape, const robot::Action& action) {
  robot::Action made = action;
  made.gripper() = (action.gripper() + 1) / 2;
  if (!shape.law.empty()) return made;
  const Vec3 turn = robot::to_rpy(
      robot::from_rotation_vector({action[robot::kActionTurn], action[robot::kActionTurn + 1],
                                   action[robot::kActionTurn + 2]}));
  for (int i = 0; i < 3; ++i) made[robot::kActionTurn + static_cast<std::size_t>(i)] = turn[i];
  return made;
}

// A leaf of features.json and the key of an Example. Which of Bridge's names it is, is said once.
struct Leaf {
  std::string name;
  enum class Kind { kImage, kReals, kReal, kFlag, kText, kWhole } kind;
  std::size_t size = 1;  // of kReals
  CameraShape camera = {};
};

std::string image_name(std::size_t camera) { return fmt::format("image_{}", camera); }

std::vector<Leaf> observation_leaves(const Shape& shape) {
  std::vector<Leaf> leaves;
  for (std::size_t i = 0; i < shape.cameras.size(); ++i)
    leaves.push_back({image_name(i), Leaf::Kind::kImage, 1, shape.cameras[i]});
  leaves.push_back({"state", Leaf::Kind::kReals, kStateSize});
  leaves.push_back({"joints", Leaf::Kind::kReals, shape.joints.size()});
  return leaves;
}
std::vector<Leaf> step_leaves(const Shape& shape) {
  return {{"action", Leaf::Kind::kReals, shape.action_size},
          {"discount", Leaf::Kind::kReal},
          {"reward", Leaf::Kind::kReal},
          {"is_first", Leaf::Kind::kFlag},
          {"is_last", Leaf::Kind::kFlag},
          {"is_terminal", Leaf::Kind::kFlag},
          {"language_instruction", Leaf::Kind::kText}};
}
std::vector<Leaf> metadata_leaves(const Shape& shape) {
  std::vector<Leaf> leaves = {{"file_path", Leaf::Kind::kText},
                              {"episode_id", Leaf::Kind::kWhole},
                              {"has_language", Leaf::Kind::kFlag},
                              {"success", Leaf::Kind::kFlag}};
  for (std::size_t i = 0; i < shape.cameras.size(); ++i)
    leaves.push_back({"has_" + image_name(i), Leaf::Kind::kFlag});
  return leaves;
}

std::string class_name(std::string_view name) {
  return fmt::format("tensorflow_datasets.core.features.{}", name);
}

Json dimensions(std::initializer_list<std::size_t> sides) {
  Json texts = Json::array();
  for (const std::size_t side : sides) texts.push_back(std::to_string(side));  // as protobuf's JSON
  Json shape = Json::object();
  if (texts.size() > 0) shape["dimensions"] = std::move(texts);
  return shape;
}

Json leaf_json(const Leaf& leaf) {
  using Kind = Leaf::Kind;
  Json json;
  if (leaf.kind == Kind::kImage) {
    json["pythonClassName"] = class_name("image_feature.Image");
    Json image;
    image["shape"] = dimensions({static_cast<std::size_t>(leaf.camera.height),
                                 static_cast<std::size_t>(leaf.camera.width), 3});
    image["dtype"] = "uint8";
    image["encodingFormat"] = "png";
    json["description"] = "camera " + leaf.camera.name;
    json["image"] = std::move(image);
    return json;
  }
  if (leaf.kind == Kind::kText) {
    json["pythonClassName"] = class_name("text_feature.Text");
    json["text"] = Json::object();
    return json;
  }
  Json tensor;
  tensor["shape"] = leaf.kind == Kind::kReals ? dimensions({leaf.size}) : dimensions({});
  tensor["dtype"] = leaf.kind == Kind::kFlag    ? "bool"
                    : leaf.kind == Kind::kWhole ? "int32"
                                                : "float32";
  tensor["encoding"] = "none";
  json["pythonClassName"] =
      class_name(leaf.kind == Kind::kReals ? "tensor_feature.Tensor" : "scalar.Scalar");
  json["tensor"] = std::move(tensor);
  return json;
}

Json dict_json(Json features) {
  Json json;
  json["pythonClassName"] = class_name("features_dict.FeaturesDict");
  json["featuresDict"]["features"] = std::move(features);
  return json;
}
Json leaves_json(const std::vector<Leaf>& leaves) {
  Json features = Json::object();
  for (const Leaf& leaf : leaves) features[leaf.name] = leaf_json(leaf);
  return features;
}

Json features_json(const Shape& shape) {
  Json step = leaves_json(step_leaves(shape));
  step["observation"] = dict_json(leaves_json(observation_leaves(shape)));
  Json steps;
  steps["pythonClassName"] = class_name("dataset_feature.Dataset");
  steps["sequence"]["feature"] = dict_json(std::move(step));
  Json root = Json::object();
  root["steps"] = std::move(steps);
  root["episode_metadata"] = dict_json(leaves_json(metadata_leaves(shape)));
  return dict_json(std::move(root));
}

class RldsLayout final : public Layout {
 public:
  RldsLayout(std::string dir, Shape shape, std::uint64_t most)
      : dir_(std::move(dir)), shape_(std::move(shape)), most_(most) {}

  Result<std::unique_ptr<FilmMaker>> film(std::size_t) const override {
    return std::unique_ptr<FilmMaker>(std::make_unique<PngMaker>(shape_.cameras.size()));
  }

  std::unique_ptr<Film> film_of(ByteReader& bytes) const override {
    return PackedFilm::read(bytes, shape_.cameras.size());
  }

  Status add(const Demonstration& demonstration, std::unique_ptr<Film> film) override {
    const auto& pictures = static_cast<const PackedFilm&>(*film);
    for (const std::string& wording : demonstration.wordings) {
      const std::string record = example(demonstration, wording, pictures);
      if (!file_ || bytes_in_file_ + record.size() >= most_) PROBE_TRY(begin_shard());
      PROBE_TRY(file_->add(record));
      bytes_in_file_ += record.size();
      bytes_ += record.size();
      ++lengths_.back();
      ++contents_.episodes;
      contents_.frames += static_cast<std::int64_t>(demonstration.steps.size());
    }
    ++contents_.demonstrations;
    return {};
  }

  // Names have the number of shards in them, so all are given now.
  Result<Contents> finish() override {
    if (file_) PROBE_TRY(file_->finish());
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      const std::string to =
          fmt::format("{}/{}-train.tfrecord-{:05}-of-{:05}", dir_, kName, i, lengths_.size());
      std::error_code error;
      std::filesystem::rename(shard_path(i), to, error);
      if (error) return Failure{Fault::kIo, "cannot be given its name: " + error.message(), to};
    }
    PROBE_TRY(write("features.json", features_json(shape_)));
    PROBE_TRY(write("dataset_info.json", info_json()));
    contents_.readme = fmt::format(
        "RLDS as TensorFlow Datasets reads it: `tfds.builder_from_directory(\"DIR/{}\")`, split "
        "`train`, in the step schema of BridgeData V2, pictures as PNG.\n\n"
        "| key | |\n|---|---|\n"
        "| `steps/observation/image_K` | what the policy saw before its action: {} |\n"
        "| `steps/observation/state` | tool centre point in the robot's base frame: x, y, z (m), "
        "roll, pitch, yaw (rad, Rz Ry Rx); gripper, 0 closed to 1 open |\n"
        "| `steps/observation/joints` | rad and m |\n"
        "| `steps/action` | change of the end effector in the robot's base frame: x, y, z (m), "
        "roll, pitch, yaw (rad) of the change; gripper, 0 closed to 1 open, absolute |\n"
        "| `steps/reward` | 1 in the last step of an episode that succeeded |\n",
        kDatasetVersion, cameras_text());
    return contents_;
  }

 private:
  std::string cameras_text() const {
    std::string text;
    for (std::size_t i = 0; i < shape_.cameras.size(); ++i)
      text += fmt::format("{}`{}` is camera `{}`", text.empty() ? "" : ", ", image_name(i),
                          shape_.cameras[i].name);
    return text;
  }
  std::string shard_path(std::size_t number) const {
    return fmt::format("{}/shard-{:05}", dir_, number);
  }

  Status begin_shard() {
    if (file_) PROBE_TRY(file_->finish());
    PROBE_ASSIGN(file_, RecordFile::create(shard_path(lengths_.size())));
    lengths_.push_back(0);
    bytes_in_file_ = 0;
    return {};
  }

  std::string example(const Demonstration& demonstration, const std::string& wording,
                      const PackedFilm& pictures) const {
    const std::size_t n = demonstration.steps.size();
    std::vector<float> state, joints, action, reward(n, 0.0f);
    // An episode that ran out of time ended nothing.
    std::vector<std::int64_t> first(n, 0), last(n, 0), terminal(n, 0);
    const auto append = [](std::vector<float>& to, const auto& from) {
      for (const double value : from) to.push_back(static_cast<float>(value));
    };
    for (const Step& step : demonstration.steps) {
      append(state, step.state);
      append(joints, step.joints);
      append(action, bridge_action(shape_, step.action));
    }
    reward.back() = demonstration.success ? 1.0f : 0.0f;
    first.front() = last.back() = 1;
    terminal.back() = demonstration.success ? 1 : 0;
    ExampleMessage message;
    const std::int64_t yes[] = {1}, id[] = {contents_.episodes},
                       success[] = {demonstration.success ? 1 : 0};
    for (std::size_t i = 0; i < shape_.cameras.size(); ++i) {
      message.bytes("steps/observation/" + image_name(i), pictures.cameras[i]);
      message.wholes("episode_metadata/has_" + image_name(i), yes);
    }
    message.reals("steps/observation/state", state);
    message.reals("steps/observation/joints", joints);
    message.reals("steps/action", action);
    message.reals("steps/discount", std::vector<float>(n, 1.0f));
    message.reals("steps/reward", reward);
    message.wholes("steps/is_first", first);
    message.wholes("steps/is_last", last);
    message.wholes("steps/is_terminal", terminal);
    message.bytes("steps/language_instruction", std::vector<std::string>(n, wording));
    const std::string path[] = {demonstration.run + "/" +
                                store::file_stem(store::key_of(demonstration.row))};
    message.bytes("episode_metadata/file_path", path);
    message.wholes("episode_metadata/episode_id", id);
    message.wholes("episode_metadata/has_language", yes);
    message.wholes("episode_metadata/success", success);
    return message.finish();
  }

  Json info_json() const {
    Json split;
    split["name"] = "train";
    split["numBytes"] = std::to_string(bytes_);
    split["shardLengths"] = Json::array();
    for (const std::int64_t length : lengths_)
      split["shardLengths"].push_back(std::to_string(length));
    split["filepathTemplate"] = "{DATASET}-{SPLIT}.{FILEFORMAT}-{SHARD_X_OF_Y}";
    Json json;
    json["name"] = kName;
    json["version"] = kDatasetVersion;
    json["fileFormat"] = "tfrecord";
    json["description"] = "simulated episodes, exported by vlaprobe";
    json["citation"] = "";
    json["splits"] = Json::array();
    json["splits"].push_back(std::move(split));
    return json;
  }

  Status write(const std::string& called, const Json& json) const {
    const std::string text = json.dump(2) + "\n";
    return write_file(dir_ + "/" + called, std::as_bytes(std::span(text)));
  }

  std::string dir_;
  Shape shape_;
  std::uint64_t most_, bytes_ = 0, bytes_in_file_ = 0;
  std::unique_ptr<RecordFile> file_;
  std::vector<std::int64_t> lengths_;  // of the shards
  Contents contents_;
};

}  // namespace

Result<std::unique_ptr<Layout>> open_layout(const std::string& dir, const Shape& shape,
                                            const DatasetOptions& options) {
  const std::string version = dir + "/" + kDatasetVersion;
  PROBE_TRY(make_folders(version));
  return std::unique_ptr<Layout>(std::make_unique<RldsLayout>(version, shape, options.most_data));
}

}  // namespace probe::dataset::rlds
