// Forward kinematics of any joint tree and of a chain from the root to one link. Joint positions
// are in the order of the joint names given at creation (rad, m); poses are in the root link's
// frame. Nothing here allocates after creation, and nothing knows of drives, masses or time.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/robot/urdf.h"

namespace probe::robot {

inline constexpr int kMaxChainJoints = 16;

// Rows: linear velocity (3) of the link's origin, angular velocity (3), both in the root's axes.
// One column a joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxChainJoints>;

// All links at once.
class Tree {
 public:
  // A joint that is not named follows the joint it mimics, or stands still at the position nearest
  // 0 within its limits. Fails (kUrdf) on a name that is not there, is fixed, or comes twice.
  static Result<Tree> create(const RobotModel& model, std::span<const std::string> joints);

  std::size_t joint_count() const { return joints_; }
  std::size_t link_count() const { return steps_.size() + 1; }

  // poses[i] is that of model.links[i]; q and poses have joint_count() and link_count() elements.
  void link_poses(std::span<const double> q, std::span<Pose> poses) const;

  // At the origin of a link, from the poses of link_poses(). `out` has 6 rows and joint_count()
  // columns.
  void jacobian(std::span<const Pose> poses, int link, Eigen::Ref<Eigen::MatrixXd> out) const;

 private:
  // One joint and the link below it, parents before children.
  struct Step {
    int parent = 0, link = 0;
    JointKind kind = JointKind::kFixed;
    Pose origin;
    Vec3 axis;
    int source = -1;  // index into q, -1 still
    double scale = 0, offset = 0;
  };
  std::size_t joints_ = 0;
  int root_ = 0;
  std::vector<Step> steps_;
  std::vector<int> step_of_link_;  // -1 for the root
};

// The joints between the root and one link, fixed ones folded away.
class Chain {
 public:
  // Fails (kUrdf) if the link is not there, a joint on the way moves and is not named (a
  // mimic of a named one is fine), a name is not on the way, or there are more than
  // kMaxChainJoints. The chain ends in a frame turned by `tip` against the link's.
  static Result<Chain> create(const RobotModel& model, std::string_view link,
                              std::span<const std::string> joints,
                              const Quat& tip = Quat::Identity());

  std::size_t joint_count() const { return lower_.size(); }
  std::span<const double> lower() const { return lower_; }  // -1e9 for continuous joints
  std::span<const double> upper() const { return upper_; }  // +1e9

  Pose pose(std::span<const double> q) const;
  // Both at once; `out` is resized within its own storage.
  Pose pose(std::span<const double> q, Jacobian& out) const;

 private:
  struct Segment {
    Mat3 turn;  // from the previous segment's frame, fixed joints included
    Vec3 shift;
    JointKind kind;
    Vec3 axis;
    int source;
    double scale, offset;
  };
  std::vector<Segment> segments_;
  Mat3 last_turn_ = Mat3::Identity();  // from the last moving frame to the link
  Vec3 last_shift_ = Vec3::Zero();
  std::vector<double> lower_, upper_;
};

}  // namespace probe::robot
