#include "runtime/world/dynamics.h"

#include <algorithm>

namespace probe::world {

using std::size_t;

void read_dynamics(const Tool& tool, const Drives& drives, const Joints& joints,
                   const Vec3& gravity, robot::Dynamics* out) {
  const JointTree& tree = tool.tree;
  const size_t first = static_cast<size_t>(tree.first());
  const Eigen::Index n = static_cast<Eigen::Index>(tool.joints);
  const Mat3 to_base = tree.base().rotation.toRotationMatrix().transpose();
  robot::Dynamics& d = *out;

  const size_t all = std::min(static_cast<size_t>(tree.count()), d.all_q.size());
  for (size_t j = 0; j < all; ++j) d.all_q[j] = joints.q[first + j];
  d.q.resize(n), d.u.resize(n), d.bias.resize(n), d.mass.resize(n, n);
  const JointArray forces = tree.own_forces(gravity, joints.u);
  const JointMatrix& mass = tree.mass();
  for (size_t i = 0; i < tool.joints; ++i) {
    const Eigen::Index row = static_cast<Eigen::Index>(i);
    d.q[row] = joints.q[first + i];
    d.u[row] = joints.u[first + i];
    d.bias[row] = -forces[i];
    for (size_t j = 0; j < tool.joints; ++j) {
      d.mass(row, static_cast<Eigen::Index>(j)) = mass[i][j];
    }
    d.mass(row, row) += drives.armature[first + i];
  }

  Mat3 axes = tree.base().rotation.toRotationMatrix();
  Vec3 origin = tree.reference();
  if (tool.carrier.moving >= 0) {
    axes = tree.link(tool.carrier.moving).axes;
    origin = tree.link(tool.carrier.moving).origin;
  }
  const Vec3 arm = origin + axes * tool.carrier.offset.position - tree.reference();
  d.axes = to_base * (axes * tool.carrier.offset.rotation.toRotationMatrix());
  d.position = to_base * arm;
  d.jacobian.setZero(6, n);
  for (int k = tool.carrier.moving; k >= 0; k = tree.parent(k)) {
    const MovingLink& link = tree.link(k);
    const Vec3 turn = to_base * link.w, shift = to_base * (link.v + link.w.cross(arm));
    const Eigen::Index column = static_cast<Eigen::Index>(link.coordinate) - tree.first();
    d.jacobian.col(column).head<3>() += shift;
    d.jacobian.col(column).tail<3>() += turn;
  }
  d.velocity = d.jacobian.topRows<3>() * d.u;
  d.spin = d.jacobian.bottomRows<3>() * d.u;
}

}  // namespace probe::world
