// The joint trees of a task's world and where their links are: the robot's, then those of fixtures.
// What is measured and what is drawn come from here, so they agree.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/kinematics.h"
#include "runtime/stage/assets.h"

namespace probe::stage {

struct PlacedTree {
  const UrdfParts* parts = nullptr;  // of the assets
  robot::Tree tree;
  Pose base;                    // of the root link, world
  std::size_t first_joint = 0;  // of its joints among the world's
  std::vector<Pose> links;      // by URDF link in the root link's frame, as place() left them
  const std::vector<ShownWhile>* shown = nullptr;  // of the assets; of a robot null

  // `all` are the positions of all the world's joints, or of more.
  std::span<const double> own(std::span<const double> all) const {
    return all.subspan(first_joint, tree.joint_count());
  }
  void place(std::span<const double> q) { tree.link_poses(own(q), links); }
  // Whether a link is seen where the joints stand so.
  bool shows(int link, std::span<const double> q) const {
    if (shown == nullptr) return true;
    const std::string& name = parts->model.links[static_cast<std::size_t>(link)].name;
    return std::ranges::all_of(*shown, [&](const ShownWhile& one) {
      return one.link != name || one.holds(own(q)[one.joint]);
    });
  }
  Pose link(int index) const { return base * links[static_cast<std::size_t>(index)]; }
};

// In the order in which the world has them. `assets` were loaded for the task and outlive the
// trees. Fails (kUrdf) on joints that a description lacks.
Result<std::vector<PlacedTree>> placed_trees(const plan::Plan& plan, const plan::TaskRecord& task,
                                             const SharedAssets& assets);

}  // namespace probe::stage
