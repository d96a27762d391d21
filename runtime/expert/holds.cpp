// Solids of the part times ways to come to them, scored.
#include "runtime/expert/holds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "runtime/expert/around_solid.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kTight = 0.003;        // m between an open finger and the handle, at least
constexpr double kRoom = 0.0025;        // m between the hand and what it does not hold
constexpr double kRoomyEnough = 0.012;  // m; more earns nothing
constexpr std::array kBeside = {0.014, 0.009,
                                0.006};  // m between an open finger and the handle, a side
constexpr double kTipUnder = 0.012;      // m of the fingertips behind the point that they push at
// Cosines of 72 and 59 degrees: closing lines nearly across the way down, and where there are none.
constexpr double kUpright = 0.3, kLessUpright = 0.52;
constexpr double kStraight = -0.999;       // of the way down: fingers are upright
constexpr std::array kLeant = {0.5, 1.0};  // tangents of how far the hand leans back from a face
constexpr double kAgainst = 0.75;  // cosine between a face's normal and the way it is pushed
constexpr double kOverhang = -0.3, kMostOverhang = -0.7;  // of a face's normal, upwards
constexpr double kEdge = 0.005;                           // m: what is nearer is at the edge
constexpr double kNearBy = 0.6, kFarCost = 40;  // m from the base; cost of a square metre more
// Tangents of how far a hand leans over an edge, and m of the fingers behind it.
constexpr std::array kOver = {0.6, 1.0, 1.6};
constexpr std::array kHooked = {0.035, 0.025};
constexpr double kShallow = 20;     // cost of a m less
constexpr double kLevelFace = 0.1;  // of a face's normal, upwards: it stands upright
constexpr double kLeantCost = 0.5;  // an upright hand is stiffer
constexpr double kKnob = 0.03;      // m from the axis: what is nearer is turned about itself
constexpr std::array kOnFace = {0.0, 0.6, -0.6, 0.92, -0.92};  // of its half width and height
constexpr int kLooks = 5;                                      // at the way of the part

double closed_half(const robot::HandShape& hand) {
  if (!hand.turning.empty())
    return robot::outer_face(hand.turning.front(), hand.palm_above, hand.tip_below - kTipUnder);
  const double thick = hand.outside_at(hand.tip_below - kTipUnder) - hand.opening_half;
  return std::max(thick, 0.004) + 0.5 * hand.thinnest;
}

class Search {
 public:
  explicit Search(const HoldProblem& problem) : p_(problem) {
    for (const Surroundings::Body& body : p_.around->bodies) {
      if (body.fixture == p_.fixture) part_ = &body;
    }
    sign_ = p_.aim >= p_.joint.position ? 1 : -1;
    if (part_ == nullptr) return;
    axis_ = part_->pose.rotation * p_.joint.axis;
    point_ = part_->pose.apply(p_.joint.point);
    for (const Solid& solid : part_->solids)
      lever_ = std::max(lever_, lever(part_->pose.apply(solid.center())));
  }

  std::vector<Hold> run() {
    if (part_ == nullptr) return {};
    if (p_.hooks) {
      for (std::size_t s = 0; s < part_->solids.size(); ++s) hooks(static_cast<int>(s));
      sort();
      return std::move(found_);
    }
    ways_ = ways_to(part_->pose);
    for (std::size_t s = 0; s < part_->solids.size(); ++s) {
      grasps(static_cast<int>(s));
      pushes(static_cast<int>(s));
    }
    // A bar with others above and below it is held from in between, aslant.
    if (found_.empty()) {
      upright_ = kLessUpright;
      for (std::size_t s = 0; s < part_->solids.size(); ++s) grasps(static_cast<int>(s));
    }
    sort();
    return std::move(found_);
  }

