#include "runtime/servers/meaning.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "runtime/servers/conversion.h"
#include "runtime/servers/profile_words.h"
#include "runtime/servers/protocol.h"

namespace probe::servers {
namespace {

// m: no policy moves as far in one step, and the tool of the known observations is three times as
// far from the base.
constexpr double kFarthestStep = 0.12;
// rad: no policy turns a joint as far in one step, and mirroring the known arm turns its waist by
// more.
constexpr double kFarthestTurn = 0.3;
constexpr double kMeasuredSlack = 0.01;  // rad, of what regression overshoots

template <typename E>
OpenField open_field(const char* field) {
  OpenField open{field, {}};
  for (const auto& word : words_of(E{})) {
    if (word.value != E::kUnsaid) open.values.emplace_back(word.text);
  }
  return open;
}

OpenField open_form(const Profile& adapted) {
  OpenField open{"action.form", {}};
  const bool has_joints = row_of(adapted.protocol).has_joint_actions;
  for (const auto& word : kActionForms) {
    if (word.value == ActionForm::kUnsaid || (names_joints(word.value) && !has_joints)) continue;
    open.values.emplace_back(word.text);
  }
  return open;
}

std::vector<RawAction> actions_of(const Profile& adapted, const std::vector<Chunk>& answers) {
  std::vector<RawAction> actions;
  for (const Chunk& answer : answers) {
    for (const RawAction& raw : answer) actions.push_back(denormalised(adapted, raw));
  }
  return actions;
}

Vec3 shift_of(const RawAction& a) { return {a[0], a[1], a[2]}; }

bool is_near(const RawAction& action, const Vec3& place) {
  return (shift_of(action) - place).norm() < kFarthestStep;
}

bool is_at_joints(const RawAction& action, const policy::Proprioception& arm) {
  if (action.size() != arm.arm_joints() + 1) return false;
  for (std::size_t i = 0; i < arm.arm_joints(); ++i) {
    if (std::abs(action[i] - arm.joints[i]) >= kFarthestTurn) return false;
  }
  return true;
}

// Whether actions of arms on either side can have been meant so.
bool could_be(ActionForm form, const std::vector<RawAction>& here,
              const std::vector<RawAction>& mirrored, const KnownArm& known) {
  const auto all = [&](bool is_mirrored, const std::vector<RawAction>& actions) {
    const policy::Proprioception arm = known_state(is_mirrored, known);
    return std::ranges::all_of(actions, [&](const RawAction& action) {
      switch (form) {
        case ActionForm::kAbsolute:
          return is_near(action, arm.tcp_in_base.position);
        case ActionForm::kJoints:
          return is_at_joints(action, arm);
        case ActionForm::kJointSteps:
          return action.size() == arm.arm_joints() + 1 && is_near(action, Vec3::Zero());
        case ActionForm::kDelta:
        case ActionForm::kUnsaid:
          break;
      }
      return is_near(action, Vec3::Zero());
    });
  };
  return all(false, here) && all(true, mirrored);
}

// Numbers beyond 1 are no shares, and those of a policy are no metres either: nothing is left.
std::optional<std::string> measured_rotation(const std::vector<RawAction>& actions) {
  double longest = 0, pitch = 0;
  for (const RawAction& a : actions) {
    longest = std::max(longest, Vec3(a[3], a[4], a[5]).norm());
    pitch = std::max(pitch, std::abs(a[4]));
  }
  const bool is_no_vector = longest > std::numbers::pi + kMeasuredSlack;
  const bool is_no_euler = pitch > std::numbers::pi / 2 + kMeasuredSlack;
  if (is_no_vector && !is_no_euler) return "euler";
  if (is_no_euler && !is_no_vector) return "vector";
  return std::nullopt;
}

std::string lines_of(const OpenField& open) {
  std::string lines;
  for (const std::string& value : open.values)
    lines += (lines.empty() ? "" : " | ") + open.field + " = " + value;
  return lines;
}

}  // namespace

std::vector<OpenField> open_fields(const Profile& adapted) {
  std::vector<OpenField> open;
  if (adapted.action_form == ActionForm::kUnsaid) open.push_back(open_form(adapted));
  // Statistics say what the numbers are, and a pose has no scale.
  if (adapted.action_units == ActionUnits::kUnsaid &&
      adapted.action_statistics.kind == Normalisation::kNone &&
      adapted.action_form != ActionForm::kAbsolute && adapted.action_form != ActionForm::kJoints) {
    open.push_back(open_field<ActionUnits>("action.units"));
  }
  if (adapted.action_rotation == RotationForm::kUnsaid && !names_joints(adapted.action_form))
    open.push_back(open_field<RotationForm>("action.rotation"));
  return open;
}

bool wants_mirrored(const Profile& adapted) {
  return adapted.action_form == ActionForm::kUnsaid && row_of(adapted.protocol).has_joint_actions;
}

std::vector<OpenField> left_open(const Profile& adapted, const KnownAnswers& answers) {
  const std::vector<RawAction> here = actions_of(adapted, answers.here);
  const std::vector<RawAction> mirrored = actions_of(adapted, answers.mirrored);
  Profile known = adapted;
  std::optional<OpenField> form;
  if (adapted.action_form == ActionForm::kUnsaid) {
    form = open_form(adapted);
    std::vector<std::string> left;
    for (const auto& word : kActionForms) {
      const bool is_open = std::ranges::count(form->values, word.text) > 0;
      if (is_open && !here.empty() && could_be(word.value, here, mirrored, answers.arm))
        left.emplace_back(word.text), known.action_form = word.value;
    }
    // From one side alone no form of several is measured.
    if (left.size() == 1 && wants_mirrored(adapted) && mirrored.empty()) left.clear();
    if (!left.empty()) form->values = std::move(left);
    if (form->values.size() != 1) known.action_form = ActionForm::kUnsaid;
  }
  std::vector<OpenField> left;
  if (form) left.push_back(std::move(*form));
  for (OpenField& open : open_fields(known)) {
    if (open.field == "action.form") continue;
    if (open.field == "action.rotation") {
      if (auto value = measured_rotation(here)) open.values = {std::move(*value)};
    }
    left.push_back(std::move(open));
  }
  return left;
}

std::vector<std::pair<std::string, std::string>> measured_of(const std::vector<OpenField>& left) {
  std::vector<std::pair<std::string, std::string>> measured;
  for (const OpenField& open : left) {
    if (open.values.size() == 1) measured.emplace_back(open.field, open.values.front());
  }
  return measured;
}

Status check_said(const Profile& adapted, const std::vector<OpenField>& left,
                  const std::string& server) {
  std::string fields, lines;
  for (const OpenField& open : left) {
    if (open.values.size() == 1) continue;
    if (open.values == std::vector<std::string>{"delta", "joint_steps"})
      lines += "small numbers fit changes of the pose and steps of joints alike: ";
    fields += (fields.empty() ? "`" : ", `") + open.field + "`";
    lines += (lines.empty() || lines.ends_with(": ") ? "" : " | ") + lines_of(open);
  }
  if (fields.empty()) return {};
  return Failure{Fault::kUsage,
                 "what the server's actions mean is neither said by profile `" + adapted.name +
                     "` nor shown by its answers: " + fields + " (" + lines +
                     "); `vlaprobe policy test` shows the numbers, and no episode is done on a "
                     "guess",
                 server};
}

namespace {

// Where the law adds the gripper's number to what was asked for last, an opening is none: 0.6 of
// the way, said twice, would be all of it. With a threshold each is all the way, which is the same.
Status check_gripper(const Profile& profile, const robot::KindRow& law, const std::string& server) {
  const bool takes_steps = law.kind == robot::ControlKind::kEeDeltaInterpolated;
  const bool is_sticky = profile.action_sticky != StickyRule::kNone;
  const bool is_said = is_step(profile.action_gripper) || is_sticky;
  if (takes_steps ? is_said || profile.action_threshold.has_value() : !is_said) return {};
  const std::string_view word =
      std::ranges::find(kGrippers, profile.action_gripper, &Word<GripperRange>::value)->text;
  return Failure{
      Fault::kUsage,
      "the gripper's number of profile `" + profile.name + "` is `" + std::string(word) +
          "` (`action.gripper`), " + (is_said ? "how far it is to go" : "an opening") +
          ", and a robot of the run is controlled by `" + std::string(law.word) +
          "`, which takes " +
          (takes_steps
               ? "how far it is to go (`action.gripper = step`, or a threshold that opens or "
                 "closes it whole: `action.threshold`, or openings that are held: `action.sticky`)"
               : "an opening (`action.gripper = signed`)"),
      server};
}

}  // namespace

Status check_form(const Profile& profile, ActionForm form, robot::ControlKind control,
                  const std::string& server) {
  struct Takes {
    ActionForm form;
    const char* what;
  };
  // Of each law but `ee_delta_pose`, which takes all.
  const auto takes = [&]() -> Takes {
    switch (control) {
      case robot::ControlKind::kOscPose:
      case robot::ControlKind::kEeDeltaInterpolated:
        return {ActionForm::kDelta, "changes of the tool's pose"};
      case robot::ControlKind::kJointDelta:
        return {ActionForm::kJointSteps, "steps of the arm's joints"};
      case robot::ControlKind::kJointPosition:
        return {ActionForm::kJoints, "positions of the arm's joints"};
      case robot::ControlKind::kEeDeltaPose:
        break;
    }
    return {form, ""};
  }();
  const robot::KindRow& row = robot::control_kinds()[static_cast<std::size_t>(control)];
  PROBE_TRY(check_gripper(profile, row, server));
  if (form == ActionForm::kUnsaid || form == takes.form) return {};
  const auto word_of = [](ActionForm of) {
    return std::string(std::ranges::find(kActionForms, of, &Word<ActionForm>::value)->text);
  };
  return Failure{Fault::kUsage,
                 "actions of profile `" + profile.name + "` are `" + word_of(form) +
                     "` (`action.form`), and a robot of the run is controlled by `" +
                     std::string(row.word) + "`, which takes " + takes.what +
                     " alone (`action.form = " + word_of(takes.form) + "`)",
                 server};
}

}  // namespace probe::servers
