// What a profile leaves open: measured where the answers leave one value, refused else.
#include "runtime/servers/meaning.h"

#include <doctest/doctest.h>

#include "runtime/servers/conformance.h"
#include "runtime/servers/profile_library.h"
#include "runtime/servers/reading.h"
#include "tests/runtime/servers/asking.h"

namespace probe::servers {
namespace {

std::vector<std::string> names_of(const Profile& profile) {
  std::vector<std::string> names;
  for (const OpenField& open : open_fields(profile)) names.push_back(open.field);
  return names;
}

// What the answers leave of a field: "delta absolute".
std::string left(const std::string& field, const Profile& profile, const KnownAnswers& answers) {
  std::string values;
  for (const OpenField& open : left_open(profile, answers)) {
    if (open.field != field) continue;
    for (const std::string& value : open.values) values += (values.empty() ? "" : " ") + value;
  }
  return values;
}

// Of a protocol whose servers do not answer with joints.
std::optional<std::string> measured(const std::string& field, const std::vector<RawAction>& chunk) {
  Profile profile;
  profile.protocol = Protocol::kVlaEval;
  for (const auto& [name, value] : measured_of(left_open(profile, {{chunk}, {}}))) {
    if (name == field) return value;
  }
  return std::nullopt;
}

Result<policy::Reading> read_by(const std::string& habit, const std::string& options) {
  const test::PythonServer server("openpi_server.py", {"openpi", "seen=" + habit});
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's python3-websockets is installed");
  const auto choice = choose_server(
      Protocol::kOpenpi, "//127.0.0.1:" + server.port() + "?timeout.wait_s=0.05" + options);
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  return prove_reading(*choice);
}

}  // namespace

TEST_CASE("form, units and rotation are open until they are said; some say others") {
  Profile profile;
  CHECK(names_of(profile) ==
        std::vector<std::string>{"action.form", "action.units", "action.rotation"});
  profile.action_statistics.kind = Normalisation::kBound;
  CHECK(names_of(profile) == std::vector<std::string>{"action.form", "action.rotation"});
  profile = {};
  profile.action_form = ActionForm::kAbsolute;
  CHECK(names_of(profile) == std::vector<std::string>{"action.rotation"});
}

TEST_CASE("answers show poses from changes, and a rotation where the other could not be") {
  CHECK(measured("action.form", {{0.01, 0, 0, 0, 0, 0, 1}}) == "delta");
  CHECK(measured("action.form", {{0.31, 0.04, 0.15, 0, 0, 0, 1}}) == "absolute");
  // Shares of a step are neither.
  CHECK(measured("action.form", {{0.01, 0, 0, 0, 0, 0, 1}, {0.9, -0.8, 0.3, 0, 0, 0, 1}}) ==
        std::nullopt);
  CHECK(measured("action.rotation", {{0, 0, 0, 2.5, 0.1, 2.5, 1}}) == "euler");
  CHECK(measured("action.rotation", {{0, 0, 0, 0.1, 2.5, 0.1, 1}}) == "vector");
  CHECK(measured("action.rotation", {{0, 0, 0, 0.1, 0.1, 0.1, 1}}) == std::nullopt);
  CHECK(measured("action.units", {{0.01, 0, 0, 0, 0, 0, 1}}) == std::nullopt);
}

TEST_CASE("a run is refused what is neither said nor shown, with the lines that say it") {
  const std::string open = "&action.rotation=unsaid";
  const auto refused = read_by("fine", open);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().message.find("`action.rotation` (action.rotation = vector | "
                                       "action.rotation = euler)") != std::string::npos);
  const auto shown = read_by("euler", open);
  REQUIRE_MESSAGE(shown.ok(), to_text(shown.failure()));
  const std::vector<std::pair<std::string, std::string>> expected{{"action.rotation", "euler"}};
  CHECK(shown->measured == expected);
  const auto units = read_by("fine", "&action.units=unsaid");
  REQUIRE_FALSE(units.ok());
  CHECK(units.failure().message.find("action.units = m_rad | action.units = box") !=
        std::string::npos);
  const auto poses = read_by("poses", "&action.form=unsaid&action.units=unsaid");
  REQUIRE_MESSAGE(poses.ok(), to_text(poses.failure()));
  CHECK(poses->measured.front().second == "absolute");
}