 private:
  void sort() {
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Hold& a, const Hold& b) { return a.cost < b.cost; });
  }

  double lever(const Vec3& at) const {
    const Vec3 off = at - point_;
    return (off - axis_.dot(off) * axis_).norm();
  }
  // Which way a point of the part goes.
  Vec3 way_at(const Vec3& at) const {
    if (p_.joint.slides) return sign_ * axis_;
    const Vec3 way = sign_ * axis_.cross(at - point_);
    return way.norm() > 1e-9 ? Vec3(way.normalized()) : Vec3(Vec3::Zero());
  }
  // Near a hinge it takes force.
  double lever_cost(const Vec3& at) const {
    if (p_.joint.slides || lever_ < kKnob) return 0;
    return 2 * (1 - std::min(1.0, lever(at) / lever_));
  }
  double turn_cost(const Quat& turned, const Vec3& down) const {
    const double tilt = std::acos(std::clamp(-down.z(), -1.0, 1.0));
    const double turn = robot::to_rotation_vector(turned * p_.now.conjugate()).norm();
    return 0.7 * tilt + 0.1 * turn;
  }

  // Room for the hand where the part is and along its way; the least of it.
  double room_of(const Hold& hold) const {
    const HandBalls balls = balls_of(hold, p_.hand);
    double least = kRoomyEnough;
    for (int i = 0; i <= kLooks; ++i) {
      const double by = (p_.aim - p_.joint.position) * i / kLooks;
      const Pose at = moved_part(p_.joint, part_->pose, by);
      const Pose tool = tool_at(hold, at, p_.hand);
      const MovedPart moved{p_.fixture, at};
      // Of what is held or pushed only the fingers are near.
      least = std::min(
          least, p_.around->clearance(tool, balls.fingers, least, moved, {p_.fixture, hold.solid}));
      least = std::min(least, p_.around->clearance(tool, balls.rest, least, moved));
      if (least < kRoom) return least;
    }
    return least;
  }

  void add(Hold hold, double cost) {
    const double room = room_of(hold);
    if (room < kRoom) return;
    // An arm that is stretched does not come where it shall.
    const double far = (part_->pose.apply(hold.tool.position)).norm() - kNearBy;
    hold.cost =
        cost + 40 * (kRoomyEnough - room) + kFarCost * std::max(0.0, far) * std::max(0.0, far);
    found_.push_back(hold);
  }

  void grasps(int s) {
    const Solid& solid = part_->solids[static_cast<std::size_t>(s)];
    for (const FingersAround& way : fingers_around(solid, part_->pose, ways_, p_.hand, upright_))
      grasp(s, way.at, way.down, way.closing, way.half, way.share);
  }

  void grasp(int s, const Vec3& at, const Vec3& down, const Vec3& closing, double half,
             double share) {
    const Pose& pose = part_->pose;
    Hold hold;
    hold.solid = s;
    hold.turned = tool_frame(down, closing);
    hold.tool = pose.inverse() * Pose{at, hold.turned};
    const bool twists = !p_.joint.slides && lever(at) < kKnob;
    double cost = p_.grasps ? 0 : 1.5;
    cost += twists ? 0.5 * (1 - std::abs(down.dot(axis_)))
                   : 0.8 * (1 - std::abs(closing.dot(way_at(at))));
    cost += turn_cost(hold.turned, down) + lever_cost(at) + 0.1 * std::abs(share);
    for (const double beside : kBeside) {
      const double parted = half + beside;
      if (parted > p_.hand.opening_half) continue;
      hold.open = p_.hand.openness_for(parted);
      const std::size_t before = found_.size();
      // Where there is less room on one side, the fingers stand to the other.
      for (const double aside : {0.0, 0.5, -0.5}) {
        if (aside != 0 && beside < 2 * kTight) continue;
        hold.tool = pose.inverse() * Pose{at + aside * beside * closing, hold.turned};
        hold.follows = Follows::kRigid;
        const double more = cost + (aside != 0 ? 0.05 : 0);
        add(hold, more);
        if (!p_.joint.slides && !twists) {
          hold.follows = Follows::kUpright;
          add(hold, more + 0.4);
        }
        if (found_.size() > before) return;
      }
    }
  }

  void pushes(int s) {
    const Solid& solid = part_->solids[static_cast<std::size_t>(s)];
    const Pose& pose = part_->pose;
    for (int i = 0; i < 3; ++i) {
      for (const double side : {1.0, -1.0}) {
        const Vec3 normal = side * Vec3::Unit(i);
        for (const double u : kOnFace) {
          for (const double v : kOnFace) {
            Vec3 own = solid.center() + side * solid.half()[i] * Vec3::Unit(i);
            own[(i + 1) % 3] += u * solid.half()[(i + 1) % 3];
            own[(i + 2) % 3] += v * solid.half()[(i + 2) % 3];
            push(s, own, normal, pose);
          }
        }
      }
    }
  }

  void push(int s, const Vec3& contact, const Vec3& normal, const Pose& pose) {
    const Vec3 at = pose.apply(contact), out = pose.rotation * normal, way = way_at(at);
    if (-out.dot(way) < kAgainst || out.z() < kMostOverhang) return;
    // A face that hangs over meets upright fingers with its upper edge.
    if (out.z() < kOverhang) {
      const Vec3 up = (Vec3::UnitZ() - out.z() * out).normalized();
      if (way_out(part_->solids[static_cast<std::size_t>(s)], pose, at, up) > kEdge) return;
    }
    // Fingers straight down, their line along or across the face's normal.
    Vec3 flat(out.x(), out.y(), 0);
    flat = flat.norm() > 0.1 ? Vec3(flat.normalized()) : Vec3(Vec3::UnitY());
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Vec3 closing = quarter % 2 == 0 ? Vec3((1 - quarter) * flat)
                                            : Vec3((2 - quarter) * Vec3::UnitZ().cross(flat));
      Hold hold;
      hold.follows = Follows::kTouching;
      hold.solid = s;
      hold.contact = contact;
      hold.normal = normal;
      hold.open = 0;
      hold.turned = tool_frame(-Vec3::UnitZ(), closing);
      hold.tool = pose.inverse() * tool_at(hold, pose, p_.hand);
      const double cost = (p_.grasps ? 1.5 : 0) + lever_cost(at) + 2 * (1 + out.dot(way));
      add(hold, cost + turn_cost(hold.turned, -Vec3::UnitZ()));
      // Where what is above the face leaves upright hands no room.
      if (!p_.joint.slides || std::abs(out.z()) > kLevelFace) continue;
      for (const double leant : kLeant) {
        const Vec3 down = (-leant * flat - Vec3::UnitZ()).normalized();
        const Vec3 across = (closing - closing.dot(down) * down).normalized();
        hold.turned = tool_frame(down, across);
        hold.tool = pose.inverse() * tool_at(hold, pose, p_.hand);
        add(hold, cost + kLeantCost + turn_cost(hold.turned, down));
      }
    }
  }

  // Over the upper edge of a face that looks where the part comes from, closed fingers behind it.
  void hooks(int s) {
    if (!p_.joint.slides) return;
    const Solid& solid = part_->solids[static_cast<std::size_t>(s)];
    const Pose& pose = part_->pose;
    for (int i = 0; i < 3; ++i) {
      for (const double side : {1.0, -1.0}) {
        const Vec3 normal = side * Vec3::Unit(i), out = pose.rotation * normal;
        if (-out.dot(way_at(pose.apply(solid.center()))) < kAgainst) continue;
        if (std::abs(out.z()) > kLevelFace) continue;
        int up = (i + 1) % 3, along = (i + 2) % 3;
        const auto rise = [&](int axis) { return (pose.rotation * Vec3::Unit(axis)).z(); };
        if (std::abs(rise(up)) < std::abs(rise(along))) std::swap(up, along);
        for (const double share : kOnFace) {
          Vec3 edge = solid.center() + side * solid.half()[i] * Vec3::Unit(i);
          edge[up] += rise(up) > 0 ? solid.half()[up] : -solid.half()[up];
          edge[along] += share * solid.half()[along];
          hook(s, edge, normal, out);
        }
      }
    }
  }

  void hook(int s, const Vec3& edge, const Vec3& normal, const Vec3& out) {
    const Pose& pose = part_->pose;
    const Vec3 flat = Vec3(out.x(), out.y(), 0).normalized();
    Hold hold;
    hold.follows = Follows::kTouching;
    hold.solid = s;
    hold.contact = edge;
    hold.normal = normal;
    hold.open = 0;
    for (const double over : kOver) {
      const Vec3 down = (over * flat - Vec3::UnitZ()).normalized();
      for (const double sign : {1.0, -1.0}) {
        hold.turned = tool_frame(down, sign * Vec3::UnitZ().cross(flat));
        for (const double deep : kHooked) {
          hold.deep = deep;
          hold.tool = pose.inverse() * tool_at(hold, pose, p_.hand);
          add(hold, kShallow * (kHooked.front() - deep) + turn_cost(hold.turned, down));
        }
      }
    }
  }

  const HoldProblem& p_;
  const Surroundings::Body* part_ = nullptr;
  double sign_ = 1, lever_ = 0, upright_ = kUpright;
  Vec3 axis_ = Vec3::UnitX(), point_ = Vec3::Zero();
  std::vector<Vec3> ways_;
  std::vector<Hold> found_;
};

}  // namespace

