// The plain data of a world: joints, bodies, what is tested for contact, pair records, contacts of
// a substep. Only data and one-line helpers; the stages of a substep are functions over it. SI,
// world frame unless said otherwise. A force of a joint is in N where it slides and in N m where it
// turns; so with m and rad, kg and kg m2.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/scene/collision_shape.h"

namespace probe::world {

// Joint positions of a world, and moving links of one joint tree. A multiple of 4: rows are padded
// with zeros to the next one, so that sums over joints have fixed lanes.
constexpr int kMaxJoints = 32;

// Numbers of the solver. Only dt is the reference's (500 Hz); the others were chosen in trials of
// this stepper, whose outcomes the README's table of what was measured and the acceptance tests
// hold.
struct Parameters {
  double dt = 0.002;  // s
  // Quiet substeps need one or two sweeps, thanks to the warm start.
  int max_sweeps = 50;
  int jam_sweeps = 200;      // at most, while a sweep still changes more than jam_change:
  double jam_change = 1e-3;  // m/s; something is squeezed between the arm and the table
  double runaway = 0.05;     // m/s; sweeps that still change more after jam_sweeps do not converge
  // Largest change of speed (m/s) in a sweep at which they end. Times a mass of 0.1 kg this is the
  // 1e-6 N s from which metrics count a contact, and must not be more.
  double tolerance = 1e-5;
  // Share of the overlap that a substep removes: overlap is gone in about 9 ms. More adds energy.
  double beta = 0.2;
  // m of overlap that is left alone: a resting contact sinks until it is held, and without slop the
  // push-out would lift it off again, on and off. Far below what a picture shows.
  double slop = 5e-5;
  // m/s, cap of the push-out: objects that are placed in overlap part slowly instead of being shot
  // apart.
  double push = 0.2;
  // m, least gap from which a contact exists; faster pairs get 1.5 dt times their speed
  // (pairs.cpp). With 2 mm for every speed a cube that fell 0.3 m dipped 1.7 mm into a plate.
  double margin = 0.002;
  double reuse = 1e-4;   // m of relative motion up to which a manifold is kept
  double match = 0.004;  // m between old and new points that are the same and inherit impulses
};

using JointArray = std::array<double, kMaxJoints>;
using JointMatrix = std::array<std::array<double, kMaxJoints>, kMaxJoints>;

// Some of the world's joint positions, those of one articulation.
struct JointRange {
  int first = 0, count = 0;
};

// What acts in joints, see JointSpec. Unused joints are zero everywhere.
struct Drives {
  int count = 0;
  JointArray stiffness{}, damping{}, limit{};
  JointArray friction{}, armature{};
  JointArray friction_fade{}, friction_give{};
  JointArray lower{}, upper{};  // joint limits; infinite for continuous joints
  std::array<bool, kMaxJoints> prismatic{};
};

struct Joints {
  JointArray q{}, u{}, target{};
  // N, N m: what controllers put into joints in the next substep. No state: it is said anew before
  // each, and zero after the last of a step.
  JointArray effort{};
  std::array<std::array<double, 2>, kMaxJoints> limit_impulse{};  // N s, N m s; lower, upper
  JointArray friction_impulse{};                                  // N s, N m s
  // Drives that ended the last substep at their force limit: its sign, else 0.
  std::array<std::int8_t, kMaxJoints> saturated{};
};

struct Body {
  // Of the asset.
  double mass = 0;  // kg
  Mat3 inertia = Mat3::Zero(),
       inertia_inverse = Mat3::Zero();  // kg m2, 1/(kg m2); body axes, about the centre of mass
  Vec3 model_to_center = Vec3::Zero();  // m, centre of mass in the model frame
  // A substep times its damping: forces of the substep move it as if it were so much heavier.
  double drag = 0;       // kg
  double turn_drag = 0;  // kg m2
  // State.
  Vec3 position = Vec3::Zero();  // m, centre of mass
  Quat rotation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();  // m/s
  Vec3 spin = Vec3::Zero();      // rad/s
  int calm = 0;                  // substeps at rest
  bool asleep = false;
  bool led = false;  // moves at its velocity whatever meets it, until a robot touches it
  std::optional<Vec3> let_go_at;  // m, its position when that ended; none before
  // Derived each substep.
  Mat3 axes = Mat3::Identity();  // the rotation as a matrix
  Mat3 response = Mat3::Zero();  // 1/(kg m2), world inverse inertia (K); locked axes zero
  // m/s and rad/s after gravity, before contacts.
  Vec3 start_velocity = Vec3::Zero(), start_spin = Vec3::Zero();
};

struct Box {
  Vec3 center = Vec3::Zero(), half = Vec3::Zero();  // m
};

inline bool overlaps(const Box& a, const Box& b, double margin) {
  return std::abs(a.center.x() - b.center.x()) <= a.half.x() + b.half.x() + margin &&
         std::abs(a.center.y() - b.center.y()) <= a.half.y() + b.half.y() + margin &&
         std::abs(a.center.z() - b.center.z()) <= a.half.z() + b.half.z() + margin;
}

// A shape with a place: links first, then bodies, then fixtures, in the order of the spec.
struct Collider {
  std::shared_ptr<const scene::CollisionShape> shape;
  double friction = 1;
  double patch = 0;                      // m
  double give = 0;                       // m/N
  int body = -1;                         // index of a free body, -1 for a link or a fixture
  int articulation = -1;                 // of a link
  int moving_link = -1;                  // of its tree: the one that carries the link; -1: the base
  std::uint32_t path = 0;                // moving links from the base to this one, one bit each; 0
                                         // for what never moves on joints
  Mat3 carrier_axes = Mat3::Identity();  // of a link: frame of its centre of mass in the carrier
  Vec3 carrier_offset = Vec3::Zero();    // m
  Box local;                             // of all parts, shape frame
  bool rounded = false;  // has a part that rolls: its manifolds are made anew each substep
  // Derived each substep.
  Mat3 axes = Mat3::Identity();
  Vec3 position = Vec3::Zero();  // m
  double reach_speed = 0;        // m/s, bound on the speed of any of its points
  Box box;
  std::vector<Box> part_boxes;
  // Of what stands still for good: parts by the low end of their boxes along x, and the longest of
  // these boxes (m).
  std::vector<std::uint32_t> sorted_parts;
  double longest_part = 0;
};

constexpr int kMaxPoints = 6;

// A contact point as it is kept between substeps.
struct ManifoldPoint {
  Vec3 anchor_a = Vec3::Zero(),
       anchor_b = Vec3::Zero();  // m, witness points in the frames of A and B (plane: world)
  Vec3 normal_a = Vec3::Zero();  // from B to A, in A's frame (plane: world)
  int id = -1;                   // plane: vertex + 100 x part
  double normal_impulse = 0;     // N s
  double torsion_impulse = 0;    // N m s
  Vec3 friction_impulse = Vec3::Zero();  // N s, world
};

struct FaceRef {
  bool of_b = false;
  std::int16_t face = -1;
};

// What a pair of parts, or a collider and the plane, remembers.
struct PairRecord {
  bool valid = false;
  bool frozen = false;  // all that could move of it sleeps; kept as it is
  std::int8_t count = 0;
  std::uint64_t last = 0;        // the substep in which it was live
  std::uint64_t near = 0;        // the substep in which its boxes met last
  Mat3 axes = Mat3::Identity();  // relative pose when the manifold was made: R_A^T R_B (plane: R_A)
  Vec3 offset = Vec3::Zero();    // m, R_A^T (x_B - x_A) (plane: x_A)
  std::array<ManifoldPoint, kMaxPoints> points;
  Vec3 impulse = Vec3::Zero();    // N s, on A, last substep, world
  std::uint64_t frozen_from = 0;  // the first substep that did not solve it; only for sums
  FaceRef cached;  // last separating or reference face: changes speed only, never results
};

// One direction of a contact, as the sweeps read it: an impulse l (N s; torsion N m s) along it
// changes joint speeds by wj l, v_A by d l / m_A, omega_A by ka l, and B's the opposite way.
struct Row {
  Vec3 d, arm_a, arm_b;  // direction, r_A x d, r_B x d (m; torsion: no d, and the normal as arms)
  Vec3 ka, kb;           // K_A (r_A x d), K_B (r_B x d)
  double k = 1, inverse_k = 1;  // 1/kg, kg: speed along the row per impulse (torsion 1/(kg m2))
  double impulse = 0;           // N s, so far
};

// Rows of one contact in the order that sweeps and warm starts count them.
enum RowIndex : std::size_t { kNormal, kTangent1, kTangent2, kTwist, kRows };

// What the sweeps touch of a contact, all of it and nothing else.
struct ContactRows {
  std::array<Row, kRows> rows;
  // Of all four rows: joint columns J and responses W J^T in turns, `Problem::lanes` wide each;
  // null without links that move.
  double* columns = nullptr;
  int body_a = -1, body_b = -1;  // awake free bodies only, else -1
  bool torsion = false;
  double bias = 0;                                // m/s, of the normal row
  double friction = 0;                            // coefficient
  double patch = 0;                               // m
  double give = 0;                                // 1/kg, of the normal row: of what is soft
  double grip = 0;                                // N s, friction's bound while bounds are held
  double inverse_mass_a = 0, inverse_mass_b = 0;  // 1/kg
};

// The rest of a contact: where it comes from and where its impulses go.
struct Contact {
  std::uint32_t record = 0, pair = 0;
  std::int8_t point = 0;
  int collider_a = -1, collider_b = -1;  // -1: the plane
  std::uint32_t path_a = 0, path_b = 0;  // moving links that carry A and not B, B and not A
  Vec3 n, p, t1, t2;                     // normal from B to A, point (m), tangents
  double gap = 0;                        // m, negative in overlap
  std::array<double, kRows> body_k{};    // 1/kg, bodies' part of k, with the regularisation
  std::array<double, kRows> start{};     // N s, impulses that the sweeps began with
};

// A joint at one of its limits.
struct LimitRow {
  int joint = 0;
  double sign = 1;     // +1 lower limit, -1 upper
  double bias = 0;     // m/s, rad/s
  double k = 1;        // 1/kg, 1/(kg m2)
  double lever = 1;    // m a unit of the joint: makes changes of speed comparable
  double impulse = 0;  // N s, N m s
  double start = 0;    // the impulse that the sweeps began with
};

// A joint that friction holds or brakes.
struct JointFrictionRow {
  int joint = 0;
  double bound = 0;  // N s, N m s: friction x dt
  // speed + give x impulse = target: 0 and 0 but for friction that gives way.
  double target = 0;  // m/s, rad/s
  double give = 0;    // 1/kg, 1/(kg m2)
  double k = 1;
  double lever = 1;
  double impulse = 0;
  double start = 0;
};

}  // namespace probe::world
