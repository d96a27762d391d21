#include "runtime/cli/task_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "runtime/base/trig.h"

namespace probe::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<plan::Axis, const char*>, 12> kAxes = {{
    {plan::Axis::kObjectSource, "object.source"},
    {plan::Axis::kObjectTarget, "object.target"},
    {plan::Axis::kDistractors, "distractors"},
    {plan::Axis::kLanguageAction, "language.action"},
    {plan::Axis::kLanguageNegation, "language.negation"},
    {plan::Axis::kLanguageAppearance, "language.appearance"},
    {plan::Axis::kLanguageCommonsense, "language.commonsense"},
    {plan::Axis::kLayout, "layout"},
    {plan::Axis::kScene, "scene"},
    {plan::Axis::kLight, "light"},
    {plan::Axis::kCamera, "camera"},
    {plan::Axis::kGoal, "goal"},
}};

struct RollPitchYaw {
  double roll_deg = 0, pitch_deg = 0, yaw_deg = 0;
};

// Extrinsic x, y, z angles of a unit quaternion (w, x, y, z), rounded to 1e-9 degrees so that a
// written 90 reads 90; yaw in (-180, 180].
RollPitchYaw to_angles(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  const auto rounded = [](double degrees) {
    const double value = std::nearbyint(degrees * 1e9) / 1e9;
    return value == -180.0 ? 180.0 : value + 0.0;
  };
  return {rounded(portable_atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) * kDegrees),
          rounded(portable_asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0)) * kDegrees),
          rounded(portable_atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) * kDegrees)};
}

std::string object_name(const plan::Plan& plan, std::uint32_t object) {
  return std::string(plan.text(plan.objects()[object].name));
}

}  // namespace

Json summarise(const plan::Plan& plan, std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[index];
  Json json;
  json["task"] = plan.text(task.name);
  json["baseline"] =
      task.baseline == plan::kNone ? Json() : Json(plan.text(plan.tasks()[task.baseline].name));
  json["axes"] = Json::array();
  for (const auto& [axis, name] : kAxes) {
    if (task.axes & static_cast<std::uint32_t>(axis)) json["axes"].push_back(name);
  }
  json["categories"] = Json::array();
  for (const plan::SetRecord& set : plan.sets()) {
    const auto members = plan.members(set);
    if (std::find(members.begin(), members.end(), index) != members.end()) {
      json["categories"].push_back(plan.text(set.name));
    }
  }
  json["prompt"] = plan.text(task.prompt);
  json["episodes"] = plan.episodes(task).size();
  return json;
}

Json describe(const plan::Plan& plan, std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[index];
  Json json = summarise(plan, index);
  json["source"] = object_name(plan, task.source);
  json["target"] = object_name(plan, task.target);
  json["distractors"] = Json::array();
  const auto bodies = plan.bodies(task);
  for (std::uint32_t d = 0; d < task.distractors; ++d)
    json["distractors"].push_back(plan.text(bodies[2 + d].name));
  json["horizon"] = task.horizon;
  json["metrics"] = Json::array();
  for (const plan::MetricRecord& metric : plan.metrics(task))
    json["metrics"].push_back(plan.text(metric.name));
  json["starts"] = Json::array();
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    Json start = Json::array();
    for (const plan::PlacementRecord& placement : plan.placements(episode)) {
      const RollPitchYaw angles = to_angles(placement.rotation);
      start.push_back({{"object", object_name(plan, placement.object)},
                       {"x_m", placement.position[0]},
                       {"y_m", placement.position[1]},
                       {"roll_deg", angles.roll_deg},
                       {"pitch_deg", angles.pitch_deg},
                       {"yaw_deg", angles.yaw_deg}});
    }
    json["starts"].push_back(std::move(start));
  }
  return json;
}

}  // namespace probe::cli
