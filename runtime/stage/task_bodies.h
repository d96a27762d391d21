// Which body of a task is what: task-local indices of the judge, the trace and the pictures meet
// the world's parties here and nowhere else.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/assets.h"
#include "runtime/world/world.h"

namespace probe::stage {

struct TaskBodies {
  static constexpr std::uint16_t kNone = 0xffff;
  // A body that is a link of a joint tree.
  struct Link {
    std::size_t tree = 0;  // of placed_trees(): 0 is the robot's
    int link = 0;          // of its URDF
  };
  std::vector<std::string> names;  // of all: the plan's bodies, then the links of fixtures
  std::size_t objects = 0;         // bodies 0 .. objects - 1
  std::uint16_t surface = 0, fixture = kNone, first_link = 0;
  std::size_t robot_links = 0;
  std::vector<Link> links;  // from first_link on, as the world counts them: the robot's with its
                            // fingers first, then those of fixtures

  std::size_t count() const { return names.size(); }
  // The body that a party of the world is.
  std::uint16_t local(const world::Party& party) const;
  // The body that a link is; nothing for one that nothing can touch.
  std::optional<std::uint16_t> of_link(std::size_t tree, int link) const;
};

// `assets` were loaded for the task. Fails (kPlan, kUrdf) when the task's bodies do not add up or a
// link is not the robot's.
Result<TaskBodies> task_bodies(const plan::Plan& plan, const plan::TaskRecord& task,
                               const SharedAssets& assets);

}  // namespace probe::stage
