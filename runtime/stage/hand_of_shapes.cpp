// In: a robot with its fingers and joints, the convex parts of its links. Out: its grasp frame and
// extents along that frame's axes. First the fingers are opened and the frame is found from the way
// they close and the side their bodies are on; then, in it, the fingers are measured open and shut,
// and the links that move with the tool centre point are the palm. Lengths in m.
#include "runtime/stage/hand_of_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/robot/kinematics.h"

namespace probe::stage {
namespace {

constexpr double kOpposed = 0.9;  // of the cosine between one finger's way and the other's
constexpr double kSkew = 0.05;  // rad; an axis nearer than this to one of the frame's is that axis
constexpr double kPalmDepth = 0.06;     // m; what is farther behind the fingertips' root is wrist
constexpr double kThinMargin = 0.0005;  // m wider than the gap of the closed fingers

using Points = std::vector<Vec3>;
constexpr double kFar = std::numeric_limits<double>::infinity();

struct Interval {
  double low = kFar, high = -kFar;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

// The hand's links with the fingers at one position, in the frame of the tool centre point's link.
class Posed {
 public:
  Posed(const robot::Robot& robot, const UrdfParts& parts, const robot::Tree& tree, double grip)
      : parts_(parts), poses_(tree.link_count()) {
    std::vector<double> q;
    for (const std::string& name : robot.joints) {
      const robot::Joint& joint =
          parts.model.joints[static_cast<std::size_t>(parts.model.find_joint(name))];
      const bool limited = joint.kind != robot::JointKind::kContinuous;
      q.push_back(is_finger(robot, name)
                      ? (limited ? std::clamp(grip, joint.lower, joint.upper) : grip)
                      : 0);
    }
    tree.link_poses(q, poses_);
    to_tcp_ = pose(robot.tcp_link).inverse();
  }

  Pose pose(const std::string& link) const {
    return poses_[static_cast<std::size_t>(parts_.model.find_link(link))];
  }
  Pose in_tcp(std::size_t link) const { return to_tcp_ * poses_[link]; }

