// A robot's controller, whatever its law: created from data, asked by whoever steps the world.
// What differs between the kinds is in laws.h's table.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "runtime/robot/control.h"
#include "runtime/robot/interpolated.h"
#include "runtime/robot/joint_control.h"
#include "runtime/robot/laws.h"
#include "runtime/robot/osc.h"

namespace probe::robot {

class Controller {
 public:
  // Copies what it needs; the model may go. Fails (kUrdf) as the law's own controller does.
  static Result<Controller> create(const RobotModel& model, const EeControlSpec& spec,
                                   const Law& law);

  const KindRow& kind() const { return *row_; }
  std::size_t action_size() const { return row_->action_size(chain_.joint_count()); }
  std::size_t joint_count() const { return joints_; }
  std::size_t arm_joint_count() const { return chain_.joint_count(); }
  const std::string& tcp_link() const { return tcp_link_; }

  // A new episode at the joint positions q (drive order).
  void reset(std::span<const double> q);

  // A control step of `substeps` begins. `measured_u`: speeds in drive order, for laws that read
  // states; others take none. Fails (kPolicy) on an action of another size than action_size() and
  // on numbers that mean nothing; nothing has changed then.
  Status begin(std::span<const double> action, std::span<const double> measured_q,
               std::span<const double> measured_u, int substeps);
  // Of a law that reads states, before each substep: targets() and target_speeds() go on.
  void next();
  // Of a law that gives targets of the drives, from begin() on. Lives until the next.
  std::span<const double> targets() const;
  // At what speeds they are to be there: of a law that says so, else none, and drives brake.
  std::span<const double> target_speeds() const;
  // Of a law that reads dynamics: the arm's positions at which, and at rest, it believes the robot
  // in the next substep; empty: where it is. See osc.h.
  std::span<const double> believed() const;
  // Before each substep, an effort a joint.
  void efforts(const Dynamics& now, std::span<double> out);

  ControlState save() const;
  // Goes on from there, no reset() needed. Fails (kPolicy) on the state of a robot with other
  // joints or of another law.
  Status restore(const ControlState& state);

  Pose tcp_pose(std::span<const double> q) const;    // of the tcp link in the root link's frame
  double openness(std::span<const double> q) const;  // 0 closed .. 1 open

  const EeDeltaPoseController* ee_delta_pose() const {
    return std::get_if<EeDeltaPoseController>(&law_);
  }

 private:
  using Any = std::variant<EeDeltaPoseController, OscPoseController, JointController,
                           InterpolatedController>;
  Controller(const KindRow& row, Chain chain, Any law)
      : row_(&row), chain_(std::move(chain)), law_(std::move(law)) {}

  const KindRow* row_;
  Chain chain_;
  Any law_;
  FingerRange range_;
  std::size_t joints_ = 0;
  std::string tcp_link_;
};

}  // namespace probe::robot
