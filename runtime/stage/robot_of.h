// A plan's robot as data for whoever acts, and the controller of a task.
#pragma once

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/robot.h"
#include "runtime/stage/assets.h"
#include "runtime/world/spec.h"

namespace probe::stage {

// `parts` are the assets of the record's URDF and outlive the robot. Fails (kUrdf) on fingers
// that are not there or hang on no joint, (kPlan) on drives in an order that the controller
// does not have or a control that this program does not know.
Result<robot::Robot> robot_of(const plan::Plan& plan, const plan::RobotRecord& record,
                              const UrdfParts& parts);

// What acts in the robot's joints, in drive order. Under a law that gives efforts there are no
// springs: what is left are damping, friction and rotors, as the engine of that law has them.
// Fails (kWorld) on joints that no tree can have.
Result<std::vector<world::JointSpec>> drives_of(const plan::Plan& plan,
                                                const plan::RobotRecord& record,
                                                const robot::RobotModel& model);

// Names of the driven joints in order, and the robot's base in world.
std::vector<std::string> drive_joints(const plan::Plan& plan, const plan::RobotRecord& robot);
Pose base_pose(const plan::SceneRecord& scene);

}  // namespace probe::stage
