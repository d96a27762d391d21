#include "runtime/world/drives.h"

#include <cmath>

namespace probe::world {
namespace {

using std::size_t;

// Inverse by Cholesky of the leading n x n block; the rest becomes zero.
bool invert(const JointMatrix& m, size_t n, JointMatrix* out) {
  JointMatrix l{};
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      double sum = m[i][j];
      for (size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      if (i != j) {
        l[i][j] = sum / l[j][j];
        continue;
      }
      if (!(sum > 0)) return false;
      l[i][i] = std::sqrt(sum);
    }
  }
  // Columns of the inverse of L, in place of L.
  JointMatrix inverse{};
  for (size_t j = 0; j < n; ++j) {
    inverse[j][j] = 1.0 / l[j][j];
    for (size_t i = j + 1; i < n; ++i) {
      double sum = 0;
      for (size_t k = j; k < i; ++k) sum -= l[i][k] * inverse[k][j];
      inverse[i][j] = sum / l[i][i];
    }
  }
  *out = JointMatrix{};
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      double sum = 0;
      for (size_t k = i; k < n; ++k) sum += inverse[k][i] * inverse[k][j];
      (*out)[i][j] = sum;
      (*out)[j][i] = sum;
    }
  }
  return true;
}

}  // namespace

void guess_saturation(const Drives& drives, const Joints& joints, const JointMatrix& mass,
                      double dt, ArmResponse* arm) {
  for (size_t i = 0; i < static_cast<size_t>(drives.count); ++i) {
    const double e = drives.stiffness[i] * (joints.target[i] - joints.q[i]);
    const double resistance = drives.damping[i] + dt * drives.stiffness[i];
    const double speed = (mass[i][i] * joints.u[i] + dt * e) / (mass[i][i] + dt * resistance);
    const double torque = e - resistance * speed;
    const bool beyond = std::fabs(torque) > drives.limit[i];
    arm->saturated[i] = !beyond ? 0 : (torque > 0 ? 1 : -1);
  }
}

bool respond(const Drives& drives, const Joints& joints, const JointMatrix& mass, double dt,
             ArmResponse* arm) {
  const size_t n = static_cast<size_t>(drives.count);
  JointMatrix m = mass;
  JointArray momentum{};
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) momentum[i] += mass[i][j] * joints.u[j];
    if (arm->saturated[i] != 0) {
      momentum[i] += dt * arm->saturated[i] * drives.limit[i];
      continue;
    }
    m[i][i] += dt * drives.damping[i] + dt * dt * drives.stiffness[i];
    momentum[i] += dt * drives.stiffness[i] * (joints.target[i] - joints.q[i]);
  }
  if (!invert(m, n, &arm->response)) return false;
  arm->free_speed = JointArray{};
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) arm->free_speed[i] += arm->response[i][j] * momentum[j];
  }
  return true;
}

bool find_overload(const Drives& drives, const Joints& joints, const JointArray& u, double dt,
                   ArmResponse* arm) {
  constexpr double kOver = 1.001;
  bool any = false;
  for (size_t i = 0; i < static_cast<size_t>(drives.count); ++i) {
    if (arm->saturated[i] != 0) continue;
    const double torque = drives.stiffness[i] * (joints.target[i] - joints.q[i] - dt * u[i]) -
                          drives.damping[i] * u[i];
    if (!(std::fabs(torque) > kOver * drives.limit[i])) continue;
    arm->saturated[i] = torque > 0 ? 1 : -1;
    any = true;
  }
  return any;
}

}  // namespace probe::world
