#include "runtime/libero/fidelity_settling.h"

#include <algorithm>
#include <cmath>

namespace probe::libero {
namespace {

double angle_between(const Quat& a, const Quat& b) {
  return 2 * std::acos(std::min(1.0, std::abs(a.dot(b))));
}

// The plan has objects in the order of their roles.
Result<std::vector<std::size_t>> places_of(const stage::Stage& stage, const RecordedTask& task) {
  std::vector<std::size_t> places;
  for (const auto& [name, said] : task.said["objects"].items()) {
    const auto at = std::ranges::find(stage.body_names(), name);
    if (at == stage.body_names().end())
      return Failure{Fault::kUsage, "the import has no object `" + name + "`", task.key()};
    places.push_back(static_cast<std::size_t>(at - stage.body_names().begin()));
  }
  return places;
}

}  // namespace

Result<std::vector<SettledStart>> settle_all(Imported& imported, const Records& records,
                                             std::size_t starts) {
  std::vector<SettledStart> all;
  for (const RecordedTask& task : records.tasks()) {
    PROBE_ASSIGN(const std::vector<RecordedState> states, records.settled(task));
    if (states.empty()) continue;
    PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), false));
    PROBE_ASSIGN(const std::vector<std::size_t> places, places_of(*stage, task));
    for (std::size_t i = 0; i < std::min(states.size(), starts); ++i) {
      PROBE_TRY(stage->reset(static_cast<std::uint32_t>(i)));
      SettledStart& found = all.emplace_back();
      found.task = task.key();
      found.start = i;
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Pose &ours = stage->objects()[places[k]], &theirs = states[i].objects[k];
        const double distance = (ours.position - theirs.position).norm();
        const double angle = angle_between(ours.rotation, theirs.rotation);
        const std::string& name = stage->body_names()[places[k]];
        if (distance >= found.distance) found.distance = distance, found.farthest = name;
        if (angle >= found.angle) found.angle = angle, found.tilted = name;
      }
      const auto joints = stage->q().last(states[i].fixture_joints.size());
      for (std::size_t k = 0; k < joints.size(); ++k)
        found.joint = std::max(found.joint, std::abs(joints[k] - states[i].fixture_joints[k]));
    }
  }
  return all;
}

}  // namespace probe::libero
