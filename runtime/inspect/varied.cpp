#include "runtime/inspect/varied.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "runtime/base/trig.h"
#include "runtime/plan/moves.h"
#include "runtime/plan/shakes.h"

namespace probe::inspect {
namespace {

std::string covered_with(const plan::Plan& plan, const plan::CoverRecord& cover) {
  return fmt::format("covered with `{}`, {:.6g} cm a picture",
                     plan.text(plan.assets()[cover.texture].path), 100 * cover.side);
}

std::string what_does(const plan::SensorRecord& sensor) {
  std::string text;
  const auto out = std::back_inserter(text);
  if (sensor.blur > 0) fmt::format_to(out, ", blur {:.6g} px", sensor.blur);
  if (sensor.exposure > 0) fmt::format_to(out, ", exposure {:.6g}", sensor.exposure);
  if (sensor.noise > 0) fmt::format_to(out, ", noise {:.6g}", sensor.noise);
  const auto& p = sensor.patch;
  if (p != std::array<double, 4>{})
    fmt::format_to(out, ", patch ({:.6g}, {:.6g}) .. ({:.6g}, {:.6g})", p[0], p[1], p[2], p[3]);
  if (sensor.dropped > 0) fmt::format_to(out, ", dropped {:.6g}", sensor.dropped);
  if (sensor.mirrored != 0) text += ", mirrored";
  return text.empty() ? "nothing" : text.substr(2);
}

// Of joints that turn, over all starts, in degrees.
double farthest_arm(const plan::Plan& plan, const plan::TaskRecord& task) {
  const auto from = plan.joints(plan.scenes()[task.scene]);
  double most = 0;
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    const auto arm = plan.joints(plan.scenes()[task.scene], episode);
    for (std::size_t i = 0; i < arm.size(); ++i) most = std::max(most, std::abs(arm[i] - from[i]));
  }
  return most * 180 / std::numbers::pi;
}

// "shaken by up to 2.9 cm and 4.8 degrees", over all starts; empty where it stands as it says.
std::string how_shaken(const plan::Plan& plan, const plan::TaskRecord& task, std::size_t view) {
  double moved = 0, turned = 0;
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    const plan::Shake shake = plan::shake_of(plan::shakes_of(plan.tables(), episode), view);
    const auto& m = shake.moved;
    moved = std::max(moved, std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]));
    const auto& q = shake.turned;
    const double sine = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    turned = std::max(turned, 2 * portable_asin(std::min(1.0, sine)));
  }
  if (moved == 0 && turned == 0) return "";
  return fmt::format("shaken by up to {:.3g} cm and {:.3g} degrees", 100 * moved,
                     turned * 180 / std::numbers::pi);
}

}  // namespace

std::vector<std::string> varied_in(const plan::Plan& plan, const plan::TaskRecord& task) {
  std::vector<std::string> varied;
  for (const plan::BodyRecord& body : plan.bodies(task)) {
    if (body.kind != static_cast<std::uint32_t>(plan::BodyKind::kObject)) continue;
    const plan::ObjectRecord& object = plan.objects()[body.index];
    const std::string name(plan.text(body.name));
    if (object.scale != 0) varied.push_back(fmt::format("{} scaled by {:.6g}", name, object.scale));
    const auto& paint = object.paint;
    if (paint[3] != 0)
      varied.push_back(fmt::format("{} painted ({}, {}, {})", name, paint[0], paint[1], paint[2]));
    if (const plan::CoverRecord* cover = plan.cover(object))
      varied.push_back(name + " " + covered_with(plan, *cover));
  }
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  constexpr const char* kParts[] = {"surface", "walls", "floor"};
  for (const plan::CoverRecord& cover : plan.covers(scene))
    varied.push_back(std::string(kParts[cover.what - 1]) + " " + covered_with(plan, cover));
  const auto& color = plan.lights()[task.light].color;
  if (color != std::array<double, 3>{})
    varied.push_back(fmt::format("light ({:.6g}, {:.6g}, {:.6g})", color[0], color[1], color[2]));
  const std::vector<plan::ViewRecord> views = plan.views(task);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const plan::ViewRecord& view = views[i];
    if (const std::string shaken = how_shaken(plan, task, i); !shaken.empty())
      varied.push_back(fmt::format("{}: {}", plan.text(view.name), shaken));
    if (const plan::SensorRecord* sensor = plan.sensor(plan.cameras()[view.camera]))
      varied.push_back(fmt::format("{}: {}", plan.text(view.name), what_does(*sensor)));
  }
  if (task.delay != 0)
    varied.push_back(
        fmt::format("actions late by {} {}", task.delay, task.delay == 1 ? "step" : "steps"));
  for (const auto legs : plan::moves_of(plan.tables(), task))
    varied.push_back(fmt::format("{} moves {}",
                                 plan.text(plan.bodies(task)[legs.front().body].name),
                                 plan::move_text(legs)));
  if (const double most = farthest_arm(plan, task); most > 0)
    varied.push_back(fmt::format("the arm begins up to {:.3g} degrees elsewhere", most));
  return varied;
}

}  // namespace probe::inspect
