// One function a rule.
#include "runtime/robot/model_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

namespace probe::robot {
namespace {

Failure wrong(const RobotModel& model, std::string message) {
  return Failure{Fault::kUrdf, std::move(message), model.path};
}

Status check_joint(const RobotModel& model, const Joint& joint) {
  if (!is_finite(joint.origin)) {
    return wrong(model, fmt::format("joint `{}` has an origin that is not finite", joint.name));
  }
  if (joint.kind == JointKind::kFixed) return {};
  if (!joint.axis.allFinite() || std::abs(joint.axis.norm() - 1) > 1e-9) {
    return wrong(model, fmt::format("joint `{}` has an axis without direction", joint.name));
  }
  if (joint.kind != JointKind::kContinuous &&
      !(std::isfinite(joint.lower) && std::isfinite(joint.upper) && joint.lower < joint.upper)) {
    return wrong(model, fmt::format("joint `{}` has limits {} to {}, lower must be below upper",
                                    joint.name, joint.lower, joint.upper));
  }
  if (joint.mimic < 0) return {};
  const Joint& leader = model.joints[std::size_t(joint.mimic)];
  if (leader.mimic >= 0 || leader.kind == JointKind::kFixed) {
    return wrong(model, fmt::format("joint `{}` mimics `{}`, which {}", joint.name, leader.name,
                                    leader.mimic >= 0 ? "itself mimics" : "is fixed"));
  }
  if (!std::isfinite(joint.mimic_scale) || !std::isfinite(joint.mimic_offset)) {
    return wrong(model,
                 fmt::format("joint `{}` mimics by numbers that are not finite", joint.name));
  }
  return {};
}

// Principal moments of a real body are positive and none exceeds the sum of the others (x^2 + y^2
// and so on are sums of squares). The tolerance admits values that were rounded for printing.
Status check_inertia(const RobotModel& model, const Link& link) {
  if (!std::isfinite(link.mass) || !link.inertia.allFinite() || !link.center_of_mass.allFinite()) {
    return wrong(model,
                 fmt::format("link `{}` has a mass or inertia that is not finite", link.name));
  }
  if (link.mass < 0) {
    return wrong(model, fmt::format("link `{}` weighs {} kg", link.name, link.mass));
  }
  if (link.mass == 0) return {};
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(link.inertia, Eigen::EigenvaluesOnly);
  const Vec3 e = solver.eigenvalues();  // ascending
  if (!(e[0] > 0)) {
    return wrong(model, fmt::format("link `{}` has an inertia with the principal moment {:.4g}, "
                                    "which must be above 0",
                                    link.name, e[0]));
  }
  if (e[0] + e[1] < e[2] * (1 - 1e-3)) {
    return wrong(model, fmt::format("link `{}` has an inertia no body can have: of its principal "
                                    "moments {:.4g}, {:.4g}, {:.4g} the last exceeds the sum of "
                                    "the others",
                                    link.name, e[0], e[1], e[2]));
  }
  return {};
}

Status check_dynamics(const RobotModel& model, const Joint& joint) {
  if (joint.damping >= 0 && joint.friction >= 0 && std::isfinite(joint.damping + joint.friction)) {
    return {};
  }
  return wrong(model, fmt::format("joint `{}` has a damping or friction that is negative or not "
                                  "finite",
                                  joint.name));
}

// Links fixed to one another move as one body; that body needs mass.
Status check_moving_mass(const RobotModel& model) {
  for (const Joint& joint : model.joints) {
    if (joint.kind == JointKind::kFixed) continue;
    double mass = 0;
    std::vector<int> rigid{joint.child_link};
    for (std::size_t i = 0; i < rigid.size(); ++i) {
      mass += model.links[std::size_t(rigid[i])].mass;
      for (const Joint& next : model.joints) {
        if (next.parent_link == rigid[i] && next.kind == JointKind::kFixed) {
          rigid.push_back(next.child_link);
        }
      }
    }
    if (mass > 0) continue;
    return wrong(model, fmt::format("link `{}` moves, but it and what is fixed to it weigh nothing",
                                    model.links[std::size_t(joint.child_link)].name));
  }
  return {};
}

Status check_meshes(const RobotModel& model, const Link& link, const std::vector<MeshRef>& meshes) {
  for (const MeshRef& mesh : meshes) {
    if (mesh.path.empty()) {
      return wrong(model, fmt::format("link `{}` has a mesh without a file name", link.name));
    }
    if (!is_finite(mesh.origin) || !mesh.scale.allFinite() || (mesh.scale.array() == 0).any()) {
      return wrong(model, fmt::format("link `{}` places the mesh `{}` with a number that is not "
                                      "finite or a scale of 0",
                                      link.name, mesh.path));
    }
  }
  return {};
}

Status check_primitives(const RobotModel& model, const Link& link) {
  const auto is_good = [](const Primitive& primitive) {
    return is_finite(primitive.origin) && primitive.half.allFinite() &&
           primitive.half.minCoeff() > 0;
  };
  const bool draws = std::ranges::all_of(
      link.drawn, [&](const DrawnPrimitive& drawn) { return is_good(drawn.shape); });
  if (!draws || !std::ranges::all_of(link.primitives, is_good)) {
    return wrong(model, fmt::format("link `{}` has a {} shape of a size that is not positive "
                                    "or a place that is not finite",
                                    link.name, draws ? "collision" : "visual"));
  }
  return {};
}

}  // namespace

Status check_model(const RobotModel& model) {
  for (const Joint& joint : model.joints) {
    PROBE_TRY(check_joint(model, joint));
    PROBE_TRY(check_dynamics(model, joint));
  }
  for (const Link& link : model.links) {
    PROBE_TRY(check_inertia(model, link));
    PROBE_TRY(check_meshes(model, link, link.visuals));
    PROBE_TRY(check_meshes(model, link, link.collisions));
    PROBE_TRY(check_primitives(model, link));
  }
  return check_moving_mass(model);
}

}  // namespace probe::robot
