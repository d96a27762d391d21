// Limits of joints without end, as wheels have them, which urdfdom does not read.
#pragma once

#include <string>

#include "runtime/base/result.h"

namespace probe::robot {

// A URDF's text for urdfdom: a revolute joint from `-inf` to `inf` is continuous in it, what is
// fixed or continuous has no such limits. Others are refused by the joint's name and their line.
// `path` is only named. After scan_urdf().
Result<std::string> without_infinite_limits(const std::string& text, const std::string& path);

}  // namespace probe::robot
