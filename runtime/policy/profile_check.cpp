// Fields of a profile that do not go together.
#include "runtime/policy/profile.h"

namespace probe::policy {
namespace {

Failure bad(std::string message) { return {"usage", std::move(message), ""}; }

Status check_statistics(const Statistics& statistics, const std::string& prefix, std::size_t size) {
  const auto check_size = [&](const std::vector<double>& numbers, const char* name) -> Status {
    if (numbers.empty() || size == 0 || numbers.size() == size) return {};
    return bad("`" + prefix + name + "` has " + std::to_string(numbers.size()) +
               " numbers, there are " + std::to_string(size));
  };
  PROBE_TRY(check_size(statistics.low, "low"));
  PROBE_TRY(check_size(statistics.high, "high"));
  PROBE_TRY(check_size(statistics.mean, "mean"));
  PROBE_TRY(check_size(statistics.std, "std"));
  PROBE_TRY(check_size(statistics.mask, "mask"));
  if (statistics.kind == Normalisation::kBound) {
    if (statistics.low.empty() || statistics.high.size() != statistics.low.size()) {
      return bad("bound needs `" + prefix + "low` and `" + prefix + "high`, as many of each");
    }
    for (std::size_t i = 0; i < statistics.low.size(); ++i) {
      if (statistics.low[i] < statistics.high[i]) continue;
      if (i < statistics.mask.size() && statistics.mask[i] == 0) continue;
      return bad("number " + std::to_string(i + 1) + " of `" + prefix +
                 "low` is not below that of `" + prefix + "high`");
    }
  }
  if (statistics.kind == Normalisation::kGaussian) {
    if (statistics.mean.empty() || statistics.std.size() != statistics.mean.size()) {
      return bad("gaussian needs `" + prefix + "mean` and `" + prefix + "std`, as many of each");
    }
    for (const double value : statistics.std) {
      if (value <= 0) return bad("a number of `" + prefix + "std` is not above 0");
    }
  }
  return {};
}

std::size_t size_of(StateLayout layout) {
  switch (layout) {
    case StateLayout::kXyzWxyzOpenness:
    case StateLayout::kXyzRpyPadOpenness:
    case StateLayout::kXyzRotvecFingers:
      return 8;
    case StateLayout::kXyzRpyOpenness:
    case StateLayout::kXyzRotvecOpenness:
      return 7;
    case StateLayout::kNone:
    case StateLayout::kJoints:
    case StateLayout::kJointsOpenness:
      break;
  }
  return 0;  // depends on the robot
}

}  // namespace

Status check_profile(const Profile& profile) {
  constexpr std::size_t kActionSize = 7;
  PROBE_TRY(check_statistics(profile.action_statistics, "action.", kActionSize));
  PROBE_TRY(check_statistics(profile.state_statistics, "state.", size_of(profile.state_layout)));
  if (profile.ensemble == Ensemble::kTemporal && profile.chunk_use > 1) {
    return bad("`ensemble = temporal` asks at every step; `chunk.use` is then 1 or absent");
  }
  if (profile.chunk_length > 0 && profile.chunk_use > profile.chunk_length) {
    return bad("`chunk.use` is more than `chunk.length`");
  }
  if (profile.images.empty()) return bad("a profile has at least one line `image = ...`");
  return {};
}

}  // namespace probe::policy
