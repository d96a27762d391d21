// The stages of a substep in their order. In: positions, velocities, targets and what the pairs
// remember. Out: the same, dt later. Positions follow from the new velocities (symplectic Euler),
// so every stage before the last reads poses of one moment.
#include "runtime/world/stepper.h"

#include <algorithm>
#include <cmath>

#include "runtime/world/colliders.h"
#include "runtime/world/lanes.h"

namespace probe::world {
namespace {

using std::size_t;

// Solutions with other drives at their limits; after the last the substep takes what it has.
constexpr int kMaxResolves = 5;

Failure stiff_failure() {
  return {Fault::kWorld, "the robot's mass matrix is not positive definite", ""};
}

}  // namespace

void Stepper::note_load() {
  for (size_t i = 0; i < static_cast<size_t>(drives.count); ++i) {
    const double torque = response.saturated[i] != 0  // N, N m, at the end of the substep
                              ? drives.limit[i]
                              : drives.stiffness[i] * (joints.target[i] - joints.q[i] -
                                                       parameters.dt * problem.u[i]) -
                                    drives.damping[i] * problem.u[i];
    drive_load = std::max(drive_load, std::fabs(torque) / drives.limit[i]);
  }
}

void Stepper::place_awake() {
  for (Articulation& a : articulations) {
    if (a.asleep) continue;
    a.tree->update(joints.q);
    place_links(a, joints.u, &colliders);
  }
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].asleep) place_body(bodies[b], &colliders[links + b]);
  }
}

// W and u* of one articulation. Coriolis forces of a passive one are taken at the mean of the
// speeds before and after: at those before, a folding door without a brake gains a third of its
// energy in five seconds.
bool Stepper::respond_one(const Articulation& a) {
  const JointMatrix& mass = a.tree->mass();
  if (a.by_efforts) {
    JointArray forces = a.tree->own_forces(ambient.gravity, joints.u);
    for (size_t k = 0; k < static_cast<size_t>(a.range.count); ++k) {
      forces[k] += joints.effort[static_cast<size_t>(a.range.first) + k];
    }
    if (!a.air.empty()) add_air(air, a.air, *a.tree, joints.u, &forces);
    return respond(drives, joints, a.range, mass, &forces, parameters.dt, &response);
  }
  if (a.driven) return respond(drives, joints, a.range, mass, nullptr, parameters.dt, &response);
  JointArray speeds = joints.u;
  for (int pass = 0;; ++pass) {
    const JointArray forces = a.tree->own_forces(ambient.gravity, speeds);
    if (!respond(drives, joints, a.range, mass, &forces, parameters.dt, &response)) return false;
    // A joint that moves nothing but itself has no such forces.
    if (pass == 1 || a.range.count < 2) return true;
    for (int j = a.range.first; j < a.range.first + a.range.count; ++j) {
      const size_t i = static_cast<size_t>(j);
      speeds[i] = 0.5 * (joints.u[i] + response.free_speed[i]);
    }
  }
}

// Of all, with the saturation at hand.
bool Stepper::respond_all() {
  for (const Articulation& a : articulations) {
    if (a.asleep) {
      hold_still(a.range, &response);
    } else if (!respond_one(a)) {
      return false;
    }
  }
  return true;
}

bool Stepper::find_overloads(bool release) {
  bool any = false;
  for (const Articulation& a : articulations) {
    if (a.asleep) continue;
    any |= find_overload(drives, joints, a.range, problem.u, parameters.dt, release, &response);
  }
  return any;
}

void Stepper::store_joint_impulses() {
  for (const LimitRow& row : problem.limits) {
    joints.limit_impulse[static_cast<size_t>(row.joint)][row.sign > 0 ? 0 : 1] = row.impulse;
  }
  for (const JointFrictionRow& row : problem.joint_frictions) {
    joints.friction_impulse[static_cast<size_t>(row.joint)] = row.impulse;
  }
}

void Stepper::integrate_all() {
  joints.u = problem.u;
  for (size_t i = 0; i < static_cast<size_t>(drives.count); ++i) {
    joints.saturated[i] = static_cast<std::int8_t>(response.saturated[i]);
    joints.q[i] += parameters.dt * joints.u[i];
  }
  for (Body& body : bodies) {
    if (!body.asleep) integrate(&body, ambient, parameters.dt);
  }
}

// A robot's touch ends that a body is led; it goes on as it was.
void Stepper::free_touched() {
  if (std::ranges::none_of(bodies, &Body::led)) return;
  const auto is_robot = [&](int collider) {
    if (collider < 0) return false;
    const Collider& c = colliders[static_cast<size_t>(collider)];
    return c.path != 0 && articulations[static_cast<size_t>(c.articulation)].driven;
  };
  for (size_t i = 0; i < problem.contacts.size(); ++i) {
    if (problem.rows[i].rows[kNormal].impulse <= 0) continue;
    const Contact& contact = problem.contacts[i];
    const int sides[2] = {contact.collider_a, contact.collider_b};
    for (const int side : {0, 1}) {
      if (sides[side] < 0 || !is_robot(sides[1 - side])) continue;
      const int body = colliders[static_cast<size_t>(sides[side])].body;
      if (body >= 0) let_go(&bodies[static_cast<size_t>(body)]);
    }
  }
}

Status Stepper::advance() {
  // Where everything is, and who wakes.
  place_awake();
  Sleepers rest = sleepers();
  if (sleeping) wake_touched(parameters, substep, &rest);
  for (const Articulation& a : articulations) {
    if (a.asleep) continue;
    a.tree->update(joints.q);  // of those that just woke
    guess_saturation(drives, joints, a.range, a.tree->mass(), parameters.dt, &response);
  }
  // Velocities without contacts.
  if (!respond_all()) return stiff_failure();
  for (Body& body : bodies) {
    if (!body.asleep) predict(&body, ambient, parameters.dt);
  }

  // Contacts as rows, and the impulses that satisfy them.
  problem.bodies = &bodies;
  problem.joints = drives.count;
  problem.lanes = padded_lanes(drives.count);
  find_contacts(parameters, plane, substep, articulations, colliders, &table, &scratch, &problem);
  build_rows(parameters, articulations, colliders, &problem);
  build_joint_rows(parameters, drives, articulations, &joints, &problem);
  for (int attempt = 0;; ++attempt) {
    rewind(&problem, response);
    couple_joints(response, &problem);
    warm_start(&problem, response);
    last_sweeps = solve(parameters, response, &problem);
    if (attempt == kMaxResolves || !find_overloads(attempt == 0)) {
      break;
    }
    // A drive would exceed its limit: solve again with it replaced by the limit.
    ++resolves;
    if (!respond_all()) return stiff_failure();
  }
  // What the next substep starts from.
  note_load();
  store_impulses(problem, &table);
  store_joint_impulses();
  integrate_all();
  free_touched();
  if (sleeping) fall_asleep(problem, drives, substep, &joints, &rest);
  ++substep;
  return {};
}

}  // namespace probe::world
