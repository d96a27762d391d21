// A robomimic file as it lies there, against what its traces make of it: a demonstration at a time,
// its pictures one by one.
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <set>

#include "runtime/base/json.h"
#include "runtime/export/dataset/findings.h"
#include "runtime/export/dataset/format_checks.h"
#include "runtime/export/dataset/robomimic.h"
#include "runtime/export/hdf5_handle.h"

namespace probe::dataset {
namespace {

using Id = exporting::Hdf5Handle;
using Sides = std::vector<hsize_t>;

Failure unreadable(const std::string& what, const std::string& where) {
  return {Fault::kIo, what + " cannot be read", where};
}

Sides sides_of(hid_t set) {
  const Id space(H5Dget_space(set), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  Sides sides(rank > 0 ? static_cast<std::size_t>(rank) : 0);
  if (rank > 0) H5Sget_simple_extent_dims(space, sides.data(), nullptr);
  return sides;
}

// Numbers of a dataset of exactly these sides.
template <typename T>
Result<std::vector<T>> numbers(hid_t parent, const char* called, hid_t type, const Sides& wanted,
                               const std::string& where) {
  const Id set(H5Dopen2(parent, called, H5P_DEFAULT), H5Dclose);
  if (set < 0) return unreadable(called, where);
  if (sides_of(set) != wanted)
    return Failure{Fault::kIo, std::string(called) + " has another shape than its trace", where};
  hsize_t count = 1;
  for (const hsize_t side : wanted) count *= side;
  std::vector<T> values(count);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    return unreadable(called, where);
  return values;
}

Result<std::int64_t> whole(hid_t parent, const char* called, const std::string& where) {
  const Id attribute(H5Aopen(parent, called, H5P_DEFAULT), H5Aclose);
  std::int64_t value = 0;
  if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0)
    return unreadable(called, where);
  return value;
}

Result<std::string> text(hid_t parent, const char* called, const std::string& where) {
  const Id attribute(H5Aopen(parent, called, H5P_DEFAULT), H5Aclose);
  const Id stored(attribute < 0 ? H5I_INVALID_HID : H5Aget_type(attribute), H5Tclose);
  if (stored < 0 || H5Tis_variable_str(stored) <= 0) return unreadable(called, where);
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5Tget_cset(stored));
  char* words = nullptr;
  if (H5Aread(attribute, type, &words) < 0 || words == nullptr) return unreadable(called, where);
  const Id space(H5Aget_space(attribute), H5Sclose);
  std::string copy = words;
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, &words);
  return copy;
}

