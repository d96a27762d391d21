// Where things lie behind the ten steps of waiting.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/libero/fidelity.h"
#include "runtime/libero/recorded_view.h"
#include "runtime/world/world.h"

namespace probe::libero {
namespace {

double angle_between(const Quat& a, const Quat& b) {
  const double dot = std::abs(a.dot(b));
  return dot > 1 ? 0 : 2 * std::acos(dot);  // no number stays none
}

// With which others an object is stored in one place: who touches it in the first substep, alone in
// the air.
Result<std::string> stored_in(const plan::Plan& plan, std::uint32_t task,
                              const stage::SharedAssets& assets, std::size_t start,
                              std::size_t object) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const auto bodies = plan.bodies(record);
  const auto placed = plan.placements(plan.episodes(record)[start]);
  world::WorldSpec spec;
  spec.surface_z = -1000;
  spec.gravity = Vec3::Zero();
  for (std::size_t i = 0; i < placed.size(); ++i) {
    spec.bodies.push_back({std::string(plan.text(bodies[i].name)),
                           assets.object_shape(bodies[i].index),
                           100,
                           1,
                           {to_vec(placed[i].position), to_quat(placed[i].rotation)}});
  }
  PROBE_ASSIGN(const auto world, world::World::create(std::move(spec)));
  PROBE_TRY(world->step(1));
  std::string names;
  for (const world::ContactImpulse& contact : world->contacts()) {
    for (const auto& [own, other] :
         {std::pair(contact.a, contact.b), std::pair(contact.b, contact.a)}) {
      if (own.kind != world::PartyKind::kBody || own.index != object ||
          other.kind != world::PartyKind::kBody)
        continue;
      names += (names.empty() ? "" : ", ") + std::string(plan.text(bodies[other.index].name));
    }
  }
  return names;
}

// What an object lies on or leans at.
std::string touched_by(const stage::Stage& stage, std::size_t object) {
  std::string names;
  for (const vm::ContactSample& contact : stage.sample().contacts) {
    if (contact.a != object && contact.b != object) continue;
    names += (names.empty() ? "" : ", ") +
             stage.body_names()[contact.a == object ? contact.b : contact.a];
  }
  return names;
}

}  // namespace

Result<FidelityRow> settling_row(Imported& imported, const Records& records, std::size_t starts) {
  constexpr double kPlace = 2e-3, kTurn = 2 * std::numbers::pi / 180, kShare = 0.95;
  FidelityRow row{
      "things behind the ten waiting steps",
      "95 % within 2 mm and 2 degrees",
      "",
      "imported starts after their waiting steps, each object against the recorded state",
      Held::kNo,
      {}};
  std::size_t all = 0, within = 0;
  std::vector<double> distances;
  for (const RecordedTask& task : records.tasks()) {
    PROBE_ASSIGN(const std::vector<RecordedState> states, records.settled(task));
    if (states.empty()) continue;
    PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite));
    PROBE_ASSIGN(const auto assets, imported.assets(task.suite, task.name()));
    PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), {.pictures = false}));
    PROBE_ASSIGN(const std::vector<std::size_t> places, object_places(*stage, task));
    for (std::size_t i = 0; i < std::min(states.size(), starts); ++i, ++all) {
      PROBE_TRY(stage->reset(static_cast<std::uint32_t>(i)));
      // The thing that is worst off, measured by the bar.
      double worst = -1, distance = 0, angle = 0;
      std::size_t which = 0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Pose &ours = stage->objects()[places[k]], &theirs = states[i].objects[k];
        const double d = (ours.position - theirs.position).norm();
        const double a = angle_between(ours.rotation, theirs.rotation);
        const double off = worse(d / kPlace, a / kTurn);
        if (!(off <= worst)) worst = off, distance = d, angle = a, which = places[k];
      }
      distances.push_back(distance);
      if (worst <= 1) {
        ++within;
        continue;
      }
      PROBE_ASSIGN(const std::string inside, stored_in(*plan, stage->task(), *assets, i, which));
      row.others.push_back(fmt::format("{}, start {}: {} by {:.1f} mm and {:.1f} degrees, {} {}",
                                       task.key(), i, stage->body_names()[which], 1e3 * distance,
                                       angle * 180 / std::numbers::pi,
                                       inside.empty() ? "comes to rest on" : "is stored in",
                                       inside.empty() ? touched_by(*stage, which) : inside));
    }
  }
  if (all == 0) {
    row.held = Held::kNotMeasured;
    row.how = "the records have settled states of no task";
    return row;
  }
  std::ranges::sort(distances);
  row.figure = fmt::format("{:.2f} % ({} of {}), {:.2g} mm in the median",
                           100 * static_cast<double>(within) / static_cast<double>(all), within,
                           all, 1e3 * distances[distances.size() / 2]);
  row.held =
      static_cast<double>(within) >= kShare * static_cast<double>(all) ? Held::kYes : Held::kNo;
  return row;
}

}  // namespace probe::libero
