#include "compiler/geometry/part_place.h"

#include <array>
#include <string>
#include <vector>

#include "compiler/geometry/pose.h"

namespace probe::sema {

std::optional<robot::Tree> tree_of(const Fixture& fixture) {
  std::vector<std::string> names;
  for (const Fixture::Joint& joint : fixture.joints) names.push_back(joint.name);
  auto tree = robot::Tree::create(*fixture.model, names);
  if (!tree.ok()) return std::nullopt;
  return std::move(*tree);
}

std::span<const double> joints_of(const Model& model, const Scene& scene, FixtureId fixture,
                                  std::span<const double> all) {
  for (const FixtureId id : scene.fixtures) {
    const std::size_t count = model.fixtures[id].joints.size();
    if (id == fixture) return all.first(count);
    all = all.subspan(count);
  }
  return {};
}

Pose place_of(const Scene& scene, const Fixture& fixture) {
  std::array<double, 3> position = fixture.position;
  position[2] += scene.fixtures_lift;
  return pose_of(position, fixture.turn.rotation);
}

Pose part_pose(const Pose& place, const Fixture& fixture, const robot::Tree& tree,
               std::span<const double> joints, std::uint32_t part) {
  std::vector<Pose> poses(tree.link_count());
  tree.link_poses(joints, poses);
  return place * poses[static_cast<std::size_t>(fixture.parts[part].index)];
}

}  // namespace probe::sema
