// The multibody library's model of one joint tree (its only adapter): made when a tree is loaded,
// to refuse what it refuses and to place the joints' frames, and asked in tests for its own poses
// and mass matrix. Nothing of it runs in a substep. Valid C++17, see README.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"

namespace probe::world {

// One link that moves, and all that is fixed to it. SI; the frame is the URDF link's.
struct TreeLink {
  int parent = -1;  // into the tree, before this one or not; -1: the world
  bool slides = false;
  Vec3 axis = Vec3::UnitX();    // of the joint, link frame, unit
  Pose inboard;                 // the joint's frame at position 0, in the parent's frame
  double mass = 0;              // kg
  Vec3 moment = Vec3::Zero();   // mass x centre of mass, kg m
  Mat3 inertia = Mat3::Zero();  // about the frame's origin, kg m2
};

// Where a joint sits, as fixed matrices: its axis is z of the turned frame where it turns, x where
// it slides. Pose of the link in its parent = (in_parent, origin) * motion(q) * (outboard, 0).
struct JointFrame {
  Mat3 in_parent = Mat3::Identity();
  Vec3 origin = Vec3::Zero();  // m
  Mat3 outboard = Mat3::Identity();
};

// How the library at hand was compiled, and how the one file was that includes it. Its inline
// classes have another layout without assertions, so both must agree.
struct MultibodyBuild {
  std::string version;
  bool library_asserts = true, adapter_asserts = true;
};
MultibodyBuild multibody_build();
// Fails (kWorld) if they differ; each tree that is made checks it.
Status check_layout(const MultibodyBuild& build);

class Multibody {
 public:
  // `outward`: the links in an order in which parents come first. Fails (kWorld) with the
  // library's words on what it refuses.
  static Result<std::unique_ptr<Multibody>> create(const std::string& name,
                                                   const std::vector<TreeLink>& links,
                                                   const std::vector<int>& outward);
  ~Multibody();

  // By link.
  std::vector<JointFrame> frames() const;

  // By the library's own algorithms, slow, for tests. `q`: a position a link, rad or m.
  struct Placed {
    std::vector<Mat3> axes;     // world
    std::vector<Vec3> origins;  // world, m
    std::vector<std::vector<double>> mass;
  };
  Result<Placed> place(const std::vector<double>& q);

 private:
  Multibody();
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace probe::world
