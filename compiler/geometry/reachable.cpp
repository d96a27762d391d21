#include "compiler/geometry/reachable.h"

#include <algorithm>
#include <cmath>

#include "runtime/robot/ik.h"

namespace probe::sema {
namespace {

// A place and a downward direction fix five degrees of freedom. An arm with fewer joints takes such
// a pose only by chance, and how it would grasp instead is not known here.
constexpr std::size_t kLeastJoints = 5;

// Jittered starts are all different: a million of them is not worth ten seconds of a check. The
// first ones speak for the rest, which the annulus still bounds.
constexpr std::size_t kMostPlaces = 4096;

// A turn about the vertical that takes x to (x, y), without libm.
Quat heading(double x, double y) {
  const double length = std::sqrt(x * x + y * y);
  if (length < 1e-9) return Quat::Identity();
  const double c = std::clamp(x / length, -1.0, 1.0);
  const double s = std::sqrt((1 - c) / 2);
  return {std::sqrt((1 + c) / 2), 0, 0, y < 0 ? -s : s};
}

// The least turn that takes x to an axis of the frame; by none where they are one, so that chains
// of tools that point along x keep their bits.
Quat from_x(const Vec3& axis) {
  if (axis.x() > 0) return Quat::Identity();
  if (axis.x() < 0) return {0, 0, 0, 1};
  const double half = std::sqrt(0.5);
  return {half, 0, -half * axis.z(), half * axis.y()};
}

}  // namespace

std::optional<Arm> Arm::of(const Model& model, const Scene& scene) {
  if (scene.robot == RobotId::kNone) return std::nullopt;
  const Robot& robot = model.robots[scene.robot];
  if (!robot.model || scene.joints.size() != robot.drives.size()) return std::nullopt;
  std::vector<std::string> joints;
  std::vector<double> start;
  const int tcp = robot.model->find_link(robot.tcp.text);
  for (int link = tcp; link >= 0;) {
    const int above = robot.model->links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) break;
    const robot::Joint& joint = robot.model->joints[static_cast<std::size_t>(above)];
    link = joint.parent_link;
    if (joint.kind == robot::JointKind::kFixed || joint.mimic >= 0) continue;
    const auto drive = std::find_if(robot.drives.begin(), robot.drives.end(),
                                    [&](const Drive& d) { return d.joint.text == joint.name; });
    if (drive == robot.drives.end()) return std::nullopt;
    joints.push_back(joint.name);
    start.push_back(scene.joints[static_cast<std::size_t>(drive - robot.drives.begin())].si());
  }
  if (joints.size() < kLeastJoints) return std::nullopt;
  std::reverse(joints.begin(), joints.end());
  std::reverse(start.begin(), start.end());
  const Vec3 points(robot.points[0], robot.points[1], robot.points[2]);
  if (points.isZero()) return std::nullopt;
  auto chain = robot::Chain::create(*robot.model, robot.tcp.text, joints, from_x(points));
  if (!chain.ok()) return std::nullopt;
  const auto& p = scene.base_position;
  const auto& [w, x, y, z] = scene.base_turn.rotation;
  return Arm(std::move(chain).value(), std::move(start), Pose{{p[0], p[1], p[2]}, {w, x, y, z}});
}

std::optional<Shortfall> Arm::misses(double x, double y, double z) {
  const std::array<double, 3> key = {x, y, z};
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  if (known_.size() >= kMostPlaces) return std::nullopt;
  return known_[key] = solve(base_.inverse().apply({x, y, z}));
}

std::optional<Shortfall> Arm::solve(const Vec3& at) const {
  Mat3 down;  // the chain's x axis is the way the tool points
  down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  const Quat eighth(std::sqrt((1 + std::sqrt(0.5)) / 2), 0, 0, std::sqrt((1 - std::sqrt(0.5)) / 2));
  constexpr robot::IkOptions kNear = {.position_tolerance = 1e-4, .rotation_tolerance = 1e-3};
  constexpr double kMetresPerRadian = 0.1;  // which miss is the least
  // Outward from the base first: that is where an arm's own plane lies.
  Quat yaw = heading(at.x(), at.y());
  std::optional<Shortfall> least;
  for (int i = 0; i < 8; ++i, yaw = eighth * yaw) {
    std::vector<double> q = start_;
    const Pose target{at, yaw * Quat(down)};
    // From the scene's joints, and once more from wherever that got stuck.
    for (int attempt = 0; attempt < 2; ++attempt) {
      const robot::IkResult result = robot::solve_ik(chain_, target, q, kNear);
      if (result.converged) return std::nullopt;
      const auto weight = [](const Shortfall& miss) {
        return miss.position + kMetresPerRadian * miss.rotation;
      };
      const Shortfall miss{result.position_error, result.rotation_error};
      if (!least || weight(miss) < weight(*least)) least = miss;
    }
  }
  return least;
}

}  // namespace probe::sema
