#include "runtime/libero/recorded_view.h"

#include <algorithm>

#include "runtime/plan/fixtures.h"

namespace probe::libero {
namespace {

Result<std::span<const stage::CameraFrame>> frames_of(const plan::Plan& plan, stage::Stage& stage,
                                                      std::span<const double> q,
                                                      std::span<const Pose> objects) {
  const plan::EpisodeRecord& episode = plan.episodes(plan.tasks()[stage.task()])[0];
  return stage.view()->render_seen({Sha256{episode.start_id}, 0},
                                   [&](int) -> stage::SceneView::Placed {
                                     return {q, objects};
                                   });
}

}  // namespace

Result<std::vector<std::size_t>> object_places(const stage::Stage& stage,
                                               const RecordedTask& task) {
  std::vector<std::size_t> places;
  for (const auto& [name, said] : task.said["objects"].items()) {
    const auto at = std::ranges::find(stage.body_names(), name);
    if (at == stage.body_names().end())
      return Failure{Fault::kUsage, "the import has no object `" + name + "`", task.key()};
    places.push_back(static_cast<std::size_t>(at - stage.body_names().begin()));
  }
  return places;
}

Result<std::span<const stage::CameraFrame>> first_frames(const plan::Plan& plan,
                                                         stage::Stage& stage) {
  const plan::TaskRecord& record = plan.tasks()[stage.task()];
  const plan::SceneRecord& scene = plan.scenes()[record.scene];
  const plan::EpisodeRecord& episode = plan.episodes(record)[0];
  const auto arm = plan.joints(scene, episode);
  std::vector<double> q(arm.begin(), arm.end());
  for (const double joint : plan::joint_starts_of(plan.tables(), scene, episode))
    q.push_back(joint);
  std::vector<Pose> objects;
  for (const plan::PlacementRecord& placed : plan.placements(episode))
    objects.push_back({to_vec(placed.position), to_quat(placed.rotation)});
  return frames_of(plan, stage, q, objects);
}

Result<std::span<const stage::CameraFrame>> recorded_frames(const plan::Plan& plan,
                                                            stage::Stage& stage,
                                                            const RecordedTask& task,
                                                            const RecordedState& state) {
  std::vector<double> q(state.arm);
  q.push_back(state.fingers[0]);
  q.push_back(-state.fingers[1]);
  q.insert(q.end(), state.fixture_joints.begin(), state.fixture_joints.end());
  PROBE_ASSIGN(const std::vector<std::size_t> places, object_places(stage, task));
  std::vector<Pose> objects(stage.objects().begin(), stage.objects().end());
  if (q.size() != stage.q().size() || places.size() != objects.size())
    return Failure{Fault::kUsage, "the import has other joints or objects than the record",
                   task.key()};
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k] >= objects.size())
      return Failure{Fault::kUsage, "what the record moves does not move in the import",
                     task.key()};
    objects[places[k]] = state.objects[k];
  }
  return frames_of(plan, stage, q, objects);
}

}  // namespace probe::libero
