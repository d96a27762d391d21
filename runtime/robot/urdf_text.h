// What urdfdom does not keep of a URDF text: the order of links and joints, angles as written
// (urdfdom turns them into quaternions with the C library's sines), and which limits were given.
// Also finds what is wrong with the tree itself, in words that name it. Knows nothing of masses and
// meshes.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"

namespace probe::robot {

struct LinkText {
  std::string name;
  Quat inertial = Quat::Identity();  // rotation of each origin element
  std::vector<Quat> visuals, collisions;
};

struct JointText {
  std::string name, parent, child;
  Quat origin = Quat::Identity();
};

struct UrdfText {
  std::vector<LinkText> links;
  std::vector<JointText> joints;
  int root = 0;  // index into links
};

// `path` is only named in failures. The links form one tree afterwards.
Result<UrdfText> scan_urdf(const std::string& text, const std::string& path);

}  // namespace probe::robot
