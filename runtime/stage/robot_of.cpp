#include "runtime/stage/robot_of.h"

#include <algorithm>
#include <limits>
#include <string>

#include "runtime/robot/hands.h"
#include "runtime/stage/hand_of_shapes.h"
#include "runtime/world/controlled.h"

namespace probe::stage {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Result<robot::Finger> finger_of(const plan::Plan& plan, const plan::FingerRecord& record,
                                const robot::RobotModel& model) {
  robot::Finger finger;
  finger.link = std::string(plan.text(record.link));
  finger.opens = to_vec(record.opens).normalized();
  const int link = model.find_link(finger.link);
  if (link < 0) return Failure{Fault::kUrdf, "no link `" + finger.link + "`", model.path};
  const int joint = model.links[static_cast<std::size_t>(link)].parent_joint;
  if (joint < 0) {
    return Failure{Fault::kUrdf, "finger `" + finger.link + "` hangs on no joint", model.path};
  }
  finger.joint = model.joints[static_cast<std::size_t>(joint)].name;
  return finger;
}

// The drive that moves the finger: that of its joint or, where it has none, of the joint it mimics.
std::string driven_joint(const robot::Finger& finger, const robot::Robot& robot) {
  const auto& joints = robot.model->joints;
  const auto& joint = joints[static_cast<std::size_t>(robot.model->find_joint(finger.joint))];
  if (contains(robot.joints, joint.name) || joint.mimic < 0) return joint.name;
  return joints[static_cast<std::size_t>(joint.mimic)].name;
}

Result<robot::Law> law_of(const plan::Plan& plan, const plan::RobotRecord& record,
                          const std::string& where) {
  const auto control = static_cast<plan::Control>(record.control);
  if (control == plan::Control::kEeDeltaPose) return robot::Law(robot::EeDeltaPose{});
  const plan::LawRecord* numbers = plan.law(record);
  if (numbers == nullptr) return Failure{Fault::kPlan, "the control law has no numbers", where};
  switch (control) {
    case plan::Control::kOscPose: {
      robot::OscPose law;
      law.kp = numbers->kp;
      law.damping = numbers->damping;
      law.output = numbers->output;
      law.null_kp = numbers->null_kp;
      law.uncouple = (numbers->flags & plan::kLawUncoupled) != 0;
      law.ramp = numbers->ramp;
      const auto home = plan.home(*numbers);
      law.home.assign(home.begin(), home.end());
      law.grip = {numbers->grip_pace, numbers->grip_stiffness, numbers->grip_limit};
      for (const plan::DriveRecord& drive : plan.drives(record)) {
        if (law.limits.size() < law.home.size()) law.limits.push_back(drive.limit);
      }
      return robot::Law(std::move(law));
    }
    case plan::Control::kJointDelta:
      return robot::Law(
          robot::JointDelta{(numbers->flags & plan::kLawFromTarget) != 0, numbers->most});
    case plan::Control::kEeDeltaInterpolated: {
      const auto limits = [](const std::array<double, 3>& of) {
        return robot::PathLimits{of[0], of[1], of[2]};
      };
      return robot::Law(robot::EeDeltaInterpolated{
          limits(numbers->arm_path), limits(numbers->finger_path), 1 / record.control_hz});
    }
    case plan::Control::kJointPosition:
      return robot::Law(robot::JointPosition{});
    default:
      break;
  }
  return Failure{Fault::kPlan, "control " + std::to_string(record.control) + " is not known here",
                 where};
}

}  // namespace

std::vector<std::string> drive_joints(const plan::Plan& plan, const plan::RobotRecord& robot) {
  std::vector<std::string> names;
  for (const plan::DriveRecord& drive : plan.drives(robot))
    names.emplace_back(plan.text(drive.joint));
  return names;
}

Result<std::vector<world::JointSpec>> drives_of(const plan::Plan& plan,
                                                const plan::RobotRecord& record,
                                                const robot::RobotModel& model) {
  std::vector<world::JointSpec> made;
  const auto gears = plan.gears(record);
  for (const plan::DriveRecord& drive : plan.drives(record)) {
    world::JointSpec& joint = made.emplace_back();
    joint.joint = std::string(plan.text(drive.joint));
    joint.stiffness = drive.stiffness;
    joint.damping = drive.damping;
    joint.limit = drive.limit;
    if (gears.empty()) continue;
    joint.friction = gears[made.size() - 1].friction;
    joint.armature = gears[made.size() - 1].armature;
  }
  if (record.control != static_cast<std::uint32_t>(plan::Control::kOscPose)) return made;
  for (world::JointSpec& joint : made) {
    joint.stiffness = 0;
    joint.limit = std::numeric_limits<double>::infinity();
  }
  PROBE_TRY(world::give_way_as_engine(model, made));
  return made;
}

Pose base_pose(const plan::SceneRecord& scene) {
  return {to_vec(scene.base_position), to_quat(scene.base_rotation)};
}

Result<robot::Robot> robot_of(const plan::Plan& plan, const plan::RobotRecord& record,
                              const UrdfParts& parts) {
  const std::string where = "robot `" + std::string(plan.text(record.name)) + "`";
  const robot::RobotModel& model = parts.model;
  robot::Robot robot;
  robot.name = std::string(plan.text(record.name));
  robot.model = &model;
  robot.tcp_link = std::string(plan.text(record.tcp));
  robot.joints = drive_joints(plan, record);
  for (const plan::FingerRecord& finger : plan.fingers(record)) {
    PROBE_ASSIGN(robot::Finger made, finger_of(plan, finger, model));
    robot.fingers.push_back(std::move(made));
  }

  robot::EeControlSpec& control = robot.control;
  control.tcp_link = robot.tcp_link;
  control.grip_closed = record.grip_closed;
  control.grip_open = record.grip_open;
  for (const robot::Finger& finger : robot.fingers) {
    std::string joint = driven_joint(finger, robot);
    if (!contains(control.finger_joints, joint)) control.finger_joints.push_back(std::move(joint));
  }
  for (const std::string& joint : robot.joints) {
    if (!contains(control.finger_joints, joint)) control.arm_joints.push_back(joint);
  }
  std::vector<std::string> order = control.arm_joints;
  order.insert(order.end(), control.finger_joints.begin(), control.finger_joints.end());
  if (order != robot.joints) {
    return Failure{Fault::kPlan, "drives stand in another order than arm joints, then the fingers'",
                   where};
  }
  PROBE_ASSIGN(robot.law, law_of(plan, record, where));
  if (robot.fingers.size() == 2) robot.hand = robot::known_hand(model.name);
  if (!robot.hand) robot.hand = hand_of_shapes(robot, parts);
  return robot;
}

}  // namespace probe::stage
