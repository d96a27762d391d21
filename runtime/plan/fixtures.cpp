#include "runtime/plan/fixtures.h"

namespace probe::plan {

std::vector<const FixtureJointRecord*> joints_of(const Tables& tables, const SceneRecord& scene) {
  std::vector<const FixtureJointRecord*> joints;
  for (const std::uint32_t fixture : slice_of(tables.list, scene.fixtures)) {
    for (const FixtureJointRecord& joint :
         slice_of(tables.fixture_joints, tables.fixtures[fixture].joints))
      joints.push_back(&joint);
  }
  return joints;
}

std::vector<std::string> joint_names_of(const Tables& tables, const SceneRecord& scene) {
  std::vector<std::string> names;
  for (const std::uint32_t index : slice_of(tables.list, scene.fixtures)) {
    const FixtureRecord& fixture = tables.fixtures[index];
    for (const FixtureJointRecord& joint : slice_of(tables.fixture_joints, fixture.joints))
      names.push_back(std::string(tables.text(fixture.name)) + "." +
                      std::string(tables.text(joint.joint)));
  }
  return names;
}

std::vector<double> joint_starts_of(const Tables& tables, const SceneRecord& scene,
                                    const EpisodeRecord& episode) {
  if (episode.joints.count > 0) {
    const auto given = slice_of(tables.reals, episode.joints);
    return {given.begin(), given.end()};
  }
  std::vector<double> starts;
  for (const FixtureJointRecord* joint : joints_of(tables, scene)) starts.push_back(joint->start);
  return starts;
}

}  // namespace probe::plan
