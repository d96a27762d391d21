// An RLDS dataset as it lies there, against what its traces make of it: record after record, so
// that memory does not grow with the dataset.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/export/dataset/findings.h"
#include "runtime/export/dataset/format_checks.h"
#include "runtime/export/dataset/rlds.h"
#include "runtime/export/dataset/tfrecord_read.h"
#include "runtime/robot/rotation.h"
#include "runtime/scene/image.h"

namespace probe::dataset {
namespace {

constexpr double kNear = 1e-5;  // floats of angles

// The leaves' keys within an Example, as features.json nests them.
void add_keys(const Json& feature, const std::string& prefix, std::set<std::string>& keys) {
  if (const Json* sequence = feature.find("sequence")) {
    if (const Json* inner = sequence->find("feature")) add_keys(*inner, prefix, keys);
    return;
  }
  const Json* dict = feature.find("featuresDict");
  const Json* inner = dict == nullptr ? nullptr : dict->find("features");
  if (inner == nullptr) {
    keys.insert(prefix);
    return;
  }
  for (const auto& [name, of] : inner->items())
    add_keys(of, prefix.empty() ? name : prefix + "/" + name, keys);
}

class RldsCheck {
 public:
  RldsCheck(const std::string& dir, NamedRuns runs, PicturesAgain* again)
      : dir_(dir + "/" + rlds::kDatasetVersion),
        runs_(std::move(runs)),
        again_(again),
        shape_(runs_.shape()) {}

  Result<CheckReport> check() {
    PROBE_TRY(read_info());
    const bool is_whole = each_episode(
        runs_, findings_,
        [&](const auto& named, const auto& wording, bool) { return episode(named, wording); });
    if (!is_whole) return findings_.report;
    PROBE_ASSIGN(const auto more, next_record());
    findings_.expect(!more, dir_, "has records behind the last demonstration");
    findings_.expect(bytes_ == wanted_bytes_, dir_ + "/dataset_info.json",
                     fmt::format("numBytes is {}, the records have {}", wanted_bytes_, bytes_));
    return findings_.report;
  }

 private:
  void expect(bool is_so, const std::string& where, const std::string& what) {
    findings_.expect(is_so, where, what);
  }

  Status read_info() {
    const std::string path = dir_ + "/dataset_info.json";
    const Failure strange{Fault::kIo, "is not what `vlaprobe export` writes", path};
    PROBE_ASSIGN(const std::string text, read_file(path));
    const Json info = Json::parse(text);
    const Json* splits = info.find("splits");
    if (splits == nullptr || !splits->is_array() || splits->size() != 1) return strange;
    const Json* lengths = splits->front().find("shardLengths");
    if (lengths == nullptr || !lengths->is_array()) return strange;
    for (const Json& length : *lengths) {
      if (!length.is_string()) return strange;
      lengths_.push_back(std::strtoll(length.text().c_str(), nullptr, 10));
    }
    wanted_bytes_ = std::strtoull(splits->front().value("numBytes", "0").c_str(), nullptr, 10);
    expect(info.value("name", "") == rlds::kName, path, "names another dataset");
    const std::string features = dir_ + "/features.json";
    PROBE_ASSIGN(const std::string tree, read_file(features));
    const Json root = Json::parse(tree);
    if (root.find("featuresDict") == nullptr)
      return Failure{Fault::kIo, "is no tree of features", features};
    add_keys(root, "", keys_);
    return {};
  }

  // Of the shards one after the other, each with as many records as the split says.
  Result<std::optional<std::string>> next_record() {
    for (;;) {
      if (!reader_) {
        if (shard_ == lengths_.size()) return std::optional<std::string>();
        reader_.emplace(fmt::format("{}/{}-train.tfrecord-{:05}-of-{:05}", dir_, rlds::kName,
                                    shard_, lengths_.size()));
        in_shard_ = 0;
      }
      PROBE_ASSIGN(auto record, reader_->next());
      if (record) {
        ++in_shard_;
        bytes_ += record->size();
        return record;
      }
      expect(in_shard_ == lengths_[shard_], fmt::format("{} shard {}", dir_, shard_),
             fmt::format("has {} records, the split says {}", in_shard_, lengths_[shard_]));
      reader_.reset();
      ++shard_;
    }
  }

  Status episode(const NamedDemonstration& named, const std::string& wording) {
    const std::string where = fmt::format("episode {} ({})", findings_.report.episodes, named.name);
    if (named.trace.steps.empty()) return Failure{Fault::kTrace, "has no steps", where};
    PROBE_ASSIGN(const auto record, next_record());
    if (!record) return Failure{Fault::kIo, "the dataset ends before it", where};
    PROBE_ASSIGN(example_, read_example(*record, where));
    std::set<std::string> found;
    for (const auto& [key, feature] : example_) found.insert(key);
    if (found != keys_) return Failure{Fault::kIo, "has other keys than features.json", where};
    const std::size_t n = named.trace.steps.size(), joints = shape_.joints.size(),
                      actions = named.trace.steps.front().action.size();
    const struct {
      const char* key;
      std::size_t size;
    } rows[] = {{"steps/action", n * actions},
                {"steps/observation/state", n * kStateSize},
                {"steps/observation/joints", n * joints},
                {"steps/reward", n},
                {"steps/discount", n}};
    for (const auto& row : rows) {
      if (example_[row.key].reals.size() != row.size)
        return Failure{Fault::kIo,
                       fmt::format("{} has {} numbers, its trace {}", row.key,
                                   example_[row.key].reals.size(), row.size),
                       where};
    }
    for (const char* flags : {"steps/is_first", "steps/is_last", "steps/is_terminal"}) {
      if (example_[flags].wholes.size() != n)
        return Failure{Fault::kIo, std::string(flags) + " is not of every step", where};
    }
    check_steps(named, where);
    expect(example_["steps/language_instruction"].texts == std::vector<std::string>(n, wording),
           where, "language_instruction is not its wording");
    expect(one("episode_metadata/episode_id") == findings_.report.episodes, where,
           "episode_id does not count from 0");
    expect(one("episode_metadata/success") == (named.success ? 1 : 0), where,
           "success is not the verdict");
    return {};
  }

