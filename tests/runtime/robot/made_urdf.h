// Robot descriptions that tests write themselves: links, joints, a drawer, and a text as a model.
#pragma once

#include <string>

#include "tests/runtime/robot/test_robots.h"

namespace probe::robot::test {

inline RobotModel load_text(const std::string& text) {
  const TextFile file(text);
  auto model = load_urdf(file.path());
  REQUIRE_MESSAGE(model.ok(), (model.ok() ? "" : to_text(model.failure())));
  return std::move(model).value();
}

// kg; 0.004 kg m2 about each axis.
inline std::string link_text(const std::string& name, double mass,
                             const std::string& center = "0 0 0") {
  return "<link name='" + name + "'><inertial><origin xyz='" + center + "'/><mass value='" +
         std::to_string(mass) +
         "'/><inertia ixx='0.004' iyy='0.004' izz='0.004' ixy='0' ixz='0' iyz='0'/></inertial>"
         "</link>";
}

inline std::string joint_text(const std::string& name, const std::string& type,
                              const std::string& parent, const std::string& child,
                              const std::string& axis, const std::string& xyz = "0 0 0",
                              double lower = 0, double upper = 0.2) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + xyz + "'/><axis xyz='" + axis +
         "'/><limit lower='" + std::to_string(lower) + "' upper='" + std::to_string(upper) +
         "' effort='1' velocity='1'/></joint>";
}

// A drawer of 2 kg that slides along x by 0.2 m.
inline std::string drawer_text() {
  return "<robot name='cabinet'>" + link_text("frame", 10) + link_text("drawer", 2) +
         joint_text("slide", "prismatic", "frame", "drawer", "1 0 0") + "</robot>";
}

}  // namespace probe::robot::test
