// The WidowX as data, for tests of the expert.
#pragma once

#include <doctest/doctest.h>

#include "runtime/robot/hands.h"
#include "runtime/robot/robot.h"

namespace probe::expert::test {

// `model` outlives it.
inline robot::Robot widowx(const robot::RobotModel& model) {
  robot::Robot robot;
  robot.name = model.name;
  robot.model = &model;
  robot.tcp_link = "ee_gripper_link";
  robot.control = {
      .tcp_link = "ee_gripper_link",
      .arm_joints = {"waist", "shoulder", "elbow", "forearm_roll", "wrist_angle", "wrist_rotate"},
      .finger_joints = {"left_finger", "right_finger"}};
  robot.joints = robot.control.arm_joints;
  robot.joints.insert(robot.joints.end(), robot.control.finger_joints.begin(),
                      robot.control.finger_joints.end());
  robot.fingers = {{"left_finger_link", "left_finger", Vec3::UnitY()},
                   {"right_finger_link", "right_finger", -Vec3::UnitY()}};
  robot.hand = robot::known_hand(model.name);
  REQUIRE(robot.hand.has_value());
  return robot;
}

inline const robot::Robot& widowx() {
  static const robot::RobotModel model = [] {
    auto loaded = robot::load_urdf(VLAPROBE_SOURCE_DIR "/assets/robots/widowx/wx250s.urdf");
    REQUIRE(loaded.ok());
    return std::move(loaded).value();
  }();
  static const robot::Robot robot = widowx(model);
  return robot;
}

}  // namespace probe::expert::test
