// Fields of a profile that do not go together.
#include "runtime/servers/profile_check.h"

#include <algorithm>

#include "runtime/robot/action.h"
#include "runtime/servers/protocol.h"

namespace probe::servers {
namespace {

using MaybeMistake = std::optional<Mistake>;

MaybeMistake check_bound(const Statistics& statistics, const std::string& kind,
                         const std::string& prefix) {
  const std::string low = prefix + "low", high = prefix + "high";
  if (statistics.low.empty() || statistics.high.size() != statistics.low.size()) {
    return Mistake{"bound needs `" + low + "` and `" + high + "`, as many of each",
                   {kind, low, high}};
  }
  for (std::size_t i = 0; i < statistics.low.size(); ++i) {
    if (statistics.low[i] < statistics.high[i]) continue;
    if (i < statistics.mask.size() && statistics.mask[i] == 0) continue;
    return Mistake{
        "number " + std::to_string(i + 1) + " of `" + low + "` is not below that of `" + high + "`",
        {low, high}};
  }
  return std::nullopt;
}

MaybeMistake check_gaussian(const Statistics& statistics, const std::string& kind,
                            const std::string& prefix) {
  const std::string mean = prefix + "mean", std = prefix + "std";
  if (statistics.mean.empty() || statistics.std.size() != statistics.mean.size()) {
    return Mistake{"gaussian needs `" + mean + "` and `" + std + "`, as many of each",
                   {kind, mean, std}};
  }
  for (const double value : statistics.std) {
    if (value <= 0) return Mistake{"a number of `" + std + "` is not above 0", {std}};
  }
  return std::nullopt;
}

// `kind` is the field that says how; `size` 0 is any.
MaybeMistake check_statistics(const Statistics& statistics, const std::string& kind,
                              const std::string& prefix, std::size_t size) {
  const std::pair<const char*, const std::vector<double>*> lists[] = {{"low", &statistics.low},
                                                                      {"high", &statistics.high},
                                                                      {"mean", &statistics.mean},
                                                                      {"std", &statistics.std},
                                                                      {"mask", &statistics.mask}};
  for (const auto& [name, numbers] : lists) {
    if (numbers->empty() || size == 0 || numbers->size() == size) continue;
    return Mistake{"`" + prefix + name + "` has " + std::to_string(numbers->size()) +
                       " numbers, there are " + std::to_string(size),
                   {prefix + name}};
  }
  const std::string mask = prefix + "mask";
  for (std::size_t i = 0; i < statistics.mask.size(); ++i) {
    if (statistics.mask[i] == 0 || statistics.mask[i] == 1) continue;
    return Mistake{"number " + std::to_string(i + 1) + " of `" + mask + "` is neither 0 nor 1",
                   {mask}};
  }
  if (statistics.kind == Normalisation::kNone) return std::nullopt;
  if (!statistics.mask.empty() && std::ranges::count(statistics.mask, 1.0) == 0) {
    return Mistake{"`" + kind + "` normalises nothing: `" + mask + "` is 0 everywhere",
                   {kind, mask}};
  }
  return statistics.kind == Normalisation::kBound ? check_bound(statistics, kind, prefix)
                                                  : check_gaussian(statistics, kind, prefix);
}

std::size_t size_of(StateLayout layout) {
  switch (layout) {
    case StateLayout::kXyzWxyzOpenness:
    case StateLayout::kXyzRpyPadOpenness:
    case StateLayout::kXyzXyzwClosedness:
    case StateLayout::kXyzRotvecFingers:
    case StateLayout::kLibero:
      return 8;
    case StateLayout::kXyzRpyOpenness:
    case StateLayout::kXyzRotvecOpenness:
      return 7;
    case StateLayout::kFingers:
      return 2;
    case StateLayout::kOpenness:
    case StateLayout::kClosedness:
      return 1;
    case StateLayout::kNone:
    case StateLayout::kJoints:
    case StateLayout::kJointsOpenness:
    case StateLayout::kArmJoints:
      break;
  }
  return 0;  // depends on the robot
}

// What numbers 1 to 6 of an action mean, and the last.
MaybeMistake check_meaning(const Profile& profile) {
  if (profile.action_sticky != StickyRule::kNone && is_step(profile.action_gripper)) {
    return Mistake{"`action.sticky` makes steps of openings, and `action.gripper` says that they are steps",
                   {"action.sticky", "action.gripper"}};
  }
  if (profile.action_sticky != StickyRule::kNone && profile.action_threshold) {
    return Mistake{"`action.sticky` takes openings as they are, and `action.threshold` makes two of them",
                   {"action.sticky", "action.threshold"}};
  }
  const bool is_scaled =
      profile.action_units == ActionUnits::kBox || profile.action_units == ActionUnits::kBall;
  const bool are_joints = names_joints(profile.action_form);
  if (are_joints && !row_of(profile.protocol).has_joint_actions) {
    return Mistake{"servers that speak " + std::string(to_word(profile.protocol)) +
                       " are not known to answer with joints",
                   {"action.form"}};
  }
  if (are_joints && profile.action_units == ActionUnits::kBall) {
    return Mistake{"`action.units = ball` is of shifts and turns, not of joints",
                   {"action.form", "action.units"}};
  }
  if (is_scaled && profile.action_statistics.kind != Normalisation::kNone) {
    return Mistake{"`action.units` says what 1 stands for, and so does `action.normalised`",
                   {"action.units", "action.normalised"}};
  }
  if (is_scaled && profile.action_form == ActionForm::kAbsolute) {
    return Mistake{"`action.form = absolute` is a pose in m and rad, which has no scale",
                   {"action.form", "action.units"}};
  }
  if (is_scaled && profile.action_form == ActionForm::kJoints) {
    return Mistake{"`action.form = joints` is positions in rad, which have no scale",
                   {"action.form", "action.units"}};
  }
  if (!is_scaled && (profile.action_scale_m != 1 || profile.action_scale_rad != 1)) {
    return Mistake{"`action.scale_m` and `action.scale_rad` go with `action.units` box or ball",
                   {"action.scale_m", "action.scale_rad"}};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Mistake> find_mistake(const Profile& profile) {
  // 0: as many as the robot has joints.
  const std::size_t size = names_joints(profile.action_form) ? 0 : robot::kActionSize;
  if (auto mistake =
          check_statistics(profile.action_statistics, "action.normalised", "action.", size)) {
    return mistake;
  }
  if (profile.state_layout == StateLayout::kNone &&
      profile.state_statistics.kind != Normalisation::kNone) {
    return Mistake{"`state.normalise` normalises nothing: `state.layout = none` sends no state",
                   {"state.normalise", "state.layout"}};
  }
  if (auto mistake = check_statistics(profile.state_statistics, "state.normalise", "state.",
                                      size_of(profile.state_layout))) {
    return mistake;
  }
  if (auto mistake = check_meaning(profile)) return mistake;
  if (!profile.more_states.empty() && profile.protocol != Protocol::kOpenpi) {
    return Mistake{"`state.more` is for openpi's servers alone", {"state.more 1"}};
  }
  if (profile.ensemble == Ensemble::kTemporal && profile.chunk_use > 1) {
    return Mistake{"`ensemble = temporal` asks at every step; `chunk.use` is then 1 or absent",
                   {"ensemble", "chunk.use"}};
  }
  if (profile.chunk_length > 0 && profile.chunk_use > profile.chunk_length) {
    return Mistake{"`chunk.use` is more than `chunk.length`", {"chunk.use", "chunk.length"}};
  }
  if (profile.images.empty()) {
    return Mistake{"a profile has at least one line `image = ...`", {}};
  }
  return find_key_conflict(profile);
}

Status check_profile(const Profile& profile) {
  if (auto mistake = find_mistake(profile)) return Failure{Fault::kUsage, mistake->message, ""};
  return {};
}

}  // namespace probe::servers
