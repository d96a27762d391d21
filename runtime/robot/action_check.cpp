#include "runtime/robot/action_check.h"

#include <cmath>

#include <fmt/format.h>

#include "runtime/robot/action.h"

namespace probe::robot {

Status check_numbers(std::span<const double> action, SaysWanted wanted) {
  for (std::size_t i = 0; i < action.size(); ++i) {
    if (std::isfinite(action[i]) && std::abs(action[i]) <= kAbsurdAction) continue;
    return Failure{
        Fault::kPolicy,
        fmt::format("action[{}] is {}, wanted {}", i, action[i], wanted(i, action.size())), ""};
  }
  return {};
}

Status check_tool_action(std::span<const double> action) {
  return check_numbers(action, [](std::size_t i, std::size_t /*size*/) -> std::string_view {
    if (i < kActionTurn) return "a shift in metres";
    return i < kActionGripper ? "a rotation vector in radians" : "the gripper from -1 to 1";
  });
}

}  // namespace probe::robot
