#include "runtime/inspect/scene_facts.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>

namespace probe::inspect {
namespace {

std::string place(std::span<const double> metres) {
  std::string text;
  for (const double value : metres)
    text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", 100 * value + 0.0);  // no -0
  return "(" + text + ") cm";
}

// Quaternions are w x y z; most turns are about the vertical. q and -q are one turn.
std::string turn(const std::array<double, 4>& q) {
  if (std::abs(q[1]) > 1e-9 || std::abs(q[2]) > 1e-9) {
    const double sign = q[0] < 0 ? -1 : 1;
    return fmt::format("turned ({:.6g}, {:.6g}, {:.6g}, {:.6g})", sign * q[0] + 0.0,
                       sign * q[1] + 0.0, sign * q[2] + 0.0, sign * q[3] + 0.0);
  }
  double yaw = std::remainder(360 / std::numbers::pi * std::atan2(q[3], q[0]), 360.0);
  if (yaw < -180 + 1e-9) yaw += 360;
  return fmt::format("yaw {:.6g} deg", yaw + 0.0);
}

std::string file(const plan::Plan& plan, std::uint32_t asset) {
  return asset == plan::kNone ? "none" : std::string(plan.text(plan.assets()[asset].path));
}

std::string posture(const plan::Plan& plan, const plan::SceneRecord& scene) {
  std::string text;
  for (const double value : plan.joints(scene))
    text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", value);
  return text;
}

std::string fixtures(const plan::Plan& plan, const plan::SceneRecord& scene) {
  std::string text;
  for (const std::uint32_t index : plan.fixtures(scene)) {
    const plan::FixtureRecord& fixture = plan.fixtures()[index];
    text += fmt::format("{}{} at {}, {}", text.empty() ? "" : "; ", plan.text(fixture.name),
                        place(fixture.position), turn(fixture.rotation));
  }
  if (scene.fixture_visual != plan::kNone || scene.fixture_collision != plan::kNone)
    text += fmt::format("{}{} at {}", text.empty() ? "" : "; ", file(plan, scene.fixture_visual),
                        place(scene.fixture_position));
  return text.empty() ? "none" : text;
}

}  // namespace

std::vector<SceneFact> scene_facts(const plan::Plan& plan, std::uint32_t scene) {
  const plan::SceneRecord& s = plan.scenes()[scene];
  const std::span area(s.area);
  return {
      {"base", "at " + place(s.base_position) + ", " + turn(s.base_rotation)},
      {"posture", posture(plan, s)},
      {"area", place(area.first(2)) + " .. " + place(area.last(2))},
      {"physics", fmt::format("{:.6g} Hz, friction {:.6g}", s.physics_hz, s.friction)},
      {"air", fmt::format("{:.6g} kg/m3, {:.6g} Pa s", s.air_density, s.air_viscosity)},
      {"stands", fixtures(plan, s)},
      {"backdrop", file(plan, s.backdrop)},
      {"photo", file(plan, s.photo)},
  };
}

std::vector<SceneFact> facts_in_place(const plan::Plan& plan, std::uint32_t scene) {
  const std::vector<SceneFact> own = scene_facts(plan, scene);
  std::vector<bool> differs(own.size());
  const std::string_view name = plan.text(plan.scenes()[scene].name);
  for (std::uint32_t other = 0; other < plan.scenes().size(); ++other) {
    if (other == scene || plan.text(plan.scenes()[other].name) != name) continue;
    const std::vector<SceneFact> theirs = scene_facts(plan, other);
    for (std::size_t i = 0; i < own.size(); ++i) differs[i] = differs[i] || !(own[i] == theirs[i]);
  }
  std::vector<SceneFact> out;
  for (std::size_t i = 0; i < own.size(); ++i)
    if (differs[i]) out.push_back(own[i]);
  return out;
}

}  // namespace probe::inspect
