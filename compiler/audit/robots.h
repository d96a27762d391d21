// What a suite asks of each robot that it has: how it is driven and grips, whether it gets to where
// things begin, and what of it is varied. Facts for whoever reads a result as one about a robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/plan/plan.h"

namespace probe::audit {

struct RobotFacts {
  std::string name;
  std::string law;  // "ee_delta_pose"
  double control_hz = 0;
  std::size_t fingers = 0;
  double grip_closed = 0, grip_open = 0;  // of the finger joints, m or rad
  // As declared, m from the base along the ground; none: nothing is said. What begins outside is
  // refused (P0502).
  struct Reach {
    double near = 0, far = 0;
  };
  std::optional<Reach> reach;
  double nearest = 0, farthest = 0;  // of the objects in these starts, measured as the reach is
  std::size_t tasks = 0, starts = 0;
  // Comparisons of its tasks that move one of the axes robot, sensor and latency: how many.
  std::map<std::string, std::size_t> axes;
};

// In the order of the plan; robots of none of these tasks are left out.
std::vector<RobotFacts> robots_of(const plan::Plan& plan, std::span<const std::uint32_t> tasks);

// A sentence: "robot `widowx`: ee_delta_pose at 5 Hz, 2 fingers (joint at 0.014 closed, 0.038
// open); 1224 starts of 51 tasks, objects 26cm to 57cm from its base, all within its reach of 12cm
// to 62cm; no comparison moves ...".
std::string to_text(const RobotFacts& robot);

}  // namespace probe::audit
