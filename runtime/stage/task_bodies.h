// Which body of a task is what: task-local indices of the judge, the trace and the pictures meet
// the world's parties here and nowhere else.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/urdf.h"
#include "runtime/world/world.h"

namespace probe::stage {

struct TaskBodies {
  static constexpr std::uint16_t kNone = 0xffff;
  std::size_t count = 0;    // of all
  std::size_t objects = 0;  // bodies 0 .. objects - 1: source, target, distractors
  std::uint16_t surface = 0, fixture = kNone, first_link = 0;
  std::vector<int> links;  // URDF link of each link body, fingers first; as the world counts links

  // The body that a party of the world is.
  std::uint16_t local(const world::Party& party) const;
};

// Fails (kPlan, kUrdf) when the task's bodies do not add up or a link is not the robot's.
Result<TaskBodies> task_bodies(const plan::Plan& plan, const plan::TaskRecord& task,
                               const robot::RobotModel& model);

}  // namespace probe::stage
