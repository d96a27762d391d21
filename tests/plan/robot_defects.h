// One defect a rule of robots' laws, gears and fingers, made on the small plan with a second robot.
#pragma once

#include "tests/plan/defects.h"

namespace probe::plan {

// The small plan with an arm under osc_pose behind its own: two gears, three fingers.
inline Writer robot_writer() {
  Writer w = small_writer();
  Records& r = w.records;
  RobotRecord robot = r.robots[0];
  robot.name = w.text("panda");
  robot.control = static_cast<std::uint32_t>(Control::kOscPose);
  robot.control_hz = 20;
  const std::vector<DriveRecord> drives = {{w.text("waist"), 0, 1, 50},
                                           {w.text("elbow"), 0, 1, 40}};
  robot.drives = append<DriveRecord>(r.drives, drives);
  robot.meshes = {};
  LawRecord law;
  law.kp = {150, 150, 150, 150, 150, 150};
  law.damping = {1, 1, 1, 1, 1, 1};
  law.output = {0.05, 0.05, 0.05, 0.5, 0.5, 0.5};
  law.null_kp = 10;
  law.grip_pace = 0.01;
  law.grip_stiffness = 1000;
  law.grip_limit = 20;
  law.home = w.reals(std::vector<double>{0.1, -0.2});
  law.flags = kLawUncoupled;
  r.laws.push_back(law);
  robot.law = {0, 1};
  const std::vector<GearRecord> gears = {{0.1, 5}, {0.1, 2.5}};
  robot.gears = append<GearRecord>(r.gears, gears);
  r.fingers.push_back({w.text("thumb"), {0, 0, 1}});
  robot.more_fingers = {0, 1};
  r.robots.push_back(robot);
  return w;
}

inline std::vector<Defect> robot_defects() {
  return {
      {"ROBT", "control law 9", [](Records& r, Writer&) { r.robots[1].control = 9; }},
      {"ROBT", "record",
       [](Records& r, Writer&) {
         r.robots[1].law = {5, 1};
       }},
      {"ROBT", "control 1 has 0 records in LAWS, not 1",
       [](Records& r, Writer&) {
         r.robots[0].law = {0, 1};
       }},
      {"ROBT", "control 2 has 1 records in LAWS, not 0",
       [](Records& r, Writer&) { r.robots[1].law = {}; }},
      {"LAWS", "a gain", [](Records& r, Writer&) { r.laws[0].kp[2] = -1; }},
      {"LAWS", "finite", [](Records& r, Writer&) { r.laws[0].damping[5] = kInf; }},
      {"LAWS", "asks for", [](Records& r, Writer&) { r.laws[0].output[0] = 0; }},
      {"LAWS", "ramps over a share", [](Records& r, Writer&) { r.laws[0].ramp = 1.5; }},
      {"LAWS", "ramps over a share", [](Records& r, Writer&) { r.laws[0].grip_limit = 0; }},
      {"LAWS", "does not read", [](Records& r, Writer&) { r.laws[0].most = 0.1; }},
      {"LAWS", "does not read",
       [](Records& r, Writer&) {
         r.laws[0].home = {};
         r.robots[1].control = static_cast<std::uint32_t>(Control::kJointDelta);
       }},
      {"LAWS", "reserved", [](Records& r, Writer&) { r.laws[0].zero = 1; }},
      {"LAWS", "does not read", [](Records& r, Writer&) { r.laws[0].finger_path[2] = 50; }},
      {"LAWS", "a limit of a path", [](Records& r, Writer&) { r.laws[0].arm_path[0] = -1; }},
      {"LAWS", "a speed, an acceleration and a jerk",
       [](Records& r, Writer&) {
         r.robots[1].control = static_cast<std::uint32_t>(Control::kEeDeltaInterpolated);
         r.laws[0] = {};
         r.laws[0].arm_path = {1.5, 2, 50};
         r.laws[0].finger_path = {1, 0, 50};
       }},
      {"DRIV", "a stiffness above 0",
       [](Records& r, Writer&) {
         r.robots[1].control = static_cast<std::uint32_t>(Control::kEeDeltaInterpolated);
         r.laws[0] = {};
         r.laws[0].arm_path = {1.5, 2, 50};
         r.laws[0].finger_path = {1, 2, 50};
       }},
      {"LAWS", "has 0 home positions", [](Records& r, Writer&) { r.laws[0].home = {}; }},
      {"GEAR", "the friction of a joint", [](Records& r, Writer&) { r.gears[0].friction = -1; }},
      {"GEAR", "an armature", [](Records& r, Writer&) { r.gears[1].armature = -1; }},
      {"ROBT", "a robot of 2 drives has 1 gears",
       [](Records& r, Writer&) { r.robots[1].gears.count = 1; }},
      {"FING", "length 1",
       [](Records& r, Writer&) {
         r.fingers[0].opens = {0, 0, 2};
       }},
      {"ROBT", "fill its record first", [](Records& r, Writer&) { r.robots[1].fingers[1] = {}; }},
      {"ROBT", "a finger that opens has a link",
       [](Records& r, Writer&) { r.robots[1].fingers[1].link = {}; }},
      {"FING", "belongs to no robot",
       [](Records& r, Writer&) { r.fingers.push_back(r.fingers[0]); }},
      {"ROBT", "must begin at 0, not 1",
       [](Records& r, Writer&) {
         r.fingers.push_back(r.fingers[0]);
         r.robots[1].more_fingers.first = 1;
       }},
      {"SCNE", "of air", [](Records& r, Writer&) { r.scenes[0].air_density = -1; }},
  };
}

}  // namespace probe::plan
