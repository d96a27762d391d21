#include "runtime/expert/solids.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/expert/path_planner.h"

namespace probe::expert {
namespace {

const std::array<Vec3, Solid::kDirections>& directions() {
  static const auto all = [] {
    std::array<Vec3, Solid::kDirections> out;
    std::size_t n = 0;
    for (int i = 0; i < 27; ++i) {
      const Vec3 d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (i != 13) out[n++] = d.normalized();
    }
    return out;
  }();
  return all;
}

// Above the palm hang a hand and a wrist; no description says how wide for every robot.
constexpr int kSections = 7;                        // of a finger, from tip to palm
constexpr int kGripperFingerBalls = 8;              // the first of gripper_balls
constexpr double kWristRadius = 0.04;               // m
constexpr std::array kWristsAbove = {0.045, 0.10};  // m above the palm

}  // namespace

Solid Solid::around(std::span<const Vec3> vertices) {
  Solid out;
  out.reach_.fill(-std::numeric_limits<double>::infinity());
  out.low_.setConstant(std::numeric_limits<double>::infinity());
  out.high_ = -out.low_;
  for (const Vec3& v : vertices) {
    for (std::size_t i = 0; i < out.reach_.size(); ++i)
      out.reach_[i] = std::max(out.reach_[i], directions()[i].dot(v));
    out.low_ = out.low_.cwiseMin(v);
    out.high_ = out.high_.cwiseMax(v);
  }
  return out;
}

double Solid::distance(const Vec3& point) const {
  // A box's corner is farther than its planes.
  const Vec3 off = (point - high_).cwiseMax(low_ - point);
  double most = off.cwiseMax(0).norm();
  if (most <= 0) most = off.maxCoeff();
  for (std::size_t i = 0; i < reach_.size(); ++i)
    most = std::max(most, directions()[i].dot(point) - reach_[i]);
  return most;
}

double Surroundings::clearance(const Pose& tool, std::span<const Ball> balls, double beyond,
                               const MovedPart& moved, const LeftOut& without) const {
  double least = beyond;
  std::vector<Vec3> centers;
  Vec3 middle = Vec3::Zero();
  for (const Ball& ball : balls) {
    centers.push_back(tool.apply(ball.center));
    middle += centers.back() / static_cast<double>(balls.size());
    least = std::min(least, centers.back().z() - ball.radius - floor);
  }
  double radius = 0;
  for (std::size_t i = 0; i < centers.size(); ++i)
    radius = std::max(radius, (centers[i] - middle).norm() + balls[i].radius);
  const auto part = std::ranges::find(bodies, moved.fixture, &Body::fixture);
  const auto now = [&](const Body& body) {
    if (moved.fixture < 0 || part == bodies.end()) return body.pose;
    if (body.fixture == moved.fixture) return moved.at;
    return body.carrier == moved.fixture ? moved.at * part->pose.inverse() * body.pose : body.pose;
  };
  for (const Body& body : bodies) {
    const Pose into = now(body).inverse();
    const Vec3 near = into.apply(middle);
    for (std::size_t s = 0; s < body.solids.size(); ++s) {
      const bool is_out = body.fixture >= 0 && body.fixture == without.fixture &&
                          (without.solid < 0 || without.solid == static_cast<int>(s));
      if (is_out || body.solids[s].distance(near) - radius > least) continue;
      for (std::size_t i = 0; i < centers.size(); ++i)
        least = std::min(least, body.solids[s].distance(into.apply(centers[i])) - balls[i].radius);
    }
  }
  return least;
}

namespace {

// The part with a joint, of `parts`, within whose sides, and not below which, an object's middle
// is.
int carrier_of(std::span<const Surroundings::Body> parts, const policy::Privileged& view,
               const Surroundings::Body& object) {
  Vec3 middle = Vec3::Zero();
  for (const Solid& solid : object.solids)
    middle += object.pose.apply(solid.center()) / static_cast<double>(object.solids.size());
  for (const Surroundings::Body& part : parts) {
    const auto& joint = view.fixtures[static_cast<std::size_t>(part.fixture)].joint;
    if (!joint || object.solids.empty() || part.solids.empty()) continue;
    Vec3 low = part.solids.front().low(), high = part.solids.front().high();
    for (const Solid& solid : part.solids)
      low = low.cwiseMin(solid.low()), high = high.cwiseMax(solid.high());
    const Vec3 own = part.pose.inverse().apply(middle);
    if ((own.array() > low.array()).all() && (own.array() < high.array()).all())
      return part.fixture;
  }
  return -1;
}

}  // namespace

Surroundings surroundings_of(const policy::Privileged& view) {
  Surroundings out;
  const Pose to_base = view.base.inverse();
  const auto add = [&](const std::vector<std::vector<Vec3>>& parts, const Pose& pose, int fixture) {
    Surroundings::Body body{to_base * pose, {}, fixture};
    for (const std::vector<Vec3>& part : parts) body.solids.push_back(Solid::around(part));
    if (fixture < 0)
      body.carrier = carrier_of(std::span(out.bodies).first(view.fixtures.size()), view, body);
    out.bodies.push_back(std::move(body));
  };
  for (std::size_t i = 0; i < view.fixtures.size(); ++i)
    add(view.fixtures[i].parts, view.fixtures[i].pose, static_cast<int>(i));
  for (const policy::PrivilegedObject& object : view.objects) add(object.parts, object.pose, -1);
  out.floor = to_base.apply({view.base.position.x(), view.base.position.y(), view.surface_z}).z();
  return out;
}

namespace {

// Inner and outer faces of both fingers where they are at that opening, from tips to palm.
std::vector<Ball> turned_fingers(const robot::HandShape& hand, double parted) {
  std::vector<Ball> out;
  const robot::FingersAt at = robot::fingers_at(hand.turning, hand.openness_for(parted));
  for (int i = 0; i < kSections; ++i) {
    const double x = at.tip_below - (at.tip_below + hand.palm_above) * i / (kSections - 1.0);
    const double inner = robot::inner_face(at, hand.palm_above, x);
    const double outer = robot::outer_face(at, hand.palm_above, x);
    const double r = std::clamp(0.5 * (outer - inner), 0.002, hand.finger_half);
    const double side = hand.finger_half - r, center = std::min(x, at.tip_below - r);
    for (const double y : {inner + r, outer - r}) {
      for (const double z : {-side, side}) {
        out.push_back({{center, y, z}, r});
        out.push_back({{center, -y, z}, r});
      }
    }
  }
  return out;
}

}  // namespace

HandBalls hand_balls(const robot::HandShape& hand, double parted) {
  HandBalls out;
  if (!hand.turning.empty()) out.fingers = turned_fingers(hand, parted);
  for (int i = 0; i < kSections && hand.turning.empty(); ++i) {
    const double x = hand.tip_below - (hand.tip_below + hand.palm_above) * i / (kSections - 1.0);
    const double thick = std::max(0.004, hand.outside_at(x) - hand.opening_half);
    const double r = std::min(0.5 * thick, hand.finger_half);
    const double side = hand.finger_half - r;
    const double center = std::min(x, hand.tip_below - r);
    for (const double y : {parted + r, parted + thick - r}) {
      for (const double z : {-side, side}) {
        out.fingers.push_back({{center, y, z}, r});
        out.fingers.push_back({{center, -y, z}, r});
      }
    }
  }
  const std::vector<Ball> all = gripper_balls(hand, parted);
  out.rest.assign(all.begin() + kGripperFingerBalls, all.end());
  for (const double above : kWristsAbove)
    out.rest.push_back({{-hand.palm_above - above, 0, 0}, kWristRadius});
  return out;
}

std::vector<Ball> HandBalls::all() const {
  std::vector<Ball> both = fingers;
  both.insert(both.end(), rest.begin(), rest.end());
  return both;
}

}  // namespace probe::expert
