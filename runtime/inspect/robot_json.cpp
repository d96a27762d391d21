#include "runtime/inspect/robot_json.h"

#include <fmt/format.h>

#include <array>

#include "runtime/robot/laws.h"

namespace probe::inspect {
namespace {

Json law_of(const plan::Plan& plan, plan::Control control, const plan::LawRecord& law) {
  if (control == plan::Control::kJointDelta) {
    const bool from_target = (law.flags & plan::kLawFromTarget) != 0;
    return {{"from", from_target ? "target" : "measured"}, {"most", law.most}};
  }
  if (control == plan::Control::kEeDeltaInterpolated)
    return {{"arm_path", law.arm_path}, {"grip_path", law.finger_path}};
  Json home = Json::array();
  for (const double q : plan.home(law)) home.push_back(q);
  return {
      {"kp", law.kp},
      {"damping", law.damping},
      {"output", law.output},
      {"null", law.null_kp},
      {"uncouple", (law.flags & plan::kLawUncoupled) != 0},
      {"ramp", law.ramp},
      {"home", std::move(home)},
      {"grip",
       {{"pace", law.grip_pace}, {"stiffness", law.grip_stiffness}, {"limit", law.grip_limit}}}};
}

// "150", "(150, 50)" of shift and turn, or all six.
std::string six(const Json& numbers) {
  const auto at = [&](std::size_t i) { return fmt::format("{:.6g}", numbers[i].get<double>()); };
  const auto alike = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (numbers[i] != numbers[first]) return false;
    }
    return true;
  };
  if (alike(0, 6)) return at(0);
  if (alike(0, 3) && alike(3, 6)) return "(" + at(0) + ", " + at(3) + ")";
  std::string all;
  for (std::size_t i = 0; i < 6; ++i) all += (all.empty() ? "(" : ", ") + at(i);
  return all + ")";
}

}  // namespace

Json robot_of(const plan::Plan& plan, const plan::TaskRecord& task) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const plan::RobotRecord& robot = plan.robots()[scene.robot];
  Json json;
  json["name"] = plan.text(robot.name);
  json["control"] = robot::control_kinds()[robot.control - 1].word;
  json["hz"] = robot.control_hz;
  json["drives"] = Json::array();
  for (const plan::DriveRecord& drive : plan.drives(robot))
    json["drives"].push_back(plan.text(drive.joint));
  json["fingers"] = Json::array();
  for (const plan::FingerRecord& finger : plan.fingers(robot))
    json["fingers"].push_back(plan.text(finger.link));
  const auto control = static_cast<plan::Control>(robot.control);
  // A `joint_position` has a record and no number in it.
  const plan::LawRecord* law = plan.law(robot);
  if (law != nullptr && control != plan::Control::kJointPosition)
    json["law"] = law_of(plan, control, *law);
  const auto gears = plan.gears(robot);
  for (std::size_t i = 0; i < gears.size(); ++i) {
    json["gears"][std::string(plan.text(plan.drives(robot)[i].joint))] = {
        {"friction", gears[i].friction}, {"armature", gears[i].armature}};
  }
  if (scene.air_density != 0 || scene.air_viscosity != 0)
    json["air"] = {{"density", scene.air_density}, {"viscosity", scene.air_viscosity}};
  return json;
}

std::string robot_text(const Json& robot) {
  std::string text = fmt::format("{}, {} at {:.6g} Hz", robot["name"].get<std::string>(),
                                 robot["control"].get<std::string>(), robot["hz"].get<double>());
  if (robot["fingers"].empty()) text += ", no fingers";
  if (robot["fingers"].size() > 2) text += fmt::format(", {} fingers", robot["fingers"].size());
  if (robot.contains("air")) {
    text +=
        fmt::format(", in air of {:.6g} kg/m3 and {:.6g} Pa s",
                    robot["air"]["density"].get<double>(), robot["air"]["viscosity"].get<double>());
  }
  return text;
}

std::string law_text(const Json& robot) {
  if (!robot.contains("law")) return {};
  const Json& law = robot["law"];
  const auto number = [](const Json& value) { return fmt::format("{:.6g}", value.get<double>()); };
  if (law.contains("most")) {
    const double most = law["most"].get<double>();
    return "steps from the " +
           std::string(law["from"].get<std::string>() == "target" ? "last target"
                                                                  : "measured position") +
           (most > 0 ? fmt::format(", at most {:.6g} rad or m", most) : "");
  }
  if (law.contains("arm_path")) {
    const auto path = [&](const Json& numbers) {
      return fmt::format("({}, {}, {})", number(numbers[0]), number(numbers[1]),
                         number(numbers[2]));
    };
    return "paths of joints of at most so much a s, s2, s3: arm " + path(law["arm_path"]) +
           ", gripper " + path(law["grip_path"]) + " rad or m";
  }
  std::string home;
  for (const Json& q : law["home"]) home += (home.empty() ? "" : ", ") + number(q);
  const Json& grip = law["grip"];
  return fmt::format(
      "kp {}, damping {}, output {} m and rad, null {}{}, ramp {}, home ({}); gripper: pace {}, "
      "stiffness {} N/m, limit {} N",
      six(law["kp"]), six(law["damping"]), six(law["output"]), number(law["null"]),
      law["uncouple"].get<bool>() ? ", uncoupled" : "", number(law["ramp"]), home,
      number(grip["pace"]), number(grip["stiffness"]), number(grip["limit"]));
}

}  // namespace probe::inspect
