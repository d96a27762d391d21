// Kinematics of the robot by Simbody (its only adapter) and its mass matrix. Given joint positions:
// poses of moving links, joint columns, inertia. Knows nothing of contacts, drives or time.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/robot/urdf.h"
#include "runtime/world/state.h"

namespace probe::world {

// The link below a joint that moves, driven or mimicking; its frame is that of the joint's child
// link in the URDF.
struct MovingLink {
  int coordinate = 0;  // the driven joint whose position moves it
  Mat3 axes = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
  // What a unit speed of the coordinate adds to the motion of all that hangs on this link: angular
  // velocity, and the velocity of the point at ArmDynamics::reference(), world.
  Vec3 w = Vec3::Zero(), v = Vec3::Zero();
};

// How the multibody library at hand was compiled, and how the one file was that includes it. Its
// inline classes have another layout without assertions, so both must agree.
struct MultibodyBuild {
  std::string version;
  bool library_asserts = true, adapter_asserts = true;
};
MultibodyBuild multibody_build();
// Fails (kWorld) if they differ; each robot that is made checks it.
Status check_layout(const MultibodyBuild& build);

class ArmDynamics {
 public:
  // `joints`: indices into model.joints, in the order wanted for q. A joint that is not among them
  // must be fixed or mimic one that is. Fixed links are merged into the link they hang on. Fails
  // (kWorld) on missing or surplus joints and impossible inertia.
  static Result<std::unique_ptr<ArmDynamics>> create(const robot::RobotModel& model,
                                                     const Pose& base,
                                                     const std::vector<int>& joints);
  ~ArmDynamics();

  // Recomputes everything unless q is that of the last call.
  Status update(const JointArray& q);

  int count() const { return count_; }  // of joint positions
  std::size_t link_count() const { return links_.size(); }
  const MovingLink& link(int moving) const { return links_[static_cast<std::size_t>(moving)]; }
  const std::vector<int>& outward() const { return outward_; }  // moving links, parents first
  int parent(int moving) const { return parents_[static_cast<std::size_t>(moving)]; }  // -1: base
  const Vec3& reference() const { return base_.position; }
  const JointMatrix& mass() const { return mass_; }
  // The same by the multibody library's own algorithm: slow, for tests.
  JointMatrix library_mass() const;

  // A joint that follows coordinate `leader`: position scale x leader's + offset.
  struct Follower {
    int joint = 0, leader = 0;
    double scale = 1, offset = 0;
  };
  const std::vector<Follower>& followers() const { return followers_; }

  // Where a URDF link hangs: on a moving link (or -1, the base), with a fixed pose.
  struct Carrier {
    int moving = -1;
    Pose offset;
  };
  const Carrier& carrier(int urdf_link) const {
    return carriers_[static_cast<std::size_t>(urdf_link)];
  }
  Pose pose(const Carrier& carrier) const;  // world
  // Moving links from the base to this one, itself included; 0 for -1.
  std::uint32_t path(int moving) const {
    return moving < 0 ? 0 : paths_[static_cast<std::size_t>(moving)];
  }

 private:
  // Mass, first moment and inertia about the frame's origin.
  struct Lump {
    double mass = 0;
    Vec3 moment = Vec3::Zero();
    Mat3 inertia = Mat3::Zero();
    void add(const robot::Link& link, const Pose& offset);
    bool is_possible() const;  // some distribution of matter has it
  };

  ArmDynamics();
  Status read_tree(const robot::RobotModel& model, const std::vector<int>& joints);
  Status assemble(const robot::RobotModel& model);
  void update_mass();

  struct Simbody;
  std::unique_ptr<Simbody> simbody_;
  int count_ = 0;
  bool fresh_ = false;
  Pose base_;
  JointArray q_{};
  // By moving link.
  std::vector<MovingLink> links_;
  std::vector<Follower> motions_;  // its joint, the coordinate and how it follows
  std::vector<bool> slides_;
  std::vector<Vec3> axes_;     // of the joint, link frame
  std::vector<Pose> inboard_;  // the joint's frame in the parent (world, if that is the base)
  std::vector<int> parents_;
  std::vector<std::uint32_t> paths_;
  std::vector<Lump> lumps_, composites_;

  std::vector<int> outward_;
  std::vector<Follower> followers_;
  JointMatrix mass_{};
  std::vector<Carrier> carriers_;
};

}  // namespace probe::world
