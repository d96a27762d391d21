// Poses by products along the tree; Jacobian columns from axes and origins.
#include "runtime/robot/kinematics.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "runtime/base/check.h"
#include "runtime/robot/rotation.h"

namespace probe::robot {
namespace {

constexpr double kNoLimit = 1e9;  // rad, in place of the limits that a continuous joint has not
constexpr std::size_t kMaxChainSegments = 2 * kMaxChainJoints;

bool turns(JointKind kind) {
  return kind == JointKind::kRevolute || kind == JointKind::kContinuous;
}

// Where a joint's position comes from: scale * q[source] + offset.
struct Drive {
  int source = -1;
  double scale = 0, offset = 0;
};

int index_of(std::span<const std::string> names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : int(found - names.begin());
}

Drive drive_of(const RobotModel& model, const Joint& joint, std::span<const std::string> names) {
  if (const int named = index_of(names, joint.name); named >= 0) return {named, 1, 0};
  if (joint.mimic >= 0) {
    const int leader = index_of(names, model.joints[std::size_t(joint.mimic)].name);
    if (leader >= 0) return {leader, joint.mimic_scale, joint.mimic_offset};
  }
  const bool limited = joint.kind != JointKind::kContinuous && joint.kind != JointKind::kFixed;
  return {-1, 0, limited ? std::clamp(0.0, joint.lower, joint.upper) : 0.0};
}

Status check_names(const RobotModel& model, std::span<const std::string> names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int j = model.find_joint(names[i]);
    if (j < 0) {
      return Failure{Fault::kUrdf, fmt::format("no joint is named `{}`", names[i]), model.path};
    }
    if (model.joints[std::size_t(j)].kind == JointKind::kFixed) {
      return Failure{Fault::kUrdf, fmt::format("joint `{}` is fixed, it has no position", names[i]),
                     model.path};
    }
    if (index_of(names.first(i), names[i]) >= 0) {
      return Failure{Fault::kUrdf, fmt::format("joint `{}` is named twice", names[i]), model.path};
    }
  }
  return {};
}

}  // namespace

Result<Tree> Tree::create(const RobotModel& model, std::span<const std::string> joints) {
  PROBE_TRY(check_names(model, joints));
  Tree tree;
  tree.joints_ = joints.size();
  tree.root_ = model.root;
  tree.step_of_link_.assign(model.links.size(), -1);
  std::vector<int> reached{model.root};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const Joint& joint : model.joints) {
      if (joint.parent_link != reached[i]) continue;
      const Drive drive = drive_of(model, joint, joints);
      tree.step_of_link_[std::size_t(joint.child_link)] = int(tree.steps_.size());
      tree.steps_.push_back({reached[i], joint.child_link, joint.kind, joint.origin, joint.axis,
                             drive.source, drive.scale, drive.offset});
      reached.push_back(joint.child_link);
    }
  }
  return tree;
}

void Tree::link_poses(std::span<const double> q, std::span<Pose> poses) const {
  PROBE_CHECK(q.size() == joints_ && poses.size() == link_count(),
              "one q a joint, one pose a link");
  poses[std::size_t(root_)] = Pose{};
  for (const Step& step : steps_) {
    const Pose frame = poses[std::size_t(step.parent)] * step.origin;
    Pose& out = poses[std::size_t(step.link)];
    out = frame;
    if (step.kind == JointKind::kFixed) continue;
    const double value =
        step.offset + (step.source >= 0 ? step.scale * q[std::size_t(step.source)] : 0.0);
    if (turns(step.kind)) {
      out.rotation = (frame.rotation * from_rotation_vector(step.axis * value)).normalized();
    } else {
      out.position += frame.rotation * (step.axis * value);
    }
  }
}

void Tree::jacobian(std::span<const Pose> poses, int link, Eigen::Ref<Eigen::MatrixXd> out) const {
  PROBE_CHECK(out.rows() == 6 && out.cols() == Eigen::Index(joints_), "6 rows, a column a joint");
  PROBE_CHECK(link >= 0 && std::size_t(link) < link_count(), "the link is one of the model's");
  out.setZero();
  const Vec3 end = poses[std::size_t(link)].position;
  for (int s = step_of_link_[std::size_t(link)]; s >= 0;
       s = step_of_link_[std::size_t(steps_[std::size_t(s)].parent)]) {
    const Step& step = steps_[std::size_t(s)];
    if (step.kind == JointKind::kFixed || step.source < 0) continue;
    // A turn about its own axis leaves the axis where it is, so the child's frame will do.
    const Pose& here = poses[std::size_t(step.link)];
    const Vec3 axis = here.rotation * step.axis * step.scale;
    if (turns(step.kind)) {
      out.col(step.source).head<3>() += axis.cross(end - here.position);
      out.col(step.source).tail<3>() += axis;
    } else {
      out.col(step.source).head<3>() += axis;
    }
  }
}

