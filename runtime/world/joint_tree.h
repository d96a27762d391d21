// Kinematics and inertia of one joint tree: a robot, a cabinet. Given joint positions: poses of the
// links that move, joint columns, the mass matrix. Every substep reads the poses of links from
// here. Knows nothing of contacts, drives or time.
#pragma once

#include <memory>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/robot/urdf.h"
#include "runtime/world/multibody.h"
#include "runtime/world/state.h"

namespace probe::world {

// The link below a joint that moves, driven or mimicking; its frame is that of the joint's child
// link in the URDF.
struct MovingLink {
  int coordinate = 0;            // of the world: the joint position that moves it
  Mat3 axes = Mat3::Identity();  // world
  Vec3 origin = Vec3::Zero();    // world, m
  // What a unit speed of the coordinate adds to the motion of all that hangs on this link, world:
  // angular velocity (rad/s a unit), and the velocity (m/s a unit) of the point at
  // JointTree::reference().
  Vec3 w = Vec3::Zero(), v = Vec3::Zero();
};

class JointTree {
 public:
  // `joints`: indices into model.joints, in the order wanted for q. A joint that is not among them
  // must be fixed or mimic one that is. Fixed links are merged into the link they hang on.
  // `first`: the place of the first joint among the world's positions. Fails (kWorld) on
  // missing or surplus joints and impossible inertia.
  static Result<std::unique_ptr<JointTree>> create(const robot::RobotModel& model, const Pose& base,
                                                   const std::vector<int>& joints, int first = 0);

  // Recomputes everything unless its part of q (the world's positions) is that of the last call.
  void update(const JointArray& q);

  int first() const { return first_; }  // of its positions among the world's
  int count() const { return count_; }  // of its positions
  std::size_t link_count() const { return links_.size(); }
  const MovingLink& link(int moving) const { return links_[static_cast<std::size_t>(moving)]; }
  const std::vector<int>& outward() const { return outward_; }  // moving links, parents first
  int parent(int moving) const {                                // -1: the base
    return tree_[static_cast<std::size_t>(moving)].parent;
  }
  const Pose& base() const { return base_; }
  const Vec3& reference() const { return base_.position; }
  // Of its own positions, counted from 0: kg, kg m or kg m2 by the kinds of the two joints.
  const JointMatrix& mass() const { return mass_; }
  // What gravity (m/s2, world) and its own motion (Coriolis and centrifugal forces) do to each of
  // its positions at the world's speeds `u`: N or N m, from 0. After update().
  JointArray own_forces(const Vec3& gravity, const JointArray& u) const;
  const std::vector<TreeLink>& tree() const { return tree_; }

  // A joint that follows position `leader` (of this tree, from 0): scale x leader's + offset.
  struct Follower {
    int joint = 0, leader = 0;
    double scale = 1, offset = 0;
  };
  const std::vector<Follower>& followers() const { return followers_; }
  // By moving link: its joint and how it follows; scale 1, offset 0 for what follows nothing.
  const std::vector<Follower>& motions() const { return motions_; }

  // Where a URDF link hangs: on a moving link (or -1, the base), with a fixed pose.
  struct Carrier {
    int moving = -1;
    Pose offset;
  };
  const Carrier& carrier(int urdf_link) const {
    return carriers_[static_cast<std::size_t>(urdf_link)];
  }
  Pose pose(const Carrier& carrier) const;  // world
  // Moving links from the base to this one, itself included, one bit each; 0 for -1.
  std::uint32_t path(int moving) const {
    return moving < 0 ? 0 : paths_[static_cast<std::size_t>(moving)];
  }

 private:
  // Mass, first moment and inertia about the frame's origin, or about the reference.
  struct Lump {
    double mass = 0;
    Vec3 moment = Vec3::Zero();
    Mat3 inertia = Mat3::Zero();
    void add(const robot::Link& link, const Pose& offset);
    bool is_possible() const;  // some distribution of matter has it
  };

  JointTree() = default;
  Status read_tree(const robot::RobotModel& model, const std::vector<int>& joints);
  void place(const JointArray& q);
  void update_mass();

  int first_ = 0, count_ = 0;
  bool fresh_ = false;
  Pose base_;
  JointArray q_{};  // of the last update, from 0
  // By moving link.
  std::vector<MovingLink> links_;
  std::vector<Follower> motions_;
  std::vector<TreeLink> tree_;
  std::vector<JointFrame> frames_;
  std::vector<std::uint32_t> paths_;
  std::vector<Lump> lumps_, placed_, composites_;  // link frame; the last two about the reference

  std::vector<int> outward_;
  std::vector<Follower> followers_;
  JointMatrix mass_{};
  std::vector<Carrier> carriers_;
};

}  // namespace probe::world
