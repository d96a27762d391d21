#include "runtime/libero/states.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/large.h"
#include "runtime/libero/zip.h"
#include "runtime/wire/pickle_arrays.h"

namespace probe::libero {
namespace {

// The largest that were released have 60 KB; a hundred times as many starts are read, too.
constexpr std::size_t kMostBytes = std::size_t{16} << 20;
constexpr std::size_t kMostStarts = 10'000;
constexpr std::size_t kArm = 7, kFingers = 2;
constexpr std::size_t kPose = 7, kTwist = 6;  // numbers of a free joint's position and velocity
constexpr double kUnitWithin = 1e-6;

struct StateRows {
  std::size_t count = 0, width = 0;
  std::vector<double> values;  // row by row
};

Result<StateRows> read_rows(const std::string& path) {
  const auto wrong = [&](std::string what) {
    return Failure{Fault::kUsage, std::move(what), path};
  };
  PROBE_ASSIGN(const std::string file,
               read_file(path, {.most = kMostBytes, .code = Fault::kUsage, .only_begin = false}));
  const std::span<const std::uint8_t> archive(reinterpret_cast<const std::uint8_t*>(file.data()),
                                              file.size());
  PROBE_ASSIGN(const std::string bytes, read_zip_member(archive, "/data.pkl", kMostBytes, path));
  const std::span<const std::uint8_t> raw(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                          bytes.size());
  const auto pickle = wire::read_pickle(raw, wire::array_globals());
  if (!pickle) return wrong(pickle.failure().message);
  const auto array = wire::read_array(*pickle, pickle->top(), allowed(kMostBytes));
  if (!array) return wrong(array.failure().message);
  if (array->dtype != "<f8" || array->shape.size() != 2) {
    return wrong(fmt::format("expected rows of float64, found {} dimension{} of `{}`",
                             array->shape.size(), array->shape.size() == 1 ? "" : "s",
                             array->dtype));
  }
  StateRows rows;
  rows.count = static_cast<std::size_t>(array->shape[0]);
  rows.width = static_cast<std::size_t>(array->shape[1]);
  if (rows.count == 0 || rows.count > kMostStarts)
    return wrong(fmt::format("expected 1 to {} starts, found {}", kMostStarts, rows.count));
  rows.values.resize(rows.count * rows.width);
  std::memcpy(rows.values.data(), array->bytes.data(), array->bytes.size());
  return rows;
}

}  // namespace

Result<StartStates> read_states(const std::string& path, const BddlProblem& problem,
                                const JointsOf& joints_of) {
  const auto wrong = [&](std::string what) {
    return Failure{Fault::kUsage, std::move(what), path};
  };
  PROBE_ASSIGN(const StateRows rows, read_rows(path));
  StartStates states;
  for (const BddlThing& fixture : problem.fixtures) {
    const auto joints = joints_of.find(fixture.category);
    if (joints == joints_of.end()) continue;
    for (const std::string& joint : joints->second)
      states.joint_names.emplace_back(fixture.name, joint);
  }
  const std::size_t objects = problem.objects.size(), joints = states.joint_names.size();
  const std::size_t positions = kArm + kFingers + kPose * objects + joints;
  const std::size_t velocities = kArm + kFingers + kTwist * objects + joints;
  if (rows.width != 1 + positions + velocities) {
    return wrong(fmt::format(
        "a start has {} numbers, that of a problem with {} objects and {} joints of fixtures {}",
        rows.width, objects, joints, 1 + positions + velocities));
  }
  for (std::size_t i = 0; i < rows.count; ++i) {
    const std::span<const double> row(rows.values.data() + i * rows.width, rows.width);
    // Metres and radians: nothing of a room is farther.
    constexpr double kFarthest = 1000;
    if (!std::ranges::all_of(row, [](double value) { return std::abs(value) <= kFarthest; }))
      return wrong(
          fmt::format("start {} has a number that is not finite, or beyond {}", i, kFarthest));
    StartState start;
    start.time = row[0];
    auto at = row.begin() + 1;
    const auto take = [&](auto& numbers) {
      std::copy_n(at, numbers.size(), numbers.begin());
      at += static_cast<std::ptrdiff_t>(numbers.size());
    };
    take(start.arm);
    take(start.fingers);
    for (const BddlThing& object : problem.objects) {
      StatePose pose;
      take(pose.position);
      take(pose.rotation);
      double squares = 0;
      for (const double value : pose.rotation) squares += value * value;
      if (!(std::abs(std::sqrt(squares) - 1) <= kUnitWithin)) {
        return wrong(fmt::format("start {}: the quaternion of `{}` has length {:g}, not 1", i,
                                 object.name, std::sqrt(squares)));
      }
      start.objects.push_back(pose);
    }
    start.joints.resize(joints);
    take(start.joints);
    for (; at != row.end(); ++at) start.fastest = std::max(start.fastest, std::abs(*at));
    states.starts.push_back(std::move(start));
  }
  return states;
}

}  // namespace probe::libero
