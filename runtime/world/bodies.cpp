// Free flight of a body over a substep. The turn is taken at the middle of the substep: the spin
// there is the present one and half a substep of Euler's equations in body axes; afterwards the
// spin is what the angular momentum, which nothing changed, gives in the new axes.
#include "runtime/world/bodies.h"

#include <algorithm>

#include "runtime/base/trig.h"

namespace probe::world {

void predict(Body* body, const Ambient& ambient, double dt) {
  if (body->led) {
    body->spin.setZero();
    body->response.setZero();
    body->start_velocity = body->velocity;
    body->start_spin = body->spin;
    return;
  }
  body->velocity =
      (body->velocity + dt * ambient.gravity) * std::max(0.0, 1.0 - dt * ambient.linear_damping);
  body->spin *= std::max(0.0, 1.0 - dt * ambient.angular_damping);
  // (m + dt d) v+ = m v: what the damping takes, at the speed that is left.
  if (body->drag != 0) body->velocity *= body->mass / (body->mass + body->drag);
  const bool is_slowed = body->turn_drag != 0;
  if (ambient.tilt_locked) {
    const Vec3 up = body->axes.transpose().col(2);
    body->spin = Vec3(0, 0, body->spin.z());
    body->response.setZero();
    const double inertia = up.dot(body->inertia * up);
    if (is_slowed) body->spin *= inertia / (inertia + body->turn_drag);
    body->response(2, 2) = 1.0 / (inertia + body->turn_drag);
  } else if (is_slowed) {
    const Mat3 heavier = body->inertia + body->turn_drag * Mat3::Identity();
    body->response = body->axes * heavier.inverse() * body->axes.transpose();
    body->spin =
        body->response * (body->axes * (body->inertia * (body->axes.transpose() * body->spin)));
  } else {
    const Mat3 turned = body->axes * body->inertia_inverse;
    body->response = turned * body->axes.transpose();
  }
  body->start_velocity = body->velocity;
  body->start_spin = body->spin;
}

void integrate(Body* body, const Ambient& ambient, double dt) {
  body->position += dt * body->velocity;
  const Mat3 axes = body->axes;
  Vec3 middle = body->spin;      // rad/s, world, at half the substep
  Vec3 momentum = Vec3::Zero();  // N m s, world
  if (!ambient.tilt_locked) {
    const Vec3 w = axes.transpose() * body->spin;  // rad/s, body axes
    const Vec3 iw = body->inertia * w;             // N m s, body axes
    momentum = axes * iw;
    middle -= axes * (body->inertia_inverse * (0.5 * dt * w.cross(iw)));
  }
  const double speed = middle.norm();
  const double half_angle = 0.5 * dt * speed;  // rad, as quaternions take it
  Quat turn;
  if (half_angle < 1e-8) {
    turn.w() = 1;
    turn.vec() = 0.5 * dt * middle;
  } else {
    const SinCos sc = portable_sincos(half_angle);
    turn.w() = sc.cos;
    turn.vec() = sc.sin / speed * middle;
  }
  body->rotation = turn * body->rotation;
  body->rotation.normalize();
  body->axes = body->rotation.toRotationMatrix();
  if (!ambient.tilt_locked) {
    body->spin = body->axes * (body->inertia_inverse * (body->axes.transpose() * momentum));
  }
}

}  // namespace probe::world
