#include "runtime/world/drives.h"

#include <cmath>
#include <type_traits>

namespace probe::world {
namespace {

using std::size_t;

// Inverse by Cholesky of the leading n x n block, written to the block of `out` that begins at
// `first`; the rest of `out` stays as it is. Loops run over rows that lie together, so that the
// usual eight joints vectorise.
template <typename Count>
bool invert(const JointMatrix& m, Count count, size_t first, JointMatrix* out) {
  const size_t n = static_cast<size_t>(count);
  double l[kMaxJoints][kMaxJoints];        // lower triangle of L, transposed: l[k][i] = L_ik
  double inverse[kMaxJoints][kMaxJoints];  // of L: inverse[k][j] = (L^-1)_kj, zero above
  for (size_t k = 0; k < n; ++k) {
    for (size_t i = 0; i < n; ++i) l[k][i] = m[k][i];
  }
  for (size_t k = 0; k < n; ++k) {
    if (!(l[k][k] > 0)) return false;
    const double scale = 1.0 / std::sqrt(l[k][k]);
    for (size_t i = 0; i < n; ++i) l[k][i] *= scale;
    for (size_t r = k + 1; r < n; ++r) {
      const double factor = l[k][r];
      for (size_t i = 0; i < n; ++i) l[r][i] -= factor * l[k][i];
    }
  }
  for (size_t k = 0; k < n; ++k) {
    for (size_t j = 0; j < n; ++j) inverse[k][j] = j == k ? 1.0 : 0.0;
  }
  for (size_t k = 0; k < n; ++k) {
    const double scale = 1.0 / l[k][k];
    for (size_t j = 0; j < n; ++j) inverse[k][j] *= scale;
    for (size_t r = k + 1; r < n; ++r) {
      const double factor = l[k][r];
      for (size_t j = 0; j < n; ++j) inverse[r][j] -= factor * inverse[k][j];
    }
  }
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) (*out)[first + i][first + j] = 0;
  }
  for (size_t k = 0; k < n; ++k) {
    for (size_t i = 0; i <= k; ++i) {
      const double factor = inverse[k][i];
      for (size_t j = 0; j < n; ++j) (*out)[first + i][first + j] += factor * inverse[k][j];
    }
  }
  return true;
}

}  // namespace

void guess_saturation(const Drives& drives, const Joints& joints, JointRange range,
                      const JointMatrix& mass, double dt, JointResponse* response) {
  for (size_t k = 0; k < static_cast<size_t>(range.count); ++k) {
    const size_t i = static_cast<size_t>(range.first) + k;
    response->flung[i] = false;
    const double e = drives.stiffness[i] * (joints.target[i] - joints.q[i]);  // N, N m
    const double resistance = drives.damping[i] + dt * drives.stiffness[i];   // N s/m, N m s
    const double inertia = mass[k][k] + drives.armature[i];                   // kg, kg m2
    // After the substep, were the joint alone: m/s, rad/s.
    const double speed = (inertia * joints.u[i] + dt * e) / (inertia + dt * resistance);
    const double torque = e - resistance * speed;
    const bool beyond = std::fabs(torque) > drives.limit[i];
    response->saturated[i] = !beyond ? 0 : (torque > 0 ? 1 : -1);
    // One that pressed with its limit and would press beyond it at its present speed still does.
    const double steady = joints.saturated[i] * (e - resistance * joints.u[i]);
    if (steady > drives.limit[i]) response->saturated[i] = joints.saturated[i];
  }
}

bool respond(const Drives& drives, const Joints& joints, JointRange range, const JointMatrix& mass,
             const JointArray* forces, double dt, JointResponse* response) {
  const size_t n = static_cast<size_t>(range.count), first = static_cast<size_t>(range.first);
  JointMatrix m;          // kg, kg m, kg m2: what is inverted
  JointArray momentum{};  // N s, N m s: the right side
  for (size_t i = 0; i < n; ++i) {
    const size_t at = first + i;
    for (size_t j = 0; j < n; ++j) {
      m[i][j] = mass[i][j];
      if (i == j) m[i][j] += drives.armature[at];
      momentum[i] += m[i][j] * joints.u[first + j];
    }
    if (forces != nullptr) momentum[i] += dt * (*forces)[i];
    if (response->saturated[at] != 0) {
      momentum[i] += dt * response->saturated[at] * drives.limit[at];
      continue;
    }
    m[i][i] += dt * drives.damping[at] + dt * dt * drives.stiffness[at];
    momentum[i] += dt * drives.stiffness[at] * (joints.target[at] - joints.q[at]);
  }
  const bool good = n == 8
                        ? invert(m, std::integral_constant<size_t, 8>{}, first, &response->matrix)
                        : invert(m, n, first, &response->matrix);
  if (!good) return false;
  for (size_t i = 0; i < n; ++i) {
    double speed = 0;
    for (size_t j = 0; j < n; ++j) speed += response->matrix[first + i][first + j] * momentum[j];
    response->free_speed[first + i] = speed;
  }
  return true;
}

void hold_still(JointRange range, JointResponse* response) {
  const size_t first = static_cast<size_t>(range.first);
  for (size_t i = first; i < first + static_cast<size_t>(range.count); ++i) {
    response->matrix[i].fill(0);
    response->free_speed[i] = 0;
    response->saturated[i] = 0;
  }
}

bool find_overload(const Drives& drives, const Joints& joints, JointRange range,
                   const JointArray& u, double dt, bool release, JointResponse* response) {
  // Rounding beyond the limit is none: a drive just at it would change sides in every solution.
  constexpr double kOver = 1.001;
  bool any = false;
  const size_t first = static_cast<size_t>(range.first);
  for (size_t i = first; i < first + static_cast<size_t>(range.count); ++i) {
    // Of the implicit drive at the new speed, N, N m.
    const double torque = drives.stiffness[i] * (joints.target[i] - joints.q[i] - dt * u[i]) -
                          drives.damping[i] * u[i];
    if (response->saturated[i] != 0) {
      response->flung[i] = !release && response->saturated[i] * torque < 0;
      const bool below = release && response->saturated[i] * torque <= drives.limit[i] / kOver;
      if (!below && !response->flung[i]) continue;
      response->saturated[i] = 0;
    } else {
      if (response->flung[i] || !(std::fabs(torque) > kOver * drives.limit[i])) continue;
      response->saturated[i] = torque > 0 ? 1 : -1;
    }
    any = true;
  }
  return any;
}

}  // namespace probe::world
