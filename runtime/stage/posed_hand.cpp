// Forward kinematics and the vertices of shapes.
#include "runtime/stage/posed_hand.h"

#include <algorithm>

namespace probe::stage {
namespace {

bool is_finger(const robot::Robot& robot, const std::string& joint) {
  const auto& names = robot.control.finger_joints;
  return std::find(names.begin(), names.end(), joint) != names.end();
}

// The y of a part's section at x: of all lines between two of its vertices.
void add_section(const Points& part, double x, Interval* y) {
  for (const Vec3& a : part) {
    for (const Vec3& b : part) {
      if (!(a.x() <= x && b.x() >= x) || b.x() - a.x() < 1e-9) continue;
      y->add(a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x()));
    }
  }
}

}  // namespace

void Interval::add(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

PosedHand::PosedHand(const robot::Robot& robot, const UrdfParts& parts, const robot::Tree& tree,
                     double grip)
    : parts_(parts), poses_(tree.link_count()) {
  std::vector<double> q;
  for (const std::string& name : robot.joints) {
    const robot::Joint& joint =
        parts.model.joints[static_cast<std::size_t>(parts.model.find_joint(name))];
    const bool limited = joint.kind != robot::JointKind::kContinuous;
    q.push_back(
        is_finger(robot, name) ? (limited ? std::clamp(grip, joint.lower, joint.upper) : grip) : 0);
  }
  tree.link_poses(q, poses_);
  to_tcp_ = pose(robot.tcp_link).inverse();
}

Pose PosedHand::pose(const std::string& link) const {
  return poses_[static_cast<std::size_t>(parts_.model.find_link(link))];
}

Vec3 PosedHand::way_of(const robot::Finger& finger) const {
  return (to_tcp_ * pose(finger.link)).rotation * finger.opens;
}

std::vector<Points> PosedHand::parts(std::size_t link, const Mat3& frame) const {
  std::vector<Points> out;
  const auto& shape = parts_.shapes[link];
  if (shape == nullptr) return out;
  const Pose at = in_tcp(link);
  for (const scene::ConvexPart& part : shape->parts) {
    Points& points = out.emplace_back();
    for (const Vec3& vertex : part.vertices) {
      points.push_back(frame.transpose() * at.apply(vertex + shape->center_of_mass));
    }
  }
  return out;
}

PartsExtent extent_of(const std::vector<Points>& parts, double section) {
  PartsExtent out;
  for (const Points& part : parts) {
    add_section(part, section, &out.inner);
    for (const Vec3& p : part) {
      out.x.add(p.x());
      out.y.add(p.y());
      out.z.add(p.z());
    }
  }
  return out;
}

}  // namespace probe::stage