  std::int64_t one(const std::string& key) {
    const auto& wholes = example_[key].wholes;
    return wholes.size() == 1 ? wholes.front() : -1;
  }
  std::span<const double> row(const std::string& key, std::size_t i, std::size_t size) {
    return std::span(example_[key].reals).subspan(i * size, size);
  }

  void check_steps(const NamedDemonstration& named, const std::string& where) {
    const auto& steps = named.trace.steps;
    const std::size_t joints = shape_.joints.size();
    const auto pictures = picture_hashes(findings_, named, again_);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const std::string at = fmt::format("{} step {}", where, i);
      const bool is_first = i == 0, is_last = i + 1 == steps.size();
      const bool is_success = is_last && named.success;
      const auto& action = steps[i].action;
      check_action(row("steps/action", i, action.size()), {action.data(), action.size()}, at);
      expect(equal_singles(row("steps/observation/joints", i, joints),
                           joints_before(named.trace, i, joints)),
             at, "joints are not the trace's");
      expect_state(findings_, row("steps/observation/state", i, kStateSize), named.base,
                   sample_before(named.trace, i), at, "state");
      expect(example_["steps/reward"].reals[i] == (is_success ? 1 : 0), at,
             "reward is not the verdict");
      expect(example_["steps/discount"].reals[i] == 1, at, "discount is not 1");
      expect(example_["steps/is_first"].wholes[i] == (is_first ? 1 : 0), at,
             "is_first is not true in the first step alone");
      expect(example_["steps/is_last"].wholes[i] == (is_last ? 1 : 0), at,
             "is_last is not true in the last step alone");
      expect(example_["steps/is_terminal"].wholes[i] == (is_success ? 1 : 0), at,
             "is_terminal is not the verdict");
      check_pictures(pictures, i, at);
    }
  }

  // A robot that is told its joints has their numbers; else roll, pitch and yaw turn as far, and
  // about the axis, that the rotation vector says.
  void check_action(std::span<const double> stored, std::span<const double> wanted,
                    const std::string& at) {
    const auto turn = [](std::span<const double> numbers) {
      return Vec3{numbers[robot::kActionTurn], numbers[robot::kActionTurn + 1],
                  numbers[robot::kActionTurn + 2]};
    };
    const std::size_t gripper = wanted.size() - 1;
    const std::size_t same = shape_.law.empty() ? robot::kActionTurn : gripper;
    expect(equal_singles(stored.first(same), wanted.first(same)), at, "action is not the trace's");
    expect(std::abs(stored[gripper] - (wanted[gripper] + 1) / 2) < kNear, at,
           "the gripper's action is not the trace's");
    if (!shape_.law.empty()) return;
    const Quat made = robot::from_rpy(turn(stored));
    const Quat said = robot::from_rotation_vector(turn(wanted));
    expect(robot::pose_error({Vec3{}, made}, {Vec3{}, said}).rotation < kNear, at,
           "the turn of action is not the trace's");
  }

  void check_pictures(std::span<const Sha256> wanted, std::size_t i, const std::string& at) {
    std::vector<std::vector<std::uint8_t>> rgb;
    for (std::size_t camera = 0; camera < shape_.cameras.size(); ++camera) {
      const auto& files = example_[fmt::format("steps/observation/image_{}", camera)].texts;
      if (i >= files.size()) return expect(false, at, "has no picture");
      const auto picture = scene::decode_image(std::as_bytes(std::span(files[i])), at);
      if (!picture) return findings_.problem(to_text(picture.failure()));
      expect(picture->width == shape_.cameras[camera].width &&
                 picture->height == shape_.cameras[camera].height,
             at, "its picture has another size than the dataset's");
      std::vector<std::uint8_t> pixels;
      pixels.reserve(picture->rgba.size() / 4 * 3);
      for (std::size_t k = 0; k < picture->rgba.size(); ++k) {
        if (k % 4 != 3) pixels.push_back(picture->rgba[k]);
      }
      rgb.push_back(std::move(pixels));
    }
    const std::vector<std::span<const std::uint8_t>> all(rgb.begin(), rgb.end());
    expect_pictures(findings_, all, wanted, i, at);
  }

  std::string dir_;
  NamedRuns runs_;
  PicturesAgain* again_;
  Shape shape_;
  Findings findings_;
  std::set<std::string> keys_;
  std::vector<std::int64_t> lengths_;  // of the shards
  std::uint64_t bytes_ = 0, wanted_bytes_ = 0;
  std::optional<RecordReader> reader_;
  std::size_t shard_ = 0;
  std::int64_t in_shard_ = 0;
  Example example_;
};

}  // namespace

Result<CheckReport> check_rlds(const std::string& dir, NamedRuns runs, PicturesAgain* again) {
  return RldsCheck(dir, std::move(runs), again).check();
}

}  // namespace probe::dataset
