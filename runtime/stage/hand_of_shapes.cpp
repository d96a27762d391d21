// In: a robot with its fingers and joints, the convex parts of its links. Out: its grasp frame and
// extents along that frame's axes. First the fingers are opened, or brought to where they face one
// another if they turn, and the frame is found from the way they close and the side their bodies
// are on; then, in it, the fingers are measured (those that turn by turning_hand), and the links
// that move with the tool centre point are the palm. Lengths in m.
#include "runtime/stage/hand_of_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/stage/posed_hand.h"
#include "runtime/stage/turning_hand.h"

namespace probe::stage {
namespace {

constexpr double kOpposed = 0.9;  // of the cosine between one finger's way and the other's
constexpr double kSkew = 0.05;  // rad; an axis nearer than this to one of the frame's is that axis
constexpr double kPalmDepth = 0.06;     // m; what is farther behind the fingertips' root is wrist
constexpr double kThinMargin = 0.0005;  // m wider than the gap of the closed fingers

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

// What a hand of fingers that slide is at the height of the tool centre point, open and shut.
bool measure_sliding(const PosedHand& open, const PosedHand& closed,
                     const std::array<std::size_t, 2>& links, const Mat3& frame,
                     robot::HandShape* shape) {
  const PartsExtent plus = extent_of(open.parts(links[0], frame), 0);
  const PartsExtent minus = extent_of(open.parts(links[1], frame), 0);
  if (plus.inner.empty() || minus.inner.empty()) return false;
  shape->tip_below = std::max(plus.x.high, minus.x.high);
  shape->opening_half = std::min(plus.inner.low, -minus.inner.high);
  shape->outside_half = std::max(plus.y.high, -minus.y.low);
  for (const PartsExtent* finger : {&plus, &minus}) {
    shape->finger_half = std::max({shape->finger_half, finger->z.high, -finger->z.low});
  }
  const PartsExtent shut_plus = extent_of(closed.parts(links[0], frame), 0);
  const PartsExtent shut_minus = extent_of(closed.parts(links[1], frame), 0);
  shape->thinnest = std::max(0.0, shut_plus.inner.low - shut_minus.inner.high) + kThinMargin;
  if (!(shape->opening_half > 0)) return false;
  for (std::size_t i = 0; i < shape->tapered.size(); ++i) {
    // Not quite at the tips, where there is no section.
    const double share =
        std::max(0.02, static_cast<double>(i) / static_cast<double>(shape->tapered.size() - 1));
    const double at = shape->tip_below - share * (shape->tip_below + shape->palm_above);
    for (const std::size_t link : links) {
      const Interval section = extent_of(open.parts(link, frame), at).inner;
      if (section.empty()) continue;
      shape->tapered[i] = std::max({shape->tapered[i], section.high, -section.low});
    }
    if (shape->tapered[i] <= 0) shape->tapered[i] = shape->outside_half;
  }
  return true;
}

// The palm is what moves with the tool centre point; a hand without such links ends at its fingers
// (false).
bool measure_palm(const PosedHand& open, const robot::Robot& robot, const robot::RobotModel& model,
                  const std::array<std::size_t, 2>& links, const Mat3& frame,
                  robot::HandShape* shape) {
  const int tcp = model.find_link(robot.tcp_link);
  Interval x, y, z;
  std::vector<Points> palm;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    if (link == links[0] || link == links[1] || !rigid_with(model, static_cast<int>(link), tcp)) {
      continue;
    }
    for (Points& part : open.parts(link, frame)) palm.push_back(std::move(part));
  }
  for (const Points& part : palm) {
    for (const Vec3& p : part) x.add(p.x());
  }
  if (x.empty()) {
    for (const std::size_t link : links) x.add(extent_of(open.parts(link, frame), 0).x.low);
    x.high = x.low;
  }
  for (const Points& part : palm) {
    for (const Vec3& p : part) {
      if (p.x() < x.high - kPalmDepth) continue;
      y.add(p.y());
      z.add(p.z());
    }
  }
  shape->palm_above = std::max(0.0, -x.high);
  if (palm.empty()) return false;
  shape->palm_half = std::max(y.high, -y.low);
  shape->palm_back = std::max(0.0, -z.low);
  shape->palm_front = std::max(0.0, z.high);
  return true;
}

}  // namespace

std::optional<robot::Hand> hand_of_shapes(const robot::Robot& robot, const UrdfParts& parts) {
  if (robot.fingers.size() != 2 || parts.model.find_link(robot.tcp_link) < 0) return std::nullopt;
  const auto tree = robot::Tree::create(parts.model, robot.joints);
  if (!tree.ok()) return std::nullopt;
  std::array<std::size_t, 2> links{};
  for (std::size_t k = 0; k < 2; ++k) {
    links[k] = static_cast<std::size_t>(parts.model.find_link(robot.fingers[k].link));
    if (parts.shapes[links[k]] == nullptr) return std::nullopt;
  }
  // Fingers that turn face one another somewhere on their way.
  const bool turn = fingers_turn(robot);
  const auto facing =
      turn ? facing_grip(robot, parts, *tree) : std::optional(robot.control.grip_open);
  if (!facing) return std::nullopt;
  const PosedHand open(robot, parts, *tree, *facing);
  const Vec3 ways[2] = {open.way_of(robot.fingers[0]), open.way_of(robot.fingers[1])};
  if (ways[0].dot(ways[1]) > -kOpposed) return std::nullopt;

  const Vec3 closes = snapped((ways[0] - ways[1]).normalized());
  std::vector<Points> fingers = open.parts(links[0], Mat3::Identity());
  for (Points& part : open.parts(links[1], Mat3::Identity())) fingers.push_back(std::move(part));
  const auto frame = grasp_frame(closes, fingers);
  if (!frame) return std::nullopt;

  robot::Hand hand;
  hand.approach = Quat(*frame).normalized();
  robot::HandShape& shape = hand.shape;
  const bool has_palm = measure_palm(open, robot, parts.model, links, *frame, &shape);
  const PosedHand closed(robot, parts, *tree, robot.control.grip_closed);
  const bool measured = turn ? measure_turning(robot, parts, *tree, links, *frame, &shape)
                             : measure_sliding(open, closed, links, *frame, &shape);
  if (!measured) return std::nullopt;
  if (!has_palm) {
    shape.palm_half = shape.outside_half;
    shape.palm_back = shape.palm_front = shape.finger_half;
  }
  return hand;
}

}  // namespace probe::stage
