// The robot of examples/my_robot.probe, which is not among the assets: its description, and an
// assets folder that has it beside ours.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace probe::stage {

inline std::string gantry_urdf() {
  const auto link = [](const std::string& name, const std::string& shapes) {
    return "<link name='" + name +
           "'><inertial><mass value='1'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' "
           "ixz='0' iyz='0'/></inertial>" +
           shapes + "</link>";
  };
  const auto box = [](const std::string& xyz, const std::string& size) {
    return "<collision><origin xyz='" + xyz + "'/><geometry><box size='" + size +
           "'/></geometry></collision><visual><origin xyz='" + xyz + "'/><geometry><box size='" +
           size + "'/></geometry></visual>";
  };
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& xyz, const std::string& axis,
                        const std::string& lower, const std::string& upper) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='" + xyz + "'/><axis xyz='" + axis +
           "'/><limit lower='" + lower + "' upper='" + upper +
           "' effort='300' velocity='2'/></joint>";
  };
  return "<?xml version='1.0'?><robot name='gantry'>" + link("frame", "") + link("bridge", "") +
         link("carriage", "") + link("ram", "") + link("turret", "") + link("knuckle", "") +
         link("hand", box("0 0 -0.02", "0.05 0.11 0.04")) + link("tool", "") +
         link("left_finger", box("0 0.004 -0.03", "0.016 0.008 0.06")) +
         link("right_finger", box("0 -0.004 -0.03", "0.016 0.008 0.06")) +
         joint("slide_x", "prismatic", "frame", "bridge", "0 0 0", "1 0 0", "0", "0.9") +
         joint("slide_y", "prismatic", "bridge", "carriage", "0 0 0", "0 1 0", "-0.4", "0.4") +
         joint("slide_z", "prismatic", "carriage", "ram", "0 0 0", "0 0 1", "0.02", "0.7") +
         joint("yaw", "revolute", "ram", "turret", "0 0 0", "0 0 1", "-3.1", "3.1") +
         joint("pitch", "revolute", "turret", "knuckle", "0 0 0", "0 1 0", "-1.2", "1.2") +
         joint("roll", "revolute", "knuckle", "hand", "0 0 0", "1 0 0", "-1.2", "1.2") +
         joint("tool_mount", "fixed", "hand", "tool", "0 0 -0.09' rpy='3.141592653589793 0 0",
               "0 0 1", "0", "0") +
         joint("left", "prismatic", "hand", "left_finger", "0 0 -0.04", "0 1 0", "0", "0.04") +
         joint("right", "prismatic", "hand", "right_finger", "0 0 -0.04", "0 -1 0", "0", "0.04") +
         "</robot>";
}

// What there is, and a folder of one's own.
class OwnAssets {
 public:
  OwnAssets() {
    namespace fs = std::filesystem;
    folder_ = fs::temp_directory_path() / ("probe_own_robot_" + std::to_string(getpid()));
    const fs::path shipped = VLAPROBE_SOURCE_DIR "/assets";
    fs::create_directories(folder_ / "robots/mine");
    // Copies: links that lead out of the folder are refused.
    fs::copy(shipped, folder_, fs::copy_options::recursive);
    std::ofstream(folder_ / "robots/mine/gantry.urdf", std::ios::binary) << gantry_urdf();
  }
  ~OwnAssets() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  OwnAssets(const OwnAssets&) = delete;
  OwnAssets& operator=(const OwnAssets&) = delete;
  std::string folder() const { return folder_.string(); }

 private:
  std::filesystem::path folder_;
};

}  // namespace probe::stage
