#include "runtime/world/stepper.h"

#include <algorithm>
#include <cmath>

#include "runtime/world/lanes.h"

namespace probe::world {
namespace {

constexpr int kMaxResolves = 5;

Failure stiff_failure() {
  return {Fault::kWorld, "the robot's mass matrix is not positive definite", ""};
}

}  // namespace

void Stepper::note_load() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives.count); ++i) {
    const double torque = response.saturated[i] != 0
                              ? drives.limit[i]
                              : drives.stiffness[i] * (joints.target[i] - joints.q[i] -
                                                       parameters.dt * problem.u[i]) -
                                    drives.damping[i] * problem.u[i];
    drive_load = std::max(drive_load, std::fabs(torque) / drives.limit[i]);
  }
}

Status Stepper::advance() {
  if (arm) {
    PROBE_TRY(arm->update(joints.q));
    place_links(*arm, joints.u, links, &colliders);
    guess_saturation(drives, joints, arm->mass(), parameters.dt, &response);
    if (!respond(drives, joints, arm->mass(), parameters.dt, &response)) return stiff_failure();
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].asleep) place_body(bodies[b], &colliders[links + b]);
  }
  Sleepers rest = sleepers();
  if (sleeping) wake_touched(parameters, substep, &rest);
  for (Body& body : bodies) {
    if (!body.asleep) predict(&body, ambient, parameters.dt);
  }

  problem.bodies = &bodies;
  problem.joints = drives.count;
  problem.lanes = padded_lanes(drives.count);
  find_contacts(parameters, plane, substep, colliders, &table, &problem);
  build_rows(parameters, arm.get(), colliders, &problem);
  build_limits(parameters, drives, &joints, &problem);
  for (int attempt = 0;; ++attempt) {
    rewind(&problem, response);
    couple_arm(response, &problem);
    warm_start(&problem, response);
    last_sweeps = solve(parameters, response, &problem);
    if (!arm || attempt == kMaxResolves ||
        !find_overload(drives, joints, problem.u, parameters.dt, attempt == 0, &response)) {
      break;
    }
    // A drive would exceed its limit: solve again with it replaced by the limit.
    ++resolves;
    if (!respond(drives, joints, arm->mass(), parameters.dt, &response)) return stiff_failure();
  }
  if (arm) note_load();
  store_impulses(problem, &table);
  for (const LimitRow& row : problem.limits) {
    joints.limit_impulse[static_cast<std::size_t>(row.joint)][row.sign > 0 ? 0 : 1] = row.impulse;
  }

  joints.u = problem.u;
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives.count); ++i)
    joints.saturated[i] = static_cast<std::int8_t>(response.saturated[i]);
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives.count); ++i)
    joints.q[i] += parameters.dt * joints.u[i];
  for (Body& body : bodies) {
    if (!body.asleep) integrate(&body, ambient, parameters.dt);
  }
  if (sleeping) fall_asleep(problem, substep, &rest);
  ++substep;
  return {};
}

}  // namespace probe::world
