// A robot description, read with urdfdom into plain data. Joint and link order is the file's order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"

namespace probe::robot {

struct MeshRef {
  std::string path;  // as written, relative to the URDF file's folder
  Vec3 scale{1, 1, 1};
  Pose origin;  // mesh frame in the link frame
};

// A collision shape given by numbers instead of a file, about its origin.
struct Primitive {
  enum class Kind { kBox, kSphere, kCylinder };
  Kind kind = Kind::kBox;
  Vec3 half = Vec3::Zero();  // m, half extents: of a sphere all its radius, of a cylinder along z
                             // its half length and else its radius
  Pose origin;               // its frame in the link frame
};

// One that is drawn, in a colour (sRGB, 0 to 1).
struct DrawnPrimitive {
  Primitive shape;
  Vec3 color = Vec3::Constant(0.7);
};

struct Link {
  std::string name;
  int parent_joint = -1;               // index into joints, -1 for the root
  double mass = 0;                     // kg; 0 where the file gives no inertial
  Vec3 center_of_mass = Vec3::Zero();  // link frame
  Mat3 inertia = Mat3::Zero();         // about the centre of mass, link frame axes
  std::vector<MeshRef> visuals;
  std::vector<MeshRef> collisions;
  std::vector<DrawnPrimitive> drawn;  // visuals too
  std::vector<Primitive> primitives;  // collisions too
  bool can_collide() const { return !collisions.empty() || !primitives.empty(); }
};

enum class JointKind { kFixed, kRevolute, kContinuous, kPrismatic };

struct Joint {
  std::string name;
  JointKind kind = JointKind::kFixed;
  int parent_link = -1, child_link = -1;
  Pose origin;                  // child frame at q = 0, in the parent link's frame
  Vec3 axis{1, 0, 0};           // unit, child frame
  double lower = 0, upper = 0;  // rad or m
  double effort = 0, velocity = 0;
  double damping = 0, friction = 0;  // N m s and N m, or N s/m and N; read, not acted upon: what
                                     // acts in a world's joints is its drives' and its controller's
  int mimic = -1;                    // joint index, -1 none
  double mimic_scale = 1, mimic_offset = 0;
};

struct RobotModel {
  std::string name;
  std::string path;  // of the file
  std::vector<Link> links;
  std::vector<Joint> joints;
  int root = 0;  // link index

  int find_link(std::string_view name) const;   // -1 if absent
  // Its pose in the base frame does not depend on joints: none on the way moves.
  bool is_fixed(int link) const;
  int find_joint(std::string_view name) const;  // -1 if absent
};

// Fails (kUrdf, where = path) on a missing file, text that is not URDF, a link named by a
// joint that is not there, a loop, non-finite numbers, non-positive mass of a moving link, inertia
// no body can have, more than 1024 links or 100,000 elements.
Result<RobotModel> load_urdf(const std::string& path);

}  // namespace probe::robot
