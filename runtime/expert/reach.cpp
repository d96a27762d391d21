// Chained inverse kinematics.
#include "runtime/expert/reach.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "runtime/expert/servo.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/ik.h"
#include "runtime/robot/interpolated.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {

Result<Reach> Reach::create(const robot::Robot& robot) {
  if (!robot.hand) {
    return Failure{Fault::kNoSkill,
                   fmt::format("{}; the robot `{}` has {}", policy::kOtherHand, robot.name,
                               robot.fingers.empty() ? "no fingers" : "others"),
                   ""};
  }
  const robot::RobotModel& model = *robot.model;
  const int tcp = model.find_link(robot.tcp_link);
  if (tcp < 0) {
    return Failure{Fault::kUrdf, fmt::format("no link is named `{}`", robot.tcp_link), model.path};
  }
  std::vector<std::string> joints;
  // From the tool down to the first joint that moves, which a fixed way leads to.
  double longest = 0, below_first = 0;
  Vec3 shoulder = Vec3::Zero();
  for (int l = tcp; model.links[std::size_t(l)].parent_joint >= 0;) {
    const robot::Joint& joint = model.joints[std::size_t(model.links[std::size_t(l)].parent_joint)];
    const bool moves = joint.kind != robot::JointKind::kFixed && joint.mimic < 0;
    if (moves) joints.push_back(joint.name);
    // What lies below a joint is as far from it as its links are long.
    shoulder = joint.origin.apply(shoulder);
    below_first += joint.origin.position.norm();
    if (joint.kind == robot::JointKind::kPrismatic)
      below_first += std::max(std::abs(joint.lower), std::abs(joint.upper));
    if (moves) {
      longest = below_first - joint.origin.position.norm();
      shoulder = joint.origin.position;
    }
    l = joint.parent_link;
  }
  std::reverse(joints.begin(), joints.end());
  PROBE_ASSIGN(robot::Chain chain,
               robot::Chain::create(model, robot.tcp_link, joints, robot.hand->approach));
  if (chain.joint_count() == 0) {
    return Failure{Fault::kUrdf, fmt::format("no joint moves the link `{}`", robot.tcp_link),
                   model.path};
  }
  Reach made(std::move(chain), *robot.hand, shoulder, longest);
  made.ignores_limits_ = std::holds_alternative<robot::EeDeltaInterpolated>(robot.law);
  return made;
}

double Reach::beyond(const Vec3& place) const {
  return std::max(0.0, (place - shoulder_).norm() - longest_);
}

bool Reach::come_to(const Pose& at, std::span<double> joints) const {
  if (!ignores_limits_) {
    return robot::solve_ik(chain_, at, joints,
                           {.position_tolerance = 1e-5, .rotation_tolerance = 1e-5})
        .converged;
  }
  if (!robot::approach_pose(chain_, at, joints)) return false;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j] < chain_.lower()[j] || joints[j] > chain_.upper()[j]) return false;
  }
  return true;
}

std::optional<std::vector<JointVector>> Reach::follow(std::span<const double> q,
                                                      std::span<const Pose> way) const {
  if (q.size() < chain_.joint_count()) return std::nullopt;
  std::vector<JointVector> found;
  std::array<double, robot::kMaxChainJoints> joints{};
  const std::span<double> now = std::span(joints).first(chain_.joint_count());
  std::copy_n(q.begin(), now.size(), now.begin());
  Pose at = chain_.pose(now);
  constexpr int kMostSolves = 200;  // 10 m of way, or 60 rad
  for (const Pose& goal : way) {
    for (int i = 0; i < kMostSolves; ++i) {
      at = stepped(at, goal, 0.05, 0.3);
      if (!come_to(at, now)) return std::nullopt;
      const robot::PoseError left = robot::pose_error(at, goal);
      if (left.position < 1e-9 && left.rotation < 1e-9) break;
    }
    found.push_back(Eigen::Map<const JointVector>(now.data(), Eigen::Index(now.size())));
  }
  return found;
}

}  // namespace probe::expert
