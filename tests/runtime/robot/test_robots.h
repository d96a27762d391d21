// Robots the tests of this folder share: our WidowX, and texts written to a file that goes away
// again.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "runtime/robot/urdf.h"

namespace probe::robot::test {

inline const std::vector<std::string> kArm = {"waist",        "shoulder",    "elbow",
                                              "forearm_roll", "wrist_angle", "wrist_rotate"};
inline const std::vector<std::string> kFingers = {"left_finger", "right_finger"};
// bridge_setup: initial joints of the table scene.
inline const std::vector<double> kTableStart = {-0.01840777, 0.0398835,  0.22242722, -0.00460194,
                                                1.36524296,  0.00153398, 0.037,      0.037};

inline RobotModel widowx() {
  auto loaded = load_urdf(VLAPROBE_SOURCE_DIR "/assets/robots/widowx/wx250s.urdf");
  REQUIRE_MESSAGE(loaded.ok(), (loaded.ok() ? std::string() : to_text(loaded.failure())));
  return std::move(loaded).value();
}

class TextFile {
 public:
  explicit TextFile(const std::string& text) {
    char name[] = "/tmp/probe_urdf_XXXXXX";
    const int fd = mkstemp(name);
    REQUIRE(fd >= 0);
    close(fd);
    path_ = name;
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TextFile() { std::remove(path_.c_str()); }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Seven turning joints as a Panda has them (Denavit-Hartenberg offsets), the first continuous, and
// two fingers of which the second mimics the first.
inline std::string panda_like() {
  const char* inertial =
      "<inertial><mass value='1'/><inertia ixx='.01' iyy='.01' izz='.01' ixy='0' ixz='0' "
      "iyz='0'/></inertial>";
  std::string text = "<robot name='panda_like'>\n<link name='link0'/>\n";
  const char* origins[] = {"xyz='0 0 .333'",
                           "rpy='-1.5707963267948966 0 0'",
                           "xyz='0 -.316 0' rpy='1.5707963267948966 0 0'",
                           "xyz='.0825 0 0' rpy='1.5707963267948966 0 0'",
                           "xyz='-.0825 .384 0' rpy='-1.5707963267948966 0 0'",
                           "rpy='1.5707963267948966 0 0'",
                           "xyz='.088 0 0' rpy='1.5707963267948966 0 0'"};
  for (int i = 1; i <= 7; ++i) {
    const std::string n = std::to_string(i), before = std::to_string(i - 1);
    text +=
        "<link name='link" + n + "'>" + inertial + "</link>\n<joint name='joint" + n + "' type='" +
        (i == 1 ? "continuous" : "revolute") + "'><origin " + origins[i - 1] +
        "/><parent link='link" + before + "'/><child link='link" + n + "'/><axis xyz='0 0 1'/>" +
        (i == 1 ? "" : "<limit lower='-2.9' upper='2.9' effort='87' velocity='2'/>") + "</joint>\n";
  }
  text += std::string(
              "<link name='hand'/><joint name='hand_joint' type='fixed'>"
              "<origin xyz='0 0 .107' rpy='0 0 -.7853981633974483'/><parent link='link7'/>"
              "<child link='hand'/></joint>\n") +
          "<link name='left'>" + inertial + "</link><link name='right'>" + inertial +
          "</link>\n"
          "<joint name='finger1' type='prismatic'><origin xyz='0 0 .0584'/><parent link='hand'/>"
          "<child link='left'/><axis xyz='0 1 0'/><limit lower='0' upper='.04' effort='20' "
          "velocity='.2'/></joint>\n"
          "<joint name='finger2' type='prismatic'><origin xyz='0 0 .0584'/><parent link='hand'/>"
          "<child link='right'/><axis xyz='0 -1 0'/><limit lower='0' upper='.04' effort='20' "
          "velocity='.2'/><mimic joint='finger1'/></joint>\n</robot>\n";
  return text;
}

}  // namespace probe::robot::test
