// What lies in a robomimic file. HDF5 crashes on some damaged ones, so it reads each part in a
// process of its own (runtime/base/apart.h), and this one has only what that wrote. Knows nothing
// of runs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/apart.h"
#include "runtime/base/result.h"
#include "runtime/export/dataset/demonstration.h"

namespace probe::dataset {

// What it says of itself; lists that are not there are empty.
struct RobomimicHead {
  std::uint64_t demonstrations = 0;
  std::int64_t total = 0;
  std::string env_args;
  bool has_mask = false;
  std::vector<std::string> success, failure, train;
};

// The shape that a demonstration has to have.
struct RobomimicSides {
  std::size_t steps = 0, joints = 0, action = 0;
};

// One demonstration without its pictures: rows of `action` numbers, `joints`, kStateSize.
struct RobomimicDemo {
  std::int64_t samples = 0;
  std::vector<double> actions, rewards, states, state, joints;
  std::vector<std::int64_t> dones;
  std::string meta;
};

// The pictures of some steps.
class RobomimicPictures {
 public:
  // `bytes` of a step's cameras one after the other, then the next step's; `sizes` of each camera.
  RobomimicPictures(Answer bytes, std::size_t steps, std::vector<std::size_t> sizes)
      : bytes_(std::move(bytes)), steps_(steps), sizes_(std::move(sizes)) {}
  std::size_t steps() const { return steps_; }
  // Of the i-th of these steps, one a camera.
  std::vector<std::span<const std::uint8_t>> step(std::size_t i) const;

 private:
  Answer bytes_;
  std::size_t steps_;
  std::vector<std::size_t> sizes_;
};

// All fail (kIo) with `where`, where something is missing, has another shape, or ends its reader:
// "makes its reader crash (SIGSEGV)".
class RobomimicFile {
 public:
  explicit RobomimicFile(std::string path) : path_(std::move(path)) {}

  // Whether it is HDF5 at all.
  Status open() const;
  Result<RobomimicHead> head() const;
  // `name` as "demo_0".
  Result<RobomimicDemo> demo(const std::string& name, const RobomimicSides& sides,
                             const std::string& where) const;
  // From step `first` on, as many as one process reads; of `steps` that the demonstration has.
  Result<RobomimicPictures> pictures(const std::string& name, std::span<const CameraShape> cameras,
                                     std::size_t steps, std::size_t first,
                                     const std::string& where) const;

 private:
  std::string path_;
};

}  // namespace probe::dataset
