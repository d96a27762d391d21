// Kinematics and inertia of the robot by Simbody: the only adapter of it. Given joint positions:
// poses of moving links, joint columns and the mass matrix. Knows nothing of contacts, drives or
// time.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/robot/urdf.h"
#include "runtime/world/state.h"

namespace probe::world {

// Of the moving link that joint j drives; the link's frame is that of the joint's child link in the
// URDF.
struct MovingLink {
  Mat3 axes = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
  Vec3 w = Vec3::Zero(),
       h = Vec3::Zero();  // joint column: angular, and linear at the origin, world
};

class ArmDynamics {
 public:
  // `joints`: indices into model.joints; they must be all joints that move, in the order wanted for
  // q. Fixed links are merged into the link they hang on. Fails (code "world") on missing or
  // surplus joints and impossible inertia.
  static Result<std::unique_ptr<ArmDynamics>> create(const robot::RobotModel& model,
                                                     const Pose& base,
                                                     const std::vector<int>& joints);
  ~ArmDynamics();

  // Recomputes everything unless q is that of the last call.
  Status update(const JointArray& q);
  void forget() { fresh_ = false; }

  int count() const { return count_; }
  const MovingLink& link(int joint) const { return links_[static_cast<std::size_t>(joint)]; }
  const JointMatrix& mass() const { return mass_; }

  // Where a URDF link hangs: on the moving link of a joint (or -1, the base), with a fixed pose.
  struct Carrier {
    int joint = -1;
    Pose offset;
  };
  const Carrier& carrier(int urdf_link) const {
    return carriers_[static_cast<std::size_t>(urdf_link)];
  }
  Pose pose(const Carrier& carrier) const;  // world
  std::uint32_t path(
      int joint) const {  // joints from the base to the link, itself included; 0 for -1
    return joint < 0 ? 0 : paths_[static_cast<std::size_t>(joint)];
  }

 private:
  ArmDynamics();
  struct Simbody;
  std::unique_ptr<Simbody> simbody_;
  int count_ = 0;
  bool fresh_ = false;
  Pose base_;
  JointArray q_{};
  std::array<MovingLink, kMaxJoints> links_;
  std::array<std::uint32_t, kMaxJoints> paths_{};
  JointMatrix mass_{};
  std::vector<Carrier> carriers_;
};

}  // namespace probe::world
