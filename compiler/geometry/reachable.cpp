#include "compiler/geometry/reachable.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/trig.h"
#include "runtime/robot/ik.h"

namespace probe::sema {
namespace {

// A place and a downward direction fix five degrees of freedom. An arm with fewer joints takes such
// a pose only by how it is built (one that moves in the plane, with a lift), and how it would grasp
// instead is not known here: it is asked for the place alone. One of two joints has no volume at
// all.
constexpr std::size_t kPoseJoints = 5, kPlaceJoints = 3;
constexpr double kUnlimited = 3.1;  // rad; of joints without limits
constexpr double kLever = 0.1;      // m that a radian counts as

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

// The chain's x axis, which is the way the tool points, straight down.
Quat downwards() {
  Mat3 down;
  down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  return Quat(down);
}

void keep_least(std::optional<Shortfall>& least, const Shortfall& miss) {
  constexpr double kMetresPerRadian = 0.1;
  const auto weight = [](const Shortfall& of) {
    return of.position + kMetresPerRadian * of.rotation;
  };
  if (!least || weight(miss) < weight(*least)) least = miss;
}

}  // namespace

double distance_to_base(const Scene& scene, const Start::Placed& placed) {
  const double dx = placed.x - scene.base_position[0];
  const double dy = placed.y - scene.base_position[1];
  return std::sqrt(dx * dx + dy * dy);
}

bool is_in_annulus(const Robot& robot, double distance) {
  return robot.reach_max == 0 || (distance >= robot.reach_min && distance <= robot.reach_max);
}

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
  if (joints.size() < kPlaceJoints) return std::nullopt;
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
  const Vec3 at = base_.inverse().apply({x, y, z});
  return known_[key] = chain_.joint_count() < kPoseJoints ? solve_place(at) : solve(at);
}

Shortfall Arm::shortfall(const Vec3& at, std::span<const double> q,
                         const robot::IkResult& result) const {
  const Vec3 up = base_.rotation.conjugate() * Vec3::UnitZ();
  return {result.position_error, result.rotation_error, up.dot(chain_.pose(q).position - at)};
}

// The place alone, and then as nearly downwards as the arm gets there.
std::optional<Shortfall> Arm::solve_place(const Vec3& at) const {
  constexpr double kThere = 1e-3, kAslant = 0.5;  // m; cosine of 60 degrees
  const Vec3 down = base_.rotation.conjugate() * -Vec3::UnitZ();
  std::optional<Shortfall> least;
  for (int from = 0; from < 5; ++from) {
    std::vector<double> q = start_;
    // A quarter and three quarters of each joint's range, the first joint and the others.
    for (std::size_t i = 0; from > 0 && i < q.size(); ++i) {
      const bool is_far = i == 0 ? from % 2 == 0 : from > 2;
      const double lower = std::max(chain_.lower()[i], -kUnlimited);
      const double upper = std::min(chain_.upper()[i], kUnlimited);
      q[i] = lower + (upper - lower) * (is_far ? 0.75 : 0.25);
    }
    for (const double lever : {0.0, kLever}) {
      const Pose target{at, heading(at.x(), at.y()) * downwards()};
      std::vector<double> tried = q;
      const robot::IkResult result =
          robot::solve_ik(chain_, target, tried,
                          {.position_tolerance = 1e-4, .rotation_tolerance = 1e-3, .lever = lever});
      if (lever == 0) q = tried;
      Shortfall miss = shortfall(at, tried, result);
      const double cosine =
          std::clamp((chain_.pose(tried).rotation * Vec3::UnitX()).dot(down), -1.0, 1.0);
      if (miss.position < kThere && cosine >= kAslant) return std::nullopt;
      miss.rotation = cosine >= kAslant ? 0 : portable_acos(cosine);
      keep_least(least, miss);
    }
  }
  return least;
}

std::optional<Shortfall> Arm::solve(const Vec3& at) const {
  const Quat eighth(std::sqrt((1 + std::sqrt(0.5)) / 2), 0, 0, std::sqrt((1 - std::sqrt(0.5)) / 2));
  constexpr robot::IkOptions kNear = {.position_tolerance = 1e-4, .rotation_tolerance = 1e-3};
  // Outward from the base first: that is where an arm's own plane lies.
  Quat yaw = heading(at.x(), at.y());
  std::optional<Shortfall> least;
  for (int i = 0; i < 8; ++i, yaw = eighth * yaw) {
    std::vector<double> q = start_;
    const Pose target{at, yaw * downwards()};
    // From the scene's joints, and once more from wherever that got stuck.
    for (int attempt = 0; attempt < 2; ++attempt) {
      const robot::IkResult result = robot::solve_ik(chain_, target, q, kNear);
      if (result.converged) return std::nullopt;
      keep_least(least, shortfall(at, q, result));
    }
  }
  return least;
}

}  // namespace probe::sema
