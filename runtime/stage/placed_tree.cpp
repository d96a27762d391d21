#include "runtime/stage/placed_tree.h"

#include <string>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/stage/robot_of.h"

namespace probe::stage {

Result<std::vector<PlacedTree>> placed_trees(const plan::Plan& plan, const plan::TaskRecord& task,
                                             const SharedAssets& assets) {
  std::vector<PlacedTree> trees;
  const auto add = [&](const UrdfParts& parts, const std::vector<std::string>& joints,
                       const Pose& base) -> Status {
    PROBE_ASSIGN(robot::Tree tree, robot::Tree::create(parts.model, joints));
    const std::size_t first =
        trees.empty() ? 0 : trees.back().first_joint + trees.back().tree.joint_count();
    std::vector<Pose> links(tree.link_count());
    trees.push_back({&parts, std::move(tree), base, first, std::move(links)});
    return {};
  };
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const plan::RobotRecord& robot = plan.robots()[scene.robot];
  const UrdfParts* parts = assets.robot(robot.urdf);
  PROBE_CHECK(parts != nullptr, "assets are loaded for the tasks that run");
  PROBE_TRY(add(*parts, drive_joints(plan, robot), base_pose(scene)));
  for (const LoadedFixture* loaded : assets.fixtures(task.scene)) {
    std::vector<std::string> joints;
    for (const world::JointSpec& joint : loaded->fixture.joints) joints.push_back(joint.joint);
    PROBE_TRY(add(loaded->parts, joints, loaded->fixture.base));
    trees.back().shown = &loaded->fixture.shown;
  }
  return trees;
}

}  // namespace probe::stage