Result<Chain> Chain::create(const RobotModel& model, std::string_view link,
                            std::span<const std::string> joints, const Quat& tip) {
  PROBE_TRY(check_names(model, joints));
  const int end = model.find_link(link);
  if (end < 0) return Failure{Fault::kUrdf, fmt::format("no link is named `{}`", link), model.path};
  if (joints.size() > std::size_t(kMaxChainJoints)) {
    return Failure{
        Fault::kUrdf,
        fmt::format("{} joints in a chain, at most {} are handled", joints.size(), kMaxChainJoints),
        model.path};
  }
  std::vector<int> path;
  for (int l = end; model.links[std::size_t(l)].parent_joint >= 0;) {
    const int j = model.links[std::size_t(l)].parent_joint;
    path.push_back(j);
    l = model.joints[std::size_t(j)].parent_link;
  }
  std::reverse(path.begin(), path.end());

  Chain chain;
  chain.lower_.assign(joints.size(), 0);
  chain.upper_.assign(joints.size(), 0);
  std::vector<bool> used(joints.size(), false);
  Pose fixed;  // since the last moving frame
  for (const int j : path) {
    const Joint& joint = model.joints[std::size_t(j)];
    fixed = fixed * joint.origin;
    if (joint.kind == JointKind::kFixed) continue;
    const Drive drive = drive_of(model, joint, joints);
    if (drive.source < 0) {
      return Failure{
          Fault::kUrdf,
          fmt::format("joint `{}` lies on the way to `{}`, but is not driven", joint.name, link),
          model.path};
    }
    const auto source = std::size_t(drive.source);
    used[source] = true;
    const int leader = model.find_joint(joints[source]);
    const Joint& limited = model.joints[std::size_t(leader)];
    const bool free = limited.kind == JointKind::kContinuous;
    chain.lower_[source] = free ? -kNoLimit : limited.lower;
    chain.upper_[source] = free ? kNoLimit : limited.upper;
    chain.segments_.push_back({fixed.rotation.toRotationMatrix(), fixed.position, joint.kind,
                               joint.axis, drive.source, drive.scale, drive.offset});
    fixed = Pose{};
  }
  // Mimics can make more segments than joints; pose() keeps its axes on the stack.
  if (chain.segments_.size() > kMaxChainSegments) {
    return Failure{Fault::kUrdf,
                   fmt::format("{} moving joints on the way to `{}`, at most {} are handled",
                               chain.segments_.size(), link, kMaxChainSegments),
                   model.path};
  }
  chain.last_turn_ = (fixed.rotation * tip).toRotationMatrix();
  chain.last_shift_ = fixed.position;
  const auto stray = std::find(used.begin(), used.end(), false);
  if (stray != used.end()) {
    return Failure{Fault::kUrdf,
                   fmt::format("joint `{}` is not on the way to the link `{}`",
                               joints[std::size_t(stray - used.begin())], link),
                   model.path};
  }
  return chain;
}

Pose Chain::pose(std::span<const double> q) const {
  Jacobian unused;
  return pose(q, unused);
}

Pose Chain::pose(std::span<const double> q, Jacobian& out) const {
  PROBE_CHECK(q.size() == joint_count(), "one position a joint");
  struct Axis {
    Vec3 direction, origin;
  };
  std::array<Axis, kMaxChainSegments> axes;
  Mat3 turn = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    origin += turn * s.shift;
    turn = turn * s.turn;
    axes[i].direction = turn * s.axis;
    const double value = s.scale * q[std::size_t(s.source)] + s.offset;
    if (turns(s.kind)) {
      turn = turn * axis_rotation(s.axis, value);
    } else {
      origin += axes[i].direction * value;
    }
    axes[i].origin = origin;
  }
  const Vec3 end = origin + turn * last_shift_;
  out.setZero(6, Eigen::Index(joint_count()));
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& s = segments_[i];
    const Vec3 axis = axes[i].direction * s.scale;
    if (turns(s.kind)) {
      out.col(s.source).head<3>() += axis.cross(end - axes[i].origin);
      out.col(s.source).tail<3>() += axis;
    } else {
      out.col(s.source).head<3>() += axis;
    }
  }
  return {end, Quat(Mat3(turn * last_turn_)).normalized()};
}

}  // namespace probe::robot