TEST_CASE("small numbers that may be changes of the pose or steps of joints are refused, by both") {
  const Profile profile;  // openpi's
  CHECK(left("action.form", profile, {{{{0.01, 0, 0, 0, 0, 0, 1}}}, {}}) == "delta joint_steps");
  CHECK(left("action.form", profile, {{{{0.9, -0.8, 0.3, 0, 0, 0, 1}}}, {}}) ==
        "delta absolute joints joint_steps");
  const auto refused = read_by("fine", "&action.form=unsaid");
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().message.find(
            "`action.form` (small numbers fit changes of the pose and steps of joints alike: "
            "action.form = delta | action.form = joint_steps)") != std::string::npos);
  CHECK(read_by("fine", "&action.form=delta").ok());
}

TEST_CASE("a law without a target of its own takes changes alone, and says so before an episode") {
  using robot::ControlKind;
  const Profile profile;
  CHECK(check_form(profile, ActionForm::kDelta, ControlKind::kOscPose, "s").ok());
  CHECK(check_form(profile, ActionForm::kUnsaid, ControlKind::kOscPose, "s").ok());
  for (const ActionForm form :
       {ActionForm::kAbsolute, ActionForm::kJoints, ActionForm::kJointSteps}) {
    CHECK(check_form(profile, form, ControlKind::kEeDeltaPose, "s").ok());
    const Status refused = check_form(profile, form, ControlKind::kOscPose, "s");
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.failure().code == Fault::kUsage);
    CHECK(refused.failure().message.find("controlled by `osc_pose`") != std::string::npos);
  }
  const test::PythonServer server("openpi_server.py", {"openpi", "seen=poses"});
  REQUIRE_FALSE(server.port().empty());
  const auto choice =
      choose_server(Protocol::kOpenpi,
                    "//127.0.0.1:" + server.port() + "?action.form=unsaid&action.units=unsaid");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  KnownArm arm;
  CHECK(prove_reading(*choice, nullptr, arm).ok());
  arm.control = ControlKind::kOscPose;
  const auto read = prove_reading(*choice, nullptr, arm);
  REQUIRE_FALSE(read.ok());
  CHECK(read.failure().message.find("are `absolute` (`action.form`)") != std::string::npos);
}

TEST_CASE("a gripper's number that is an opening is none where the law wants a step, nor back") {
  using robot::ControlKind;
  const auto takes = [](const char* gripper, const char* threshold, ControlKind control) {
    auto profile =
        parse_profile(std::string("protocol = openpi\nimage = first -> image\naction.form = delta\n"
                                  "action.gripper = ") +
                          gripper + "\naction.threshold = " + threshold + "\n",
                      "mine");
    REQUIRE_MESSAGE(profile.ok(), to_text(profile.failure()));
    return check_form(*profile, ActionForm::kDelta, control, "server");
  };
  for (const char* opening : {"signed", "unit", "signed_inverted", "unit_inverted"}) {
    CAPTURE(opening);
    CHECK(takes(opening, "none", ControlKind::kEeDeltaPose).ok());
    const Status refused = takes(opening, "none", ControlKind::kEeDeltaInterpolated);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.failure().code == Fault::kUsage);
    CHECK(refused.failure().message.find("`" + std::string(opening) +
                                         "` (`action.gripper`), an opening") != std::string::npos);
    // All the way or none of it: a step says the same.
    CHECK(takes(opening, "0.5", ControlKind::kEeDeltaInterpolated).ok());
  }
  for (const char* step : {"step", "step_inverted"}) {
    CAPTURE(step);
    CHECK(takes(step, "none", ControlKind::kEeDeltaInterpolated).ok());
    for (const ControlKind law :
         {ControlKind::kEeDeltaPose, ControlKind::kOscPose, ControlKind::kJointDelta})
      CHECK(takes(step, "none", law).failure().message.find("how far it is to go, and a robot") !=
            std::string::npos);
  }
}

