// A world: one robot arm, one horizontal surface, fixtures and free rigid bodies, stepped at a
// fixed rate by the contact stepper of this folder. Simbody stays behind arm_dynamics.cpp. Same
// spec and same calls give the same bits.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/collision_shape.h"

namespace probe::world {

// A drive of one joint: tau = stiffness (target - q) - damping u, |tau| <= limit.
struct Drive {
  std::string joint;
  double stiffness = 0, damping = 0, limit = 0;
};

struct ArmSpec {
  const robot::RobotModel* model = nullptr;  // outlives the world
  Pose base;                                 // of the root link, world
  // One per actuated joint; their order is the order of q everywhere. A joint without a drive must
  // mimic one that has: it then follows exactly, as if geared.
  std::vector<Drive> drives;
  std::vector<double> joints;  // initial q
  // Collision shapes of links by name, in the link's frame (shape's model frame = link frame).
  // Shared, read-only.
  struct Link {
    std::string name;
    std::shared_ptr<const scene::CollisionShape> shape;
    double friction = 1;
    double patch = 0;  // torsional patch radius, m
  };
  std::vector<Link> links;
  // Whether links hit each other and the base. Pairs that cannot or must not are left out: see
  // World::excluded_links().
  bool self_collision = false;
};

struct BodySpec {
  std::string name;
  std::shared_ptr<const scene::CollisionShape> shape;
  double density = 1000;  // kg/m3
  double friction = 0.5;
  Pose pose;  // model origin, world
};

// What never moves: a sink, a shelf. Its parts may be many.
struct FixtureSpec {
  std::string name;
  std::shared_ptr<const scene::CollisionShape> shape;
  Pose pose;  // model origin, world
  double friction = 1;
};

struct WorldSpec {
  ArmSpec arm;
  std::vector<BodySpec> bodies;
  std::vector<FixtureSpec> fixtures;
  double dt = 0.002;
  Vec3 gravity{0, 0, -9.81};
  double surface_z = 0;
  double surface_friction = 1.0;
  double linear_damping = 0.1, angular_damping = 0.1;  // 1/s
  bool sleeping = true;
};

struct BodyState {
  Pose pose;      // model origin, world
  Vec3 center;    // centre of mass, world
  Vec3 velocity;  // of the centre of mass
  Vec3 spin;      // angular velocity, world
};

// Who touches: links are those of ArmSpec::links in order, bodies those of WorldSpec::bodies,
// fixtures those of WorldSpec::fixtures.
enum class PartyKind : std::uint8_t { kSurface, kLink, kBody, kFixture };
struct Party {
  PartyKind kind = PartyKind::kSurface;
  std::uint16_t index = 0;
  bool operator==(const Party&) const = default;
};
// Two links that never hit each other although self-collision is on, and why.
struct ExcludedLinks {
  enum class Reason : std::uint8_t { kRigid, kNeighbours, kTouchingAtStart };
  std::uint16_t a = 0, b = 0;  // of ArmSpec::links
  Reason reason = Reason::kRigid;
};
// Sum over all contacts of a pair, N s, world; exerted by b on a.
struct ContactImpulse {
  Party a, b;
  Vec3 on_a = Vec3::Zero();
};

class World {
 public:
  // Fails (kWorld) on mass or inertia that no body can have, unknown joints or links,
  // non-finite numbers.
  static Result<std::unique_ptr<World>> create(WorldSpec spec);
  virtual ~World() = default;

  virtual const WorldSpec& spec() const = 0;

  virtual std::span<const double> joints() const = 0;        // q, in drive order
  virtual std::span<const double> joint_speeds() const = 0;  // u
  // The largest share of its force limit that any drive exerted during the last step().
  virtual double drive_load() const = 0;
  virtual void set_targets(std::span<const double> targets) = 0;
  virtual BodyState body(std::size_t index) const = 0;
  virtual Pose link_pose(
      std::size_t link) const = 0;  // of ArmSpec::links[link], world, at the present q
  virtual Pose frame_pose(std::string_view link_name) const = 0;  // any URDF link, fixed ones too

  // Puts a body anywhere, at rest.
  virtual void set_body(std::size_t index, const Pose& model_pose) = 0;
  virtual void set_joints(std::span<const double> q) = 0;  // at rest, targets equal
  // While locked, rotation about world x and y is blocked for all free bodies (the drop at reset).
  virtual void lock_tilt(bool locked) = 0;
  virtual void stop_bodies() = 0;  // zero velocities

  // Advances n substeps. Fails (kWorld) when a number is not finite, or a body is faster than
  // 50 m/s, far below the floor or 100 m away; the message names the body. The world must not be
  // used after that.
  virtual Status step(int substeps) = 0;

  // Contacts of the last substep with a nonzero impulse, in a fixed order; sleeping bodies report
  // frozen impulses.
  virtual std::span<const ContactImpulse> contacts() const = 0;
  // The same summed over all substeps of the last step(): what a sensor averages over a control
  // step. Empty after restore().
  virtual std::span<const ContactImpulse> contact_sums() const = 0;
  // With self-collision, the pairs of links that were left out at load.
  virtual std::span<const ExcludedLinks> excluded_links() const = 0;

  // The whole state including solver caches; restoring it continues bit for bit.
  virtual std::vector<std::byte> save() const = 0;
  virtual Status restore(std::span<const std::byte> state) = 0;
  // Of q, u, targets and every body's pose and velocities: equal states, equal hashes.
  virtual Sha256 state_hash() const = 0;
};

}  // namespace probe::world
