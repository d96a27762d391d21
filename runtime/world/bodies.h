// Free rigid bodies between contacts: gravity, damping, and the step of poses that keeps angular
// momentum.
#pragma once

#include "runtime/world/state.h"

namespace probe::world {

struct Ambient {
  Vec3 gravity = Vec3::Zero();
  double linear_damping = 0, angular_damping = 0;  // 1/s
  bool tilt_locked = false;                        // no rotation about world x and y
};

// Velocities after gravity and damping, and the world inverse inertia the rows need.
void predict(Body* body, const Ambient& ambient, double dt);

// It goes on as any body does, and where that began is kept. Of what is not led nothing changes.
inline void let_go(Body* body) {
  if (!body->led) return;
  body->led = false;
  body->let_go_at = body->position;
}

// Poses after the substep.
void integrate(Body* body, const Ambient& ambient, double dt);

}  // namespace probe::world