TEST_CASE("poses and positions of joints show themselves by the arm's other side") {
  const Profile profile;
  const RawAction pose{0.3, 0.05, 0.14, 0, 1.5, 0, 1}, other_pose{0.3, -0.05, 0.14, 0, 1.5, 0, 1};
  const RawAction joints{0.2, 0.05, 0.2, 0, 1.4, 0, 1}, other_joints{-0.2, 0, 0.2, 0, 1.4, 0, 1};
  CHECK(left("action.form", profile, {{{pose}}, {}}) == "absolute joints");
  CHECK(left("action.form", profile, {{{pose}}, {{other_pose}}}) == "absolute");
  CHECK(left("action.form", profile, {{{joints}}, {{other_joints}}}) == "joints");
  // Neither, so nothing is shown.
  CHECK(left("action.form", profile, {{{pose}}, {{joints}}}) ==
        "delta absolute joints joint_steps");
  const auto shown =
      read_by("joints",
              "&state.layout=joints&action.form=unsaid&action.units=unsaid&action.rotation=unsaid");
  REQUIRE_MESSAGE(shown.ok(), to_text(shown.failure()));
  const std::vector<std::pair<std::string, std::string>> expected{{"action.form", "joints"}};
  CHECK(shown->measured == expected);
}

TEST_CASE("a policy test names what is left open, and what its answers show of it") {
  const test::PythonServer server("openpi_server.py", {"openpi", "seen=euler", "chunk=4"});
  REQUIRE_FALSE(server.port().empty());
  const auto choice =
      choose_server(Protocol::kOpenpi,
                    "//127.0.0.1:" + server.port() + "?action.rotation=unsaid&action.units=unsaid");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  const auto tested = test_server(*choice);
  REQUIRE_MESSAGE(tested.ok(), to_text(tested.failure()));
  std::string said;
  for (const Check& check : tested->checks) {
    if (!check.name.starts_with("action.")) continue;
    said += check.name + " " + std::string(to_word(check.verdict)) + " " + check.fix.front() + "; ";
  }
  CHECK(
      said ==
      "action.units wrong action.units = m_rad; action.rotation warning action.rotation = euler; ");
  CHECK(tested->queries <= 20);
}

TEST_CASE("every ready profile says what its actions mean, but where the server or the user must") {
  for (const ProfileText& ready : ready_profiles()) {
    CAPTURE(std::string(ready.name));
    const auto profile = find_profile(ready.name);
    REQUIRE_MESSAGE(profile.ok(), to_text(profile.failure()));
    const auto open = names_of(*profile);
    if (ready.name == "gr00t") {
      CHECK(open == std::vector<std::string>{"action.rotation"});
    } else if (profile->protocol == Protocol::kRoboArena) {
      CHECK(open == std::vector<std::string>{"action.form", "action.units"});
    } else if (profile->protocol == Protocol::kVlaEval || ready.name == "lerobot") {
      CHECK(open.size() == 3);
    } else {
      CHECK(open.empty());
    }
  }
}

TEST_CASE("GR00T's two profiles differ in how roll, pitch and yaw are done") {
  auto meant = find_profile("gr00t_bridge_as_meant").value();
  const auto published = find_profile("gr00t_bridge_as_published").value();
  CHECK(meant.action_rotation == RotationForm::kEuler);
  CHECK(published.action_rotation == RotationForm::kVector);
  meant.action_rotation = RotationForm::kVector;
  CHECK(profile_sha256(meant) == profile_sha256(published));
}

}  // namespace probe::servers
