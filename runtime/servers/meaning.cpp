#include "runtime/servers/meaning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/servers/conversion.h"
#include "runtime/servers/profile_words.h"

namespace probe::servers {
namespace {

// m: no policy moves as far in one step, and the tool of the known observations is three times as
// far from the base.
constexpr double kFarthestStep = 0.12;
constexpr double kMeasuredSlack = 0.01;  // rad, of what regression overshoots

template <typename E>
OpenField open_field(const char* field) {
  OpenField open{field, {}};
  for (const auto& word : words_of(E{})) {
    if (word.value != E::kUnsaid) open.values.emplace_back(word.text);
  }
  return open;
}

Vec3 shift_of(const RawAction& a) { return {a[0], a[1], a[2]}; }

std::optional<std::string> measured_form(const std::vector<RawAction>& actions) {
  const Vec3 tool = known_state(false).tcp_in_base.position;
  const auto all = [&](const Vec3& around) {
    return std::ranges::all_of(actions, [&](const RawAction& action) {
      return (shift_of(action) - around).norm() < kFarthestStep;
    });
  };
  if (all(Vec3::Zero())) return "delta";
  if (all(tool)) return "absolute";
  return std::nullopt;
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

}  // namespace

std::vector<OpenField> open_fields(const Profile& adapted) {
  std::vector<OpenField> open;
  if (adapted.action_form == ActionForm::kUnsaid)
    open.push_back(open_field<ActionForm>("action.form"));
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

std::optional<std::string> measured_value(const OpenField& open, const Profile& adapted,
                                          const std::vector<Chunk>& answers) {
  std::vector<RawAction> actions;
  for (const Chunk& answer : answers) {
    for (const RawAction& raw : answer) actions.push_back(denormalised(adapted, raw));
  }
  if (actions.empty()) return std::nullopt;
  if (open.field == "action.form") return measured_form(actions);
  if (open.field == "action.rotation") return measured_rotation(actions);
  return std::nullopt;
}

Status check_said(const Profile& adapted,
                  const std::vector<std::pair<std::string, std::string>>& measured,
                  const std::string& server) {
  std::string fields, lines;
  for (const OpenField& open : open_fields(adapted)) {
    const bool is_known =
        std::ranges::any_of(measured, [&](const auto& known) { return known.first == open.field; });
    // What a pose's units are follows from its being one.
    const bool is_pose = open.field == "action.units" &&
                         std::ranges::count(measured, std::pair<std::string, std::string>(
                                                          "action.form", "absolute")) > 0;
    if (is_known || is_pose) continue;
    fields += (fields.empty() ? "`" : ", `") + open.field + "`";
    for (const std::string& value : open.values)
      lines += std::string(lines.empty() ? "" : " | ") + open.field + " = " + value;
  }
  if (fields.empty()) return {};
  return Failure{Fault::kUsage,
                 "what the server's actions mean is neither said by profile `" + adapted.name +
                     "` nor shown by its answers: " + fields + " (" + lines +
                     "); `vlaprobe policy test` shows the numbers, and no episode is done on a "
                     "guess",
                 server};
}

}  // namespace probe::servers
