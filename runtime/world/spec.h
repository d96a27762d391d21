// What a world is made from. SI; world frame, z up.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/collision_shape.h"

namespace probe::world {

// What acts in one joint. Units by its kind: N, m where it slides; N m, rad where it turns.
struct JointSpec {
  std::string joint;  // of the model
  // tau = stiffness (target - q) - damping u, |tau| <= limit: a drive, or a spring with a damper.
  double stiffness = 0;  // N/m, N m/rad
  double damping = 0;    // N s/m, N m s/rad
  double limit = std::numeric_limits<double>::infinity();
  double friction = 0;  // N, N m: what it takes to set the joint moving, and what brakes it then
  double armature = 0;  // kg, kg m2: inertia of rotors and gears, seen at the joint
  // Friction that holds as a strong brake does, not as a lock. 0 and 0: what stands still under it
  // stands still. Else it makes the joint's acceleration a as good as it can: a = -fade u - give f,
  // f its own force within +-friction. What it holds creeps, at give f / fade.
  double friction_fade = 0;         // 1/s
  double friction_give = 0;         // 1/kg, 1/(kg m2)
  std::optional<double> rest = {};  // m, rad: the target to begin with; where it starts if absent
};

// What moves on joints: a robot, whose drives have targets, or a cabinet, whose joints are pulled.
struct ArticulationSpec {
  std::string name;                          // as failures call it; empty: the model's
  const robot::RobotModel* model = nullptr;  // outlives the world
  Pose base;                                 // of the root link
  // One per joint that moves; their order is the order of q everywhere. A joint that is left out
  // must be fixed or mimic one that is not: it then follows exactly, as if geared.
  std::vector<JointSpec> joints;
  std::vector<double> positions;  // initial q, rad and m
  // True: a controller sets its targets and cancels gravity and Coriolis forces, as the reference's
  // robots do; it never sleeps. False: it is passive, feels its weight, and sleeps at rest.
  bool driven = true;
  // Of a driven one. True: nothing is cancelled for it. Before each substep its controller says
  // what force acts in each joint (World::step), against weight and Coriolis forces as well, which
  // are those of the substep's beginning, as in the engine that such controllers were made for.
  bool by_efforts = false;
  // Collision shapes of links by name, in the link's frame (shape's model frame = link frame).
  // Shared, read-only.
  struct Link {
    std::string name;
    std::shared_ptr<const scene::CollisionShape> shape;
    double friction = 1;
    double patch = 0;  // torsional patch radius, m
    double give = 0;   // m/N: how far what touches it sinks in under a force; 0: not at all
  };
  std::vector<Link> links;
  // Whether its links hit each other and the base. Pairs that cannot or must not are left out: see
  // World::excluded_links(). Links of different articulations always do.
  bool self_collision = false;
};

struct BodySpec {
  std::string name;
  std::shared_ptr<const scene::CollisionShape> shape;
  double density = 1000;  // kg/m3
  double friction = 0.5;
  Pose pose;  // model origin
  // What resists it wherever it is: a force at its centre of mass against its velocity, a torque
  // against its spin. Implicit in the substep, so that any strength only slows.
  double damping = 0;       // N s/m
  double turn_damping = 0;  // N m s/rad
};

// What never moves: a sink, a shelf. Its parts may be many.
struct FixtureSpec {
  std::string name;
  std::shared_ptr<const scene::CollisionShape> shape;
  Pose pose;  // model origin
  double friction = 1;
};

// Felt by articulations by efforts (air.h); none unless said.
struct Air {
  double density = 0;    // kg/m3
  double viscosity = 0;  // Pa s
};

struct WorldSpec {
  std::vector<ArticulationSpec> articulations;
  std::vector<BodySpec> bodies;
  std::vector<FixtureSpec> fixtures;
  double dt = 0.002;          // s, a substep
  Vec3 gravity{0, 0, -9.81};  // m/s2
  double surface_z = 0;       // m
  double surface_friction = 1.0;
  double linear_damping = 0.1, angular_damping = 0.1;  // 1/s, of free bodies
  bool sleeping = true;
  Air air;
};

}  // namespace probe::world