Pose moved_part(const PartJoint& joint, const Pose& pose, double by) {
  Pose own;
  if (joint.slides) {
    own.position = by * joint.axis;
  } else {
    own.rotation = robot::from_rotation_vector(by * joint.axis);
    own.position = joint.point - own.rotation * joint.point;
  }
  return pose * own;
}

Pose tool_at(const Hold& hold, const Pose& part, const robot::HandShape& hand, double gap) {
  if (hold.follows == Follows::kRigid) return part * hold.tool;
  if (hold.follows == Follows::kUpright) return {part.apply(hold.tool.position), hold.turned};
  const Vec3 at = part.apply(hold.contact), out = part.rotation * hold.normal;
  const Vec3 flat(out.x(), out.y(), 0);
  const double across = flat.norm(), up = std::max(out.z(), 0.0);
  const Vec3 own = hold.turned.conjugate() * flat;
  const Vec3 down = hold.turned * Vec3::UnitX();
  // Half of the closed fingers towards the face; under a face that looks up they end at it.
  const double thick = std::abs(own.y()) > std::abs(own.z()) ? closed_half(hand) : hand.finger_half;
  Vec3 tool = at + gap * out;
  // Leant back from the face, their ends meet it with an edge.
  if (down.z() > kStraight) {
    const Vec3 off = (out - out.dot(down) * down).normalized();
    return {tool + thick * off + (hold.deep - hand.tip_below) * down, hold.turned};
  }
  if (across > 1e-6) tool += thick * flat / std::max({across, up, 1e-6});
  const double under = across > up ? kTipUnder * (across - up) / across : 0;
  tool.z() += hand.tip_below - under;
  return {tool, hold.turned};
}

