// A plan's robot as data for whoever acts, and the controller of a task.
#pragma once

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/robot.h"
#include "runtime/stage/assets.h"

namespace probe::stage {

// `parts` are the assets of the record's URDF and outlive the robot. Fails (kUrdf) on fingers
// that are not there or hang on no joint, (kPlan) on drives in an order that the controller
// does not have or a control that this program does not know.
Result<robot::Robot> robot_of(const plan::Plan& plan, const plan::RobotRecord& record,
                              const UrdfParts& parts);

// Names of the driven joints in order, and the robot's base in world.
std::vector<std::string> drive_joints(const plan::Plan& plan, const plan::RobotRecord& robot);
Pose base_pose(const plan::SceneRecord& scene);

}  // namespace probe::stage
