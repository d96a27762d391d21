// What answers show of a server's conventions. Numbers that decide are of BridgeData V2 at 5 Hz:
// its first and 99th percentiles lie within 4 cm and 0.25 rad a step.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "runtime/robot/rotation.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/conversion.h"
#include "runtime/servers/known_observations.h"

namespace probe::servers {
namespace {

constexpr double kUsualShift = 0.15;  // m a step; three times the largest that policies do
constexpr double kUsualTurn = 1.0;    // rad a step
constexpr double kPi = std::numbers::pi;
constexpr int kLongChunk = 16;  // 3 s at 5 Hz

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

struct Range {
  double low = 0, high = 0;
};

// Of some of an action's numbers over all actions.
Range range_of(const std::vector<RawAction>& actions, std::size_t first, std::size_t count) {
  Range range{actions[0][first], actions[0][first]};
  for (const RawAction& action : actions) {
    for (std::size_t i = first; i < first + count; ++i) {
      range.low = std::min(range.low, action[i]);
      range.high = std::max(range.high, action[i]);
    }
  }
  return range;
}

std::string text_of(const Range& range) {
  return short_number(range.low) + " .. " + short_number(range.high);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Check judge_chunks(const Profile& profile, const std::vector<std::vector<RawAction>>& chunks) {
  std::set<std::size_t> lengths;
  for (const auto& chunk : chunks) lengths.insert(chunk.size());
  const auto least = static_cast<int>(*lengths.begin());
  std::string found = "answers hold " + std::to_string(least);
  if (lengths.size() > 1) found += " to " + std::to_string(*lengths.rbegin());
  found += least == 1 && lengths.size() == 1 ? " action" : " actions";
  Check check{"chunk", Verdict::kFine, found, {}};
  if (profile.chunk_length > 0 && (lengths.size() > 1 || least != profile.chunk_length)) {
    check.verdict = Verdict::kWrong;
    check.found += ", the profile expects " + std::to_string(profile.chunk_length);
    check.fix = {lengths.size() > 1 ? "chunk.length = any"
                                    : "chunk.length = " + std::to_string(least)};
  } else if (least < profile.chunk_use) {
    check.verdict = Verdict::kWrong;
    check.found += ", the profile uses " + std::to_string(profile.chunk_use);
    check.fix = {"chunk.use = " + std::to_string(least)};
  } else if (profile.ensemble == Ensemble::kTemporal && *lengths.rbegin() == 1) {
    check.verdict = Verdict::kWarning;
    check.found += ", so `ensemble = temporal` has nothing to blend";
    check.fix = {"ensemble = none"};
  } else if (profile.chunk_use == 0 && profile.ensemble == Ensemble::kNone && least >= kLongChunk) {
    check.verdict = Verdict::kWarning;
    check.found += ", all of which are done before the next look: " +
                   short_number(static_cast<double>(least) / 5) + " s at 5 Hz";
    check.fix = {"chunk.use = 4"};
  }
  return check;
}

// Translations after denormalising.
Check judge_translation(const Profile& profile, const std::vector<RawAction>& actions,
                        const std::vector<RawAction>& raw, const KnownArm& arm) {
  const bool is_pose = profile.action_form == ActionForm::kAbsolute;
  const Vec3 from = is_pose ? known_state(false, arm).tcp_in_base.position : Vec3::Zero();
  std::vector<double> lengths;
  for (const RawAction& a : actions) lengths.push_back((Vec3(a[0], a[1], a[2]) - from).norm());
  const double usual = median(lengths);
  const double longest = *std::max_element(lengths.begin(), lengths.end());
  Check check{"translation",
              Verdict::kFine,
              "numbers 1 to 3: " + text_of(range_of(raw, 0, 3)) + "; a step moves " +
                  short_number(usual * 100) + " cm, at most " + short_number(longest * 100) + " cm",
              {}};
  const Range range = range_of(raw, 0, 3);
  if (longest == 0) {
    check.verdict = Verdict::kUnclear;
    check.found = "every answer stays where it is";
  } else if (usual > kUsualShift || longest > profile.action_limit_m) {
    const bool bounded = range.low >= -1.05 && range.high <= 1.05;
    check.verdict = Verdict::kWrong;
    if (is_pose) {
      check.found += "; they are no poses near the tool";
      check.fix = {"action.form = delta"};
      return check;
    }
    check.found += bounded ? "; they look normalised to -1 .. 1" : "; they are no metres a step";
    check.fix = {"action.normalised = bound    # or gaussian", "action.low = ...",
                 "action.high = ..."};
  } else if (profile.action_statistics.kind != Normalisation::kNone && longest < 1e-3) {
    check.verdict = Verdict::kWarning;
    check.found += "; the server may have denormalised already";
    check.fix = {"action.normalised = none"};
  }
  return check;
}

Vec3 rotation_of(const RawAction& a) { return {a[3], a[4], a[5]}; }

// Of an answer's numbers alone, roll pitch yaw and a rotation vector are told apart only where one
// of them could not be: the vector of a turn is at most pi long, and a pitch at most pi/2.
Check judge_rotation(const Profile& profile, const std::vector<RawAction>& actions) {
  double apart = 0, longest = 0, pitch = 0;
  for (const RawAction& action : actions) {
    const Vec3 v = rotation_of(action);
    longest = std::max(longest, v.norm());
    pitch = std::max(pitch, std::abs(v.y()));
    if (v.norm() > 1e5) continue;
    const Quat as_vector = robot::from_rotation_vector(v);
    const Quat as_rpy = robot::from_rpy(v);
    apart = std::max(apart,
                     robot::pose_error({Vec3::Zero(), as_vector}, {Vec3::Zero(), as_rpy}).rotation);
  }
  const bool is_euler = profile.action_rotation == RotationForm::kEuler;
  const double degrees = apart * 180 / kPi;
  Check check{"rotation",
              Verdict::kFine,
              "numbers 4 to 6: " + text_of(range_of(actions, 3, 3)) + "; a turn of at most " +
                  short_number(longest) +
                  " rad; as roll pitch yaw and as a rotation vector they are "
                  "up to " +
                  short_number(degrees) + " degrees apart",
              {}};
  if (longest == 0) {
    check.verdict = Verdict::kUnclear;
    check.found = "no answer turns, so roll pitch yaw and a rotation vector cannot be told apart";
  } else if (longest > kPi + 0.01 && pitch <= kPi / 2 + 0.01) {
    check.found += "; a rotation vector is never longer than pi: they are roll pitch yaw";
    if (!is_euler) {
      check.verdict = Verdict::kWrong;
      check.fix = {"action.rotation = euler"};
    }
  } else if (pitch > kPi / 2 + 0.01 && longest <= kPi + 0.01) {
    check.found += "; a pitch is never above pi/2: they are a rotation vector";
    if (is_euler) {
      check.verdict = Verdict::kWrong;
      check.fix = {"action.rotation = vector"};
    }
  } else if (longest > kUsualTurn && profile.action_form != ActionForm::kAbsolute &&
             profile.action_statistics.kind == Normalisation::kNone) {
    check.verdict = Verdict::kWarning;
    check.found += "; more than a policy turns in a step: normalised, or degrees?";
    check.fix = {"action.normalised = bound    # or gaussian"};
  } else if (degrees > 1) {
    check.verdict = Verdict::kUnclear;
    check.found += std::string(", and nothing in them tells which they are; the profile says ") +
                   (profile.action_rotation == RotationForm::kUnsaid ? "neither"
                    : is_euler                                       ? "euler"
                                                                     : "vector");
    check.fix = {is_euler ? "action.rotation = vector    # if the server converts already"
                          : "action.rotation = euler    # if the server answers its data set's"};
  } else {
    check.found += ": either reading does the same here";
  }
  return check;
}

bool is_unit(GripperRange range) {
  return range == GripperRange::kUnit || range == GripperRange::kUnitInverted;
}

// Of joints, which are not compared with the tool's pose: where they are, or how far they step.
Check judge_joints(const Profile& profile, const std::vector<RawAction>& actions,
                   const KnownArm& known) {
  const policy::Proprioception arm = known_state(false, known);
  const bool are_positions = profile.action_form == ActionForm::kJoints;
  std::vector<double> ways;
  for (const RawAction& action : actions) {
    double way = 0;
    for (std::size_t i = 0; i < arm.arm_joints(); ++i)
      way = std::max(way, std::abs(action[i] - (are_positions ? arm.joints[i] : 0)));
    ways.push_back(way);
  }
  const double usual = median(ways), longest = *std::max_element(ways.begin(), ways.end());
  Check check{"joints",
              Verdict::kFine,
              "numbers 1 to " + std::to_string(arm.arm_joints()) + ": " +
                  text_of(range_of(actions, 0, arm.arm_joints())) + "; a step moves a joint by " +
                  short_number(usual) + " rad, at most " + short_number(longest) + " rad",
              {}};
  if (longest == 0) {
    check.verdict = Verdict::kUnclear;
    check.found = "every answer stays where it is";
  } else if (usual > kUsualTurn) {
    check.verdict = Verdict::kWrong;
    check.found += are_positions ? "; they are no positions near the arm's" : "; they are no steps";
    check.fix = {std::string("action.form = ") + (are_positions ? "joint_steps" : "joints")};
  }
  return check;
}

// The range of the last number, against the profile's.
Check judge_gripper(const Profile& profile, const std::vector<RawAction>& actions) {
  const std::size_t last = actions[0].size() - 1;
  const Range range = range_of(actions, last, 1);
  Check check{
      "gripper", Verdict::kFine, "number " + std::to_string(last + 1) + ": " + text_of(range), {}};
  const bool inverted = is_inverted(profile.action_gripper);
  const std::string ending = inverted ? "_inverted" : "";
  if (range.low < -2 || range.high > 2) {
    check.verdict = Verdict::kWrong;
    check.found += ", far outside 0 .. 1 and -1 .. 1: another unit, or not yet denormalised";
    check.fix = {"action.normalised = bound    # or gaussian"};
  } else if (is_step(profile.action_gripper)) {
    // A hand that is open and has nothing to take is left alone.
    const bool rests = std::ranges::any_of(
        actions, [&](const RawAction& action) { return std::abs(action[last]) < 0.5; });
    if (!rests) {
      check.verdict = Verdict::kWarning;
      check.found += ", and no answer leaves the fingers where they are: an opening, not a step?";
      check.fix = {
          (range.low < -0.2 ? "action.gripper = signed" : "action.gripper = unit") + ending,
          range.low < -0.2 ? "action.threshold = 0" : "action.threshold = 0.5"};
    }
  } else if (is_unit(profile.action_gripper) && range.low < -0.2) {
    check.verdict = Verdict::kWrong;
    check.found += ", the profile says 0 .. 1";
    check.fix = {"action.gripper = signed" + ending, "action.threshold = 0"};
  } else if (!is_unit(profile.action_gripper) && range.low >= -0.2 &&
             (range.low < 0.9 || range.high < 0.9)) {
    check.verdict = Verdict::kWrong;
    check.found += ", which looks like 0 .. 1; the profile says -1 .. 1, where 0 is half open";
    check.fix = {"action.gripper = unit" + ending, "action.threshold = 0.5"};
  }
  // Who holds a switch has no threshold.
  if (profile.action_sticky != StickyRule::kNone) {
    std::erase_if(check.fix, [](const std::string& line) {
      return line.starts_with("action.threshold");
    });
  }
  return check;
}

// With an open gripper and nothing near it a policy keeps it open.
Check judge_polarity(const Profile& profile, const std::vector<std::vector<RawAction>>& chunks) {
  int closes = 0, read = 0;
  for (const auto& chunk : chunks) {
    RawAction only(robot::kActionSize, 0.0);
    only.back() = chunk.front().back();
    Profile gripper = profile;  // the others' numbers are judged elsewhere
    gripper.action_statistics = {};
    gripper.action_form = ActionForm::kDelta;
    const auto action = to_action(gripper, only);
    if (!action) continue;
    ++read;
    if ((*action)[6] < 0) ++closes;
  }
  Check check{"polarity", Verdict::kFine, "the first actions keep the open gripper open", {}};
  if (read == 0) {
    check.verdict = Verdict::kUnclear;
    check.found = "no answer's gripper can be read";
  } else if (2 * closes > read) {
    check.verdict = Verdict::kWarning;
    check.found = "in " + std::to_string(closes) + " of " + std::to_string(read) +
                  " answers the first action closes the open gripper over an empty table: is its "
                  "number the other way round?";
    const bool inverted = is_inverted(profile.action_gripper);
    check.fix = {std::string("action.gripper = ") +
                 (is_step(profile.action_gripper)   ? "step"
                  : is_unit(profile.action_gripper) ? "unit"
                                                    : "signed") +
                 (inverted ? "" : "_inverted")};
  }
  return check;
}

}  // namespace

std::vector<Check> judge_answers(const Profile& profile,
                                 const std::vector<std::vector<RawAction>>& chunks,
                                 const KnownArm& arm) {
  if (chunks.empty()) return {};
  std::vector<RawAction> raw, actions;
  for (const auto& chunk : chunks) raw.insert(raw.end(), chunk.begin(), chunk.end());
  for (const RawAction& action : raw) actions.push_back(denormalised(profile, action));
  if (names_joints(profile.action_form)) {
    return {judge_chunks(profile, chunks), judge_joints(profile, actions, arm),
            judge_gripper(profile, actions), judge_polarity(profile, chunks)};
  }
  return {judge_chunks(profile, chunks), judge_translation(profile, actions, raw, arm),
          judge_rotation(profile, actions), judge_gripper(profile, actions),
          judge_polarity(profile, chunks)};
}

}  // namespace probe::servers
