// Threads deflate the pictures, each a chunk of its own; HDF5, which is one thread's at a time,
// gets them as they are.
#include "runtime/export/dataset/robomimic.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/base/json.h"
#include "runtime/export/dataset/packed_film.h"
#include "runtime/export/hdf5_file.h"
#include "runtime/export/hdf5_handle.h"
#include "runtime/store/episode_key.h"

namespace probe::dataset::robomimic {
namespace {

// Pictures of a simulator shrink to a fifth at the least effort, and hardly further at more.
constexpr int kEffort = 1;
// robomimic's EnvType of a gym environment; its own programs make none of ours.
constexpr int kGymType = 2;

using Id = exporting::Hdf5Handle;
using Sides = std::vector<hsize_t>;

class Deflater final : public FilmMaker {
 public:
  explicit Deflater(std::size_t cameras) : film_(std::make_unique<PackedFilm>()) {
    film_->cameras.resize(cameras);
  }
  Status add(std::span<const Picture> pictures) override {
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const auto rgb = pictures[i].rgb;
      uLongf size = compressBound(rgb.size());
      std::string bytes(size, '\0');
      if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &size, rgb.data(), rgb.size(),
                    kEffort) != Z_OK)
        return Failure{Fault::kInternal, "a picture cannot be deflated", pictures[i].camera->name};
      bytes.resize(size);
      bytes.shrink_to_fit();
      film_->cameras[i].push_back(std::move(bytes));
    }
    return {};
  }
  Result<std::unique_ptr<Film>> finish() override {
    return std::unique_ptr<Film>(std::move(film_));
  }

 private:
  std::unique_ptr<PackedFilm> film_;
};

class RobomimicLayout final : public Layout {
 public:
  RobomimicLayout(exporting::Hdf5File file, Shape shape)
      : file_(std::move(file)), shape_(std::move(shape)) {
    const Id data = group(file_, "data");
    const Id mask = group(file_, "mask");
  }

  Result<std::unique_ptr<FilmMaker>> film(std::size_t) const override {
    return std::unique_ptr<FilmMaker>(std::make_unique<Deflater>(shape_.cameras.size()));
  }

  std::unique_ptr<Film> film_of(ByteReader& bytes) const override {
    return PackedFilm::read(bytes, shape_.cameras.size());
  }

  std::optional<std::string> refusal(const Demonstration& demonstration) const override {
    for (std::size_t i = 0; i < demonstration.steps.size(); ++i) {
      for (const double number : demonstration.steps[i].action) {
        if (std::abs(number) <= 1) continue;
        return fmt::format("step {} has an action beyond -1 .. 1, which robomimic refuses", i);
      }
    }
    return std::nullopt;
  }

  // The first wording's group has the numbers and pictures; those of the others are the same.
  Status add(const Demonstration& demonstration, std::unique_ptr<Film> film) override {
    const auto& pictures = static_cast<const PackedFilm&>(*film);
    const std::string first = "/data/" + name(contents_.episodes);
    for (const std::string& wording : demonstration.wordings) {
      const std::string path = "/data/" + name(contents_.episodes);
      const Id demo = group(file_, path);
      attributes(demo, demonstration, wording);
      if (path == first) {
        numbers(demo, demonstration);
        const Id obs = group(demo, "obs");
        observations(obs, demonstration, pictures);
      } else {
        for (const char* shared : {"actions", "rewards", "dones", "states", "obs"})
          keep(H5Lcreate_hard(file_, (first + "/" + shared).c_str(), demo, shared, H5P_DEFAULT,
                              H5P_DEFAULT));
      }
      PROBE_TRY(file_.status(ok_));
      (demonstration.success ? successes_ : failures_).push_back(name(contents_.episodes));
      ++contents_.episodes;
      contents_.frames += static_cast<std::int64_t>(demonstration.steps.size());
    }
    ++contents_.demonstrations;
    return file_.flush(ok_);  // so that nothing is kept in memory
  }

  Result<Contents> finish() override {
    {
      const Id data(H5Gopen2(file_, "data", H5P_DEFAULT), H5Gclose);
      whole(data, "total", contents_.frames);
      Json env;
      env["env_name"] = "vlaprobe";
      env["env_type"] = env["type"] = kGymType;
      env["env_kwargs"] = Json::object();
      text(data, "env_args", env.dump());
      const Id mask(H5Gopen2(file_, "mask", H5P_DEFAULT), H5Gclose);
      std::vector<std::string> all = successes_;
      all.insert(all.end(), failures_.begin(), failures_.end());
      std::ranges::sort(all, {}, [](const std::string& demo) {
        return std::pair(demo.size(), demo);  // demo_2 before demo_10
      });
      names(mask, "train", all);
      names(mask, "success", successes_);
      names(mask, "failure", failures_);
    }
    PROBE_TRY(file_.close(ok_));
    contents_.readme =
        "robomimic's HDF5, `" + std::string(kFile) +
        "`: a group `data/demo_K` for each episode, its words in the attribute `ep_meta` (`lang`); "
        "`obs/CAMERA` are the pictures, uint8, lossless; `obs/state` is the tool centre point in "
        "the robot's base frame (x, y, z in m, roll, pitch, yaw in rad) and the gripper, 0 closed "
        "to 1 open; `obs/joints` rad and m; `actions` the " +
        action_meaning(shape_) +
        ". `mask/success` and `mask/failure` "
        "divide `mask/train`. There is no `next_obs` (`hdf5_load_next_obs: false`). Groups of one "
        "demonstration in several wordings share their datasets.\n";
    return contents_;
  }