// Names of a list of bytes of one length, padded with zeros; none where the list is not there.
std::vector<std::string> names(hid_t parent, const char* called) {
  std::vector<std::string> all;
  if (H5Lexists(parent, called, H5P_DEFAULT) <= 0) return all;
  const Id set(H5Dopen2(parent, called, H5P_DEFAULT), H5Dclose);
  const Id type(set < 0 ? H5I_INVALID_HID : H5Dget_type(set), H5Tclose);
  if (type < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return all;
  const Sides sides = sides_of(set);
  const std::size_t length = H5Tget_size(type);
  std::string bytes(sides.empty() ? 0 : sides[0] * length, '\0');
  if (bytes.empty() || H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
    return all;
  for (std::size_t i = 0; i < bytes.size(); i += length)
    all.emplace_back(bytes.substr(i, length).c_str());
  return all;
}

class RobomimicCheck {
 public:
  RobomimicCheck(std::string path, hid_t file, NamedRuns runs, PicturesAgain* again)
      : path_(std::move(path)),
        file_(file, H5Fclose),
        runs_(std::move(runs)),
        again_(again),
        shape_(runs_.shape()) {}

  Result<CheckReport> check() {
    const bool is_whole = each_episode(
        runs_, findings_,
        [&](const auto& named, const auto& wording, bool) { return episode(named, wording); });
    if (!is_whole) return findings_.report;
    const Id data(H5Gopen2(file_, "data", H5P_DEFAULT), H5Gclose);
    H5G_info_t held{};
    if (data < 0 || H5Gget_info(data, &held) < 0) return unreadable("data", path_);
    expect(static_cast<std::int64_t>(held.nlinks) == findings_.report.episodes, path_,
           fmt::format("data has {} demonstrations, the runs {}", held.nlinks,
                       findings_.report.episodes));
    PROBE_ASSIGN(const std::int64_t total, whole(data, "total", path_));
    expect(total == findings_.report.frames, path_, "total is not the number of all samples");
    PROBE_ASSIGN(const std::string env, text(data, "env_args", path_));
    const Json read = Json::parse(env);
    for (const char* key : {"env_name", "env_type", "env_kwargs"})
      expect(read.contains(key), path_, std::string("env_args has no ") + key);
    const Id mask(H5Gopen2(file_, "mask", H5P_DEFAULT), H5Gclose);
    if (mask < 0) return unreadable("mask", path_);
    expect(names(mask, "success") == successes_, path_, "mask/success is not what succeeded");
    expect(names(mask, "failure") == failures_, path_, "mask/failure is not what failed");
    std::set<std::string> train, all(successes_.begin(), successes_.end());
    all.insert(failures_.begin(), failures_.end());
    for (std::string& name : names(mask, "train")) train.insert(std::move(name));
    expect(train == all, path_, "mask/train is not all of them");
    return findings_.report;
  }

 private:
  void expect(bool is_so, const std::string& where, const std::string& what) {
    findings_.expect(is_so, where, what);
  }

  Status episode(const NamedDemonstration& named, const std::string& wording) {
    const std::string name = "demo_" + std::to_string(findings_.report.episodes);
    const std::string where = fmt::format("{} ({})", name, named.name);
    const Id demo(H5Gopen2(file_, ("data/" + name).c_str(), H5P_DEFAULT), H5Gclose);
    if (demo < 0) return Failure{Fault::kIo, "is not there", where};
    const Id obs(H5Gopen2(demo, "obs", H5P_DEFAULT), H5Gclose);
    if (obs < 0) return unreadable("obs", where);
    const auto& steps = named.trace.steps;
    const hsize_t n = steps.size(), joints = shape_.joints.size(),
                  width = steps.empty() ? 0 : steps.front().action.size();
    PROBE_ASSIGN(const auto samples, whole(demo, "num_samples", where));
    expect(samples == static_cast<std::int64_t>(n), where, "num_samples is not its trace's");
    PROBE_ASSIGN(const auto actions, reals(demo, "actions", {n, width}, where));
    PROBE_ASSIGN(const auto rewards, reals(demo, "rewards", {n}, where));
    PROBE_ASSIGN(const auto states, reals(demo, "states", {n, joints}, where));
    PROBE_ASSIGN(const auto place, reals(obs, "state", {n, kStateSize}, where));
    PROBE_ASSIGN(const auto turned, reals(obs, "joints", {n, joints}, where));
    PROBE_ASSIGN(const auto dones,
                 numbers<std::int64_t>(demo, "dones", H5T_NATIVE_INT64, {n}, where));
    const auto row = [](const std::vector<double>& of, std::size_t i, std::size_t size) {
      return std::span(of).subspan(i * size, size);
    };
    for (std::size_t i = 0; i < n; ++i) {
      const std::string at = fmt::format("{} step {}", where, i);
      const bool is_last = i + 1 == n;
      const auto q = joints_before(named.trace, i, joints);
      expect(std::ranges::equal(row(actions, i, width), steps[i].action), at,
             "actions is not the trace's");
      expect(std::ranges::equal(row(turned, i, joints), q), at, "obs/joints are not the trace's");
      expect(std::ranges::equal(row(states, i, joints), q), at, "states are not the trace's");
      expect_state(findings_, row(place, i, kStateSize), named.base, sample_before(named.trace, i),
                   at, "obs/state");
      expect(rewards[i] == (is_last && named.success ? 1 : 0), at, "rewards is not the verdict");
      expect(dones[i] == (is_last ? 1 : 0), at, "dones is not 1 in the last step alone");
    }
    PROBE_TRY(pictures(obs, named, where));
    PROBE_ASSIGN(const std::string words, text(demo, "ep_meta", where));
    const Json meta = Json::parse(words);
    expect(meta.value("lang", "") == wording, where, "lang of ep_meta is not its wording");
    const Json* success = meta.find("success");
    expect(success != nullptr && success->is_boolean() && success->get<bool>() == named.success,
           where, "success of ep_meta is not the verdict");
    (named.success ? successes_ : failures_).push_back(name);
    return {};
  }

  static Result<std::vector<double>> reals(hid_t parent, const char* called, const Sides& sides,
                                           const std::string& where) {
    return numbers<double>(parent, called, H5T_NATIVE_DOUBLE, sides, where);
  }

  // Of every camera, frame by frame.
  Status pictures(hid_t obs, const NamedDemonstration& named, const std::string& where) {
    const hsize_t n = named.trace.steps.size();
    std::vector<std::unique_ptr<Id>> sets;
    for (const CameraShape& camera : shape_.cameras) {
      sets.push_back(
          std::make_unique<Id>(H5Dopen2(obs, camera.name.c_str(), H5P_DEFAULT), H5Dclose));
      if (*sets.back() < 0) return unreadable("obs/" + camera.name, where);
      const Sides sides = {n, static_cast<hsize_t>(camera.height),
                           static_cast<hsize_t>(camera.width), 3};
      if (sides_of(*sets.back()) != sides)
        return Failure{Fault::kIo, "obs/" + camera.name + " has another shape than the dataset's",
                       where};
    }
    const auto wanted = picture_hashes(findings_, named, again_);
    for (hsize_t i = 0; i < n; ++i) {
      std::vector<std::vector<std::uint8_t>> rgb;
      for (std::size_t camera = 0; camera < sets.size(); ++camera) {
        const hsize_t from[] = {i, 0, 0, 0};
        const hsize_t count[] = {1, static_cast<hsize_t>(shape_.cameras[camera].height),
                                 static_cast<hsize_t>(shape_.cameras[camera].width), 3};
        const Id space(H5Dget_space(*sets[camera]), H5Sclose);
        const Id memory(H5Screate_simple(4, count, nullptr), H5Sclose);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, from, nullptr, count, nullptr);
        rgb.emplace_back(count[1] * count[2] * 3);
        if (H5Dread(*sets[camera], H5T_NATIVE_UINT8, memory, space, H5P_DEFAULT,
                    rgb.back().data()) < 0)
          return unreadable(fmt::format("picture {} of obs/{}", i, shape_.cameras[camera].name),
                            where);
      }
      expect_pictures(findings_, rgb, wanted, i, fmt::format("{} step {}", where, i));
    }
    return {};
  }

  std::string path_;
  Id file_;
  NamedRuns runs_;
  PicturesAgain* again_;
  Shape shape_;
  Findings findings_;
  std::vector<std::string> successes_, failures_;
};

}  // namespace

Result<CheckReport> check_robomimic(const std::string& dir, NamedRuns runs, PicturesAgain* again) {
  // Failures are told by us, not by the library's own printing.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::string path = dir + "/" + robomimic::kFile;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) {
    CheckReport report;
    report.problems.push_back(path + ": is no HDF5 file that can be read");
    return report;
  }
  return RobomimicCheck(path, file, std::move(runs), again).check();
}

}  // namespace probe::dataset
