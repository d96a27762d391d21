// Whether the arm follows a way of the tool by small steps, as the controller will ask for it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/expert/path.h"
#include "runtime/robot/kinematics.h"

namespace probe::expert {

class Reach {
 public:
  // Reads the robot; the arm's joints are all that move between the root and the link, in that
  // order.
  static Result<Reach> create(const std::string& urdf_path, std::string_view tcp_link);

  const robot::Chain& chain() const { return chain_; }

  // Follows straight lines from the tool's pose at `q` through the poses, a solution every 5 cm or
  // 0.3 rad, each from the one before. The joint positions at each pose; nothing as soon as one
  // fails.
  std::optional<std::vector<JointVector>> follow(std::span<const double> q,
                                                 std::span<const Pose> way) const;

 private:
  explicit Reach(robot::Chain chain) : chain_(std::move(chain)) {}
  robot::Chain chain_;
};

}  // namespace probe::expert
