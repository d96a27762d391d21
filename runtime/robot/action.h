// What a controller is asked for in a control step, as plain numbers: as many as the robot's law
// says (laws.h), the gripper's last. Policies, servers and traces share it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>

#include "runtime/base/check.h"
#include "runtime/robot/kinematics.h"

namespace probe::robot {

// Of a law that moves the tool: [dx dy dz, rotation vector (3), gripper], end-effector delta in the
// robot base frame, m and rad; gripper -1 closed .. +1 open, absolute.
inline constexpr std::size_t kActionShift = 0;
inline constexpr std::size_t kActionTurn = 3;
inline constexpr std::size_t kActionGripper = 6;
inline constexpr std::size_t kActionSize = 7;
using ToolAction = std::array<double, kActionSize>;

// Metres, radians, shares: nothing a policy means is as large. Catches pixels, millimetres and
// broken weights early.
inline constexpr double kAbsurdAction = 1e3;
// A number for each joint of the longest arm, and the gripper's.
inline constexpr std::size_t kMostActionNumbers = kMaxChainJoints + 1;

// A value: copied, compared and iterated like an array, of a size that is known as it is made.
class Action {
 public:
  constexpr Action() = default;  // of no numbers
  constexpr Action(std::initializer_list<double> numbers)
      : Action(std::span<const double>(numbers.begin(), numbers.size())) {}
  constexpr Action(const ToolAction& tool) : Action(std::span<const double>(tool)) {}
  // At most kMostActionNumbers.
  constexpr explicit Action(std::span<const double> numbers) : size_(numbers.size()) {
    PROBE_CHECK(size_ <= kMostActionNumbers, "an action has a number a joint and one more");
    std::copy(numbers.begin(), numbers.end(), numbers_.begin());
  }
  static constexpr Action zeros(std::size_t size) {
    PROBE_CHECK(size <= kMostActionNumbers, "an action has a number a joint and one more");
    Action made;
    made.size_ = size;
    return made;
  }

  constexpr std::size_t size() const { return size_; }
  constexpr double* data() { return numbers_.data(); }
  constexpr const double* data() const { return numbers_.data(); }
  constexpr double* begin() { return data(); }
  constexpr double* end() { return data() + size_; }
  constexpr const double* begin() const { return data(); }
  constexpr const double* end() const { return data() + size_; }
  constexpr double& operator[](std::size_t i) { return numbers_[i]; }
  constexpr double operator[](std::size_t i) const { return numbers_[i]; }

  // As a tool's, which it must be.
  ToolAction tool() const {
    PROBE_CHECK(size_ == kActionSize, "a tool's action has seven numbers");
    ToolAction made{};
    std::copy(begin(), end(), made.begin());
    return made;
  }

  // The last number; the others move the arm. Of an action that has any.
  constexpr double& gripper() { return numbers_[size_ - 1]; }
  constexpr double gripper() const { return numbers_[size_ - 1]; }
  constexpr std::span<double> arm() { return {data(), size_ - 1}; }
  constexpr std::span<const double> arm() const { return {data(), size_ - 1}; }

  friend constexpr bool operator==(const Action& a, const Action& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::array<double, kMostActionNumbers> numbers_{};
  std::size_t size_ = 0;
};

}  // namespace probe::robot
