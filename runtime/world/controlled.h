// A robot's controller and the world it acts in: what a control step is, for every law.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/robot/controller.h"
#include "runtime/world/world.h"

namespace probe::world {

class ControlLoop {
 public:
  // The controller's robot is the world's first articulation. Fails (kWorld) if the world drives it
  // in another way than the law does (ArticulationSpec::by_efforts), or has not its joints.
  static Result<ControlLoop> create(const World& world, const robot::Controller& controller);

  // One control step: the action, then `substeps`. Fails (kPolicy) on an action that means nothing;
  // nothing has changed then.
  Status step(std::span<const double> action, int substeps, robot::Controller* controller,
              World* world);

 private:
  ControlLoop() = default;
  World::ToolRef tool_;  // of a law that reads dynamics
  robot::Dynamics now_;
  std::vector<double> efforts_;
};

// The joints of an articulation by efforts: friction and damping as the description has them, no
// drive. `armature` by joint, kg m2 or kg, or empty for none. Friction gives way, see below. Fails
// (kWorld) on joints that no tree can have.
Result<std::vector<JointSpec>> effort_joints(const robot::RobotModel& model,
                                             std::span<const std::string> joints,
                                             std::span<const double> armature);

// Lets the joints' friction give way as MuJoCo's does by its default numbers (solref 0.02 1, solimp
// 0.9 0.95): it fades speeds at 2 / (0.95 x 0.02 s), and its give is a ninth of the joint's
// mobility at position 0 of all joints. Fails (kWorld) on joints that no tree can have.
Status give_way_as_engine(const robot::RobotModel& model, std::span<JointSpec> joints);

}  // namespace probe::world