  // Vertices of each convex part of a link, turned into `frame` (of the tool's link).
  std::vector<Points> parts(std::size_t link, const Mat3& frame) const {
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

 private:
  static bool is_finger(const robot::Robot& robot, const std::string& joint) {
    const auto& names = robot.control.finger_joints;
    return std::find(names.begin(), names.end(), joint) != names.end();
  }

  const UrdfParts& parts_;
  std::vector<Pose> poses_;
  Pose to_tcp_;
};

// The y of a part's section at x: of all lines between two of its vertices.
void add_section(const Points& part, double x, Interval* y) {
  for (const Vec3& a : part) {
    for (const Vec3& b : part) {
      if (!(a.x() <= x && b.x() >= x) || b.x() - a.x() < 1e-9) continue;
      y->add(a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x()));
    }
  }
}

// How far a finger's inner face is from the middle at x, and all of it.
struct FingerExtent {
  Interval inner, x, y, z;
};

FingerExtent extent_of(const std::vector<Points>& parts, double section) {
  FingerExtent out;
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

// Links on the same rigid body as the tool centre point.
bool rigid_with(const robot::RobotModel& model, int a, int b) {
  const auto root = [&](int link) {
    while (true) {
      const int joint = model.links[static_cast<std::size_t>(link)].parent_joint;
      if (joint < 0 ||
          model.joints[static_cast<std::size_t>(joint)].kind != robot::JointKind::kFixed) {
        return link;
      }
      link = model.joints[static_cast<std::size_t>(joint)].parent_link;
    }
  };
  return root(a) == root(b);
}

Vec3 snapped(const Vec3& axis) {
  int most = 0;
  axis.cwiseAbs().maxCoeff(&most);
  const Vec3 near = Vec3::Unit(most) * (axis[most] < 0 ? -1 : 1);
  return axis.cross(near).norm() < std::sin(kSkew) ? near : axis;
}

// From the bodies of the fingers' links towards their tips, across the way they close.
std::optional<Mat3> grasp_frame(const Vec3& closes, const std::vector<Points>& fingers) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const Points& part : fingers) {
    for (const Vec3& p : part) sum += p, ++count;
  }
  if (count == 0) return std::nullopt;
  // The tool centre point is between the tips, the fingers' middle behind it.
  Vec3 points = -sum / count;
  points -= closes * closes.dot(points);
  if (!(points.norm() > 1e-6)) return std::nullopt;
  const Vec3 x = snapped(points.normalized());
  Mat3 frame;
  frame << x, closes, x.cross(closes);
  return frame;
}

}  // namespace

std::optional<robot::Hand> hand_of_shapes(const robot::Robot& robot, const UrdfParts& parts) {
  if (robot.fingers.size() != 2 || parts.model.find_link(robot.tcp_link) < 0) return std::nullopt;
  const auto tree = robot::Tree::create(parts.model, robot.joints);
  if (!tree.ok()) return std::nullopt;
  const Posed open(robot, parts, *tree, robot.control.grip_open);
  const Posed closed(robot, parts, *tree, robot.control.grip_closed);
  std::size_t links[2];
  Vec3 ways[2];
  for (std::size_t k = 0; k < 2; ++k) {
    links[k] = static_cast<std::size_t>(parts.model.find_link(robot.fingers[k].link));
    if (parts.shapes[links[k]] == nullptr) return std::nullopt;
    ways[k] = open.in_tcp(links[k]).rotation * robot.fingers[k].opens;
  }
  if (ways[0].dot(ways[1]) > -kOpposed) return std::nullopt;

  const Vec3 closes = snapped((ways[0] - ways[1]).normalized());
  std::vector<Points> fingers = open.parts(links[0], Mat3::Identity());
  for (Points& part : open.parts(links[1], Mat3::Identity())) fingers.push_back(std::move(part));
  const auto frame = grasp_frame(closes, fingers);
  if (!frame) return std::nullopt;

  robot::Hand hand;
  hand.approach = Quat(*frame).normalized();
  robot::HandShape& shape = hand.shape;
  const FingerExtent plus = extent_of(open.parts(links[0], *frame), 0);
  const FingerExtent minus = extent_of(open.parts(links[1], *frame), 0);
  if (plus.inner.empty() || minus.inner.empty()) return std::nullopt;
  shape.tip_below = std::max(plus.x.high, minus.x.high);
  shape.opening_half = std::min(plus.inner.low, -minus.inner.high);
  shape.outside_half = std::max(plus.y.high, -minus.y.low);
  for (const FingerExtent* finger : {&plus, &minus}) {
    shape.finger_half = std::max({shape.finger_half, finger->z.high, -finger->z.low});
  }
  const FingerExtent shut_plus = extent_of(closed.parts(links[0], *frame), 0);
  const FingerExtent shut_minus = extent_of(closed.parts(links[1], *frame), 0);
  shape.thinnest = std::max(0.0, shut_plus.inner.low - shut_minus.inner.high) + kThinMargin;
  if (!(shape.opening_half > 0)) return std::nullopt;

  // The palm is what moves with the tool centre point; a hand without such links ends at its
  // fingers.
  const int tcp = parts.model.find_link(robot.tcp_link);
  Interval x, y, z;
  std::vector<Points> palm;
  for (std::size_t link = 0; link < parts.model.links.size(); ++link) {
    if (link == links[0] || link == links[1] ||
        !rigid_with(parts.model, static_cast<int>(link), tcp)) {
      continue;
    }
    for (Points& part : open.parts(link, *frame)) palm.push_back(std::move(part));
  }
  for (const Points& part : palm) {
    for (const Vec3& p : part) x.add(p.x());
  }
  if (x.empty()) x.add(std::min(plus.x.low, minus.x.low));
  for (const Points& part : palm) {
    for (const Vec3& p : part) {
      if (p.x() < x.high - kPalmDepth) continue;
      y.add(p.y());
      z.add(p.z());
    }
  }
  shape.palm_above = std::max(0.0, -x.high);
  shape.palm_half = y.empty() ? shape.outside_half : std::max(y.high, -y.low);
  shape.palm_back = z.empty() ? shape.finger_half : std::max(0.0, -z.low);
  shape.palm_front = z.empty() ? shape.finger_half : std::max(0.0, z.high);
  for (std::size_t i = 0; i < shape.tapered.size(); ++i) {
    // Not quite at the tips, where there is no section.
    const double share =
        std::max(0.02, static_cast<double>(i) / static_cast<double>(shape.tapered.size() - 1));
    const double at = shape.tip_below - share * (shape.tip_below + shape.palm_above);
    for (std::size_t k = 0; k < 2; ++k) {
      const Interval section = extent_of(open.parts(links[k], *frame), at).inner;
      if (section.empty()) continue;
      shape.tapered[i] = std::max({shape.tapered[i], section.high, -section.low});
    }
    if (shape.tapered[i] <= 0) shape.tapered[i] = shape.outside_half;
  }
  return hand;
}

}  // namespace probe::stage