 private:
  static std::string name(std::int64_t number) { return "demo_" + std::to_string(number); }
  void keep(herr_t code) { ok_ = ok_ && code >= 0; }

  Id group(hid_t parent, const std::string& path) {
    const Id properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties, false);  // equal runs make equal files
    const hid_t id = H5Gcreate2(parent, path.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT);
    ok_ = ok_ && id >= 0;
    return {id, H5Gclose};
  }

  void attributes(hid_t demo, const Demonstration& demonstration, const std::string& wording) {
    whole(demo, "num_samples", static_cast<std::int64_t>(demonstration.steps.size()));
    Json meta;
    meta["lang"] = wording;
    meta["instruction"] = demonstration.prompt;
    meta["task"] = demonstration.row.task;
    meta["episode"] = demonstration.row.episode;
    meta["seed"] = demonstration.row.seed;
    meta["success"] = demonstration.success;
    text(demo, "ep_meta", meta.dump());
  }

  void numbers(hid_t demo, const Demonstration& demonstration) {
    const hsize_t n = demonstration.steps.size();
    std::vector<double> actions, rewards(n, 0.0), states;
    std::vector<std::int64_t> dones(n, 0);
    for (const Step& step : demonstration.steps) {
      actions.insert(actions.end(), step.action.begin(), step.action.end());
      states.insert(states.end(), step.joints.begin(), step.joints.end());
    }
    rewards.back() = demonstration.success ? 1 : 0;
    dones.back() = 1;
    reals(demo, "actions", actions, {n, shape_.action_size});
    reals(demo, "rewards", rewards, {n});
    dataset(demo, "dones", H5T_STD_I64LE, H5T_NATIVE_INT64, dones.data(), {n});
    reals(demo, "states", states, {n, shape_.joints.size()});
  }

  void observations(hid_t obs, const Demonstration& demonstration, const PackedFilm& film) {
    const hsize_t n = demonstration.steps.size();
    std::vector<double> state, joints;
    for (const Step& step : demonstration.steps) {
      state.insert(state.end(), step.state.begin(), step.state.end());
      joints.insert(joints.end(), step.joints.begin(), step.joints.end());
    }
    reals(obs, "state", state, {n, kStateSize});
    reals(obs, "joints", joints, {n, shape_.joints.size()});
    for (std::size_t i = 0; i < shape_.cameras.size(); ++i)
      pictures(obs, shape_.cameras[i], film.cameras[i]);
  }

  void pictures(hid_t obs, const CameraShape& camera, const std::vector<std::string>& frames) {
    const Sides sides = {frames.size(), static_cast<hsize_t>(camera.height),
                         static_cast<hsize_t>(camera.width), 3};
    const Sides chunk = {1, sides[1], sides[2], 3};
    const Id space(H5Screate_simple(4, sides.data(), nullptr), H5Sclose);
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties, false);
    H5Pset_chunk(properties, 4, chunk.data());
    H5Pset_deflate(properties, kEffort);
    const Id set(H5Dcreate2(obs, camera.name.c_str(), H5T_STD_U8LE, space, H5P_DEFAULT, properties,
                            H5P_DEFAULT),
                 H5Dclose);
    ok_ = ok_ && set >= 0;
    for (std::size_t i = 0; i < frames.size() && ok_; ++i) {
      const hsize_t at[] = {i, 0, 0, 0};
      keep(H5Dwrite_chunk(set, H5P_DEFAULT, 0, at, frames[i].size(), frames[i].data()));
    }
  }

  void reals(hid_t parent, const char* called, const std::vector<double>& values,
             const Sides& sides) {
    dataset(parent, called, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), sides);
  }
  void dataset(hid_t parent, const char* called, hid_t stored, hid_t given, const void* values,
               const Sides& sides) {
    if (!ok_) return;
    const Id space(H5Screate_simple(static_cast<int>(sides.size()), sides.data(), nullptr),
                   H5Sclose);
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties, false);
    const Id set(H5Dcreate2(parent, called, stored, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                 H5Dclose);
    ok_ = set >= 0;
    if (ok_) keep(H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  }
  // Bytes of one length, which h5py gives as bytes; of none there is no list.
  void names(hid_t parent, const char* called, const std::vector<std::string>& values) {
    if (values.empty()) return;
    std::size_t longest = 0;
    for (const std::string& value : values) longest = std::max(longest, value.size());
    std::string bytes;
    for (const std::string& value : values)
      bytes += value + std::string(longest - value.size(), '\0');
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, longest);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    dataset(parent, called, type, type, bytes.data(), {values.size()});
  }
  void whole(hid_t parent, const char* called, std::int64_t value) {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    const Id attribute(H5Acreate2(parent, called, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
    ok_ = ok_ && attribute >= 0;
    if (ok_) keep(H5Awrite(attribute, H5T_NATIVE_INT64, &value));
  }
  void text(hid_t parent, const char* called, const std::string& value) {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const Id attribute(H5Acreate2(parent, called, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    ok_ = ok_ && attribute >= 0;
    const char* pointer = value.c_str();
    if (ok_) keep(H5Awrite(attribute, type, &pointer));
  }

  exporting::Hdf5File file_;
  Shape shape_;
  std::vector<std::string> successes_, failures_;
  Contents contents_;
  bool ok_ = true;
};

}  // namespace

Result<std::unique_ptr<Layout>> open_layout(const std::string& dir, const Shape& shape) {
  PROBE_ASSIGN(auto file, exporting::Hdf5File::create(dir + "/" + kFile));
  return std::unique_ptr<Layout>(std::make_unique<RobomimicLayout>(std::move(file), shape));
}

}  // namespace probe::dataset::robomimic