HandBalls balls_of(const Hold& hold, const robot::HandShape& hand) {
  return hand_balls(hand, hold.pushes() ? 0 : hand.gap_at(hold.open));
}

Hold refined(const HoldProblem& problem, const Hold& hold, double openness) {
  if (hold.pushes()) return hold;
  const auto part =
      std::ranges::find(problem.around->bodies, problem.fixture, &Surroundings::Body::fixture);
  Hold best = hold;
  best.open = openness;
  const std::vector<Ball> fingers = balls_of(best, problem.hand).fingers;
  double most = -1;
  constexpr int kShifts = 10;  // mm to each side
  for (int i = 0; i <= 2 * kShifts; ++i) {
    const double shift = 0.001 * (i % 2 == 0 ? i / 2 : -(i + 1) / 2);
    Hold moved = hold;
    moved.tool.position += shift * (hold.tool.rotation * Vec3::UnitY());
    const Pose tool = tool_at(moved, part->pose, problem.hand);
    const double room = problem.around->clearance(tool, fingers, kRoomyEnough);
    if (room < most + 1e-4) continue;
    most = room;
    best.tool = moved.tool;
  }
  return best;
}

std::vector<Hold> hold_candidates(const HoldProblem& problem) { return Search(problem).run(); }

}  // namespace probe::expert
