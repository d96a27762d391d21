// A table without physics: the arm's joints approach their targets as the real drives do, the
// source sticks to the fingers while both touch it, and what is let go drops onto what is below.
// Enough to test the expert's plan and servo.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "runtime/expert/footprint.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/control.h"
#include "runtime/robot/rotation.h"
#include "tests/runtime/expert/expert_robot.h"

namespace probe::expert::test {

inline const char* const kUrdf = VLAPROBE_SOURCE_DIR "/assets/robots/widowx/wx250s.urdf";
inline const std::vector<std::string> kArm = {"waist",        "shoulder",    "elbow",
                                              "forearm_roll", "wrist_angle", "wrist_rotate"};
inline constexpr double kSurface = 0.87;

inline std::vector<Vec3> block(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> out;
  for (int i = 0; i < 8; ++i) {
    out.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                     i & 4 ? high.z() : low.z());
  }
  return out;
}

inline policy::PrivilegedObject object(const std::string& name,
                                       std::vector<std::vector<Vec3>> parts, const Vec3& position,
                                       double yaw_deg) {
  policy::PrivilegedObject out;
  out.name = name;
  out.finger_contact.assign(2, false);
  out.parts = std::move(parts);
  out.pose = {position, robot::from_rotation_vector({0, 0, yaw_deg * 3.14159265358979 / 180})};
  return out;
}

// About the size of the suite's carrot: thick and thin end.
inline policy::PrivilegedObject carrot(double x, double y, double yaw_deg) {
  return object("carrot",
                {block({-0.06, -0.010, -0.012}, {0, 0.010, 0.012}),
                 block({0, -0.016, -0.012}, {0.05, 0.016, 0.020})},
                {x, y, kSurface + 0.012}, yaw_deg);
}
inline policy::PrivilegedObject plate(double x, double y) {
  return object("plate", {block({-0.055, -0.055, 0}, {0.055, 0.055, 0.006})}, {x, y, kSurface}, 0);
}

class FakeTable {
 public:
  FakeTable(policy::PrivilegedObject source, policy::PrivilegedObject target,
            std::vector<policy::PrivilegedObject> others = {})
      : controller_(make_controller()) {
    view_.objects.push_back(std::move(source));
    view_.objects.push_back(std::move(target));
    for (auto& other : others) view_.objects.push_back(std::move(other));
    view_.base = {Vec3(0.147, 0.028, 0.870), Quat(0, 0, 0, 1)};
    view_.surface_z = kSurface;
    q_ = {-0.01840777, 0.0398835, 0.22242722, -0.00460194, 1.36524296, 0.00153398, 0.037, 0.037};
    controller_.reset(q_);
  }

  policy::EpisodeStart start() const {
    policy::EpisodeStart out;
    out.task = "fake";
    out.horizon = 60;
    out.robot = &widowx();
    return out;
  }

  policy::Observation observe(int step) const {
    policy::Observation out;
    out.proprioception = {controller_.tcp_pose(q_), controller_.openness(q_), q_};
    out.privileged = &view_;
    out.step = step;
    out.horizon = 60;
    return out;
  }

  Status apply(const policy::Action& action) {
    const Pose tcp_before = tcp_in_world();
    PROBE_ASSIGN(const std::span<const double> targets, controller_.targets(action.tool(), q_));
    // exp(-0.2 s stiffness / damping) of the benchmark's drives.
    constexpr std::array<double, 6> kLeft = {0.49, 0.44, 0.35, 0.45, 0.28, 0.46};
    for (std::size_t j = 0; j < 6; ++j) q_[j] = targets[j] + kLeft[j] * (q_[j] - targets[j]);
    if (held_) source().pose = tcp_in_world() * (tcp_before.inverse() * source().pose);
    move_fingers(targets[6]);
    if (!held_) drop();
    return {};
  }

  // The next grasp slips out once lifted.
  void lose_next_grasp() { slips_ = true; }

  void set_goal(policy::Goal goal) { view_.goal = goal; }
  policy::Privileged& view() { return view_; }

  policy::PrivilegedObject& source() { return view_.objects[0]; }
  policy::PrivilegedObject& target() { return view_.objects[1]; }
  bool held() const { return held_; }
  bool was_held() const { return was_held_; }
  Pose tcp_in_world() const { return view_.base * controller_.tcp_pose(q_); }
  double openness() const { return controller_.openness(q_); }
  double lowest_tip() const { return lowest_tip_; }

  bool source_on_target() {
    const Vec3 apart = source().pose.position - target().pose.position;
    return apart.head<2>().norm() < 0.0778 + 0.003 && bottom(source()) > kSurface + 0.005 && !held_;
  }

 private:
  static robot::EeDeltaPoseController make_controller() {
    auto made = robot::EeDeltaPoseController::create(*widowx().model, widowx().control);
    REQUIRE(made.ok());
    return std::move(made).value();
  }

  static double bottom(const policy::PrivilegedObject& o) {
    return footprint_of(o.parts, o.pose).bottom;
  }

  // Half the width of the source between the fingers, 0 if it is not between them.
  double between() {
    const Footprint print = footprint_of(source().parts, tcp_in_world().inverse() * source().pose);
    // In the tool frame z is across and y is the closing direction; the outline is of x and y
    // there.
    if (print.bottom > 0.012 || print.top < -0.012) return 0;
    double low = 1, high = -1, deep = -1;
    for (const auto& part : print.parts) {
      for (const Vec2& p : part) {
        low = std::min(low, p.y());
        high = std::max(high, p.y());
        deep = std::max(deep, p.x());
      }
    }
    if (deep < -0.010 || low > 0.026 || high < -0.026) return 0;
    return 0.5 * (high - low);
  }

  void move_fingers(double target) {
    lowest_tip_ = std::min(lowest_tip_, tcp_in_world().position.z() - 0.0156);
    const double inner = 0.0097;
    const double stop = between();
    double next = target + 0.37 * (q_[6] - target);
    next = std::clamp(next, 0.015, 0.037);
    const bool touch = stop > 0 && stop < 0.027 && next <= stop + inner;
    if (touch) next = stop + inner;
    q_[6] = q_[7] = next;
    source().finger_contact.assign(2, touch);
    held_ = touch;
    was_held_ = was_held_ || touch;
    if (held_ && slips_ && bottom(source()) > kSurface + 0.02) {
      slips_ = held_ = false;
      source().finger_contact.assign(2, false);
    }
  }

  void drop() {
    const Vec3 apart = source().pose.position - target().pose.position;
    const double floor = apart.head<2>().norm() < 0.06 ? kSurface + 0.006 : kSurface;
    source().pose.position.z() += floor - bottom(source());
  }

  robot::EeDeltaPoseController controller_;
  policy::Privileged view_;
  std::vector<double> q_;
  bool held_ = false, was_held_ = false, slips_ = false;
  double lowest_tip_ = 10;
};

}  // namespace probe::expert::test
