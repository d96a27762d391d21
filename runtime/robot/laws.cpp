#include "runtime/robot/laws.h"

namespace probe::robot {
namespace {

constexpr KindRow kKinds[] = {
    {ControlKind::kEeDeltaPose, "ee_delta_pose", ActionLayout::kShiftTurn, 7, false,
     Reads::kPositions},
    {ControlKind::kOscPose, "osc_pose", ActionLayout::kShares, 7, false, Reads::kDynamics},
    {ControlKind::kJointDelta, "joint_delta", ActionLayout::kJointSteps, 1, true,
     Reads::kPositions},
    {ControlKind::kJointPosition, "joint_position", ActionLayout::kJoints, 1, true,
     Reads::kPositions},
    {ControlKind::kEeDeltaInterpolated, "ee_delta_interpolated", ActionLayout::kShiftTurn, 7, false,
     Reads::kStates},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < std::size(kKinds); ++i) {
    if (static_cast<std::size_t>(kKinds[i].kind) != i) return false;
  }
  return std::size(kKinds) == std::variant_size_v<Law>;
}
static_assert(in_order(), "a row for each alternative of Law, in its order");

}  // namespace

std::span<const KindRow> control_kinds() { return kKinds; }

const KindRow& row_of(const Law& law) { return kKinds[law.index()]; }

const KindRow* find_kind(std::string_view word) {
  for (const KindRow& row : kKinds) {
    if (row.word == word) return &row;
  }
  return nullptr;
}

std::string known_kinds() {
  std::string all;
  for (const KindRow& row : kKinds) {
    if (!all.empty()) all += ", ";
    all += '`';
    all += row.word;
    all += '`';
  }
  return all;
}

}  // namespace probe::robot
