// Heights and shifts.
#include "runtime/expert/waypoints.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/check.h"
#include "runtime/expert/obstacles.h"
#include "runtime/expert/place_candidates.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kAbove = 0.055;         // m, from the grasp up to where the descent starts
constexpr double kTravelGap = 0.020;     // m, between what moves and what it passes over
constexpr double kLowGap = 0.060;        // m, the same of low ways: what hangs by its rim tilts
constexpr double kOverSource = 0.01;     // m, between open fingers and what they go down to
constexpr double kReleaseGap = 0.001;    // m, under the source where it is let go
constexpr std::size_t kMostGrasps = 40;  // candidates put to inverse kinematics

// Over the target the held source has its own height; the fingers' tips may be lower or higher than
// its bottom.
Pose over_target(const Scene& scene, const Pose& tcp) {
  Pose out = tcp;
  out.position.head<2>() += scene.target.center - scene.source.center;
  return out;
}

Pose at_height(Pose pose, double z) {
  pose.position.z() = z;
  return pose;
}

// Whether the middle is lower than the rim.
bool hollow(const Footprint& print) {
  for (std::size_t i = 0; i < print.parts.size(); ++i) {
    if (print.part_tops[i] < print.top - 0.003 || print.parts[i].size() < 3) continue;
    const Prism part = make_prism(print.parts[i], -1, 1);
    if (distance_to(part, {print.center.x(), print.center.y(), 0}).value < 0) return false;
  }
  return true;
}

GraspProblem problem_of(const Scene& scene, bool place) {
  GraspProblem problem;
  problem.source = &scene.source;
  problem.parts = scene.source_parts;
  problem.others = others_of(scene, place);
  problem.surface = std::max(scene.surface, scene.source.bottom);
  // What leans on the target is taken above it.
  if (place && scene.target.whole.size() >= 3 && scene.source.top > scene.target.top + 0.008) {
    const Prism around = make_prism(scene.target.whole, -1, 1);
    const Vec2& at = scene.source.center;
    if (distance_to(around, {at.x(), at.y(), 0}).value < 0 &&
        scene.source.bottom > scene.target.bottom - 0.001 &&
        scene.source.bottom < scene.target.top && !hollow(scene.target)) {
      problem.surface = scene.target.top;
    }
  }
  problem.yaw_now = yaw_of(scene.tcp.rotation);
  problem.gripper = scene.hand;
  problem.minds_stretch = scene.low_ways;
  return problem;
}

// Fingers on the same places, either way round.
bool same_hold(const Pose& a, const Pose& b) {
  const double along = (a.rotation * Vec3::UnitY()).dot(b.rotation * Vec3::UnitY());
  return (a.position - b.position).norm() < 0.009 && std::abs(along) > 0.7;
}

bool reachable(const Scene& scene, const Reach& reach, const Pick& pick, bool place) {
  const auto there = reach.follow(scene.joints, std::array{pick.above, pick.grasp.tcp});
  if (!there) return false;
  if (!place) return true;
  const JointVector& q = there->back();
  return plan_place(scene, reach, std::span(q.data(), std::size_t(q.size()))).has_value();
}

}  // namespace

Scene look(const policy::Observation& observation, const Roles& roles, const robot::Hand& hand) {
  PROBE_CHECK(observation.privileged != nullptr, "the expert looks at the privileged view");
  const policy::Privileged& seen = *observation.privileged;
  const Pose to_base = seen.base.inverse();
  Scene scene;
  for (std::size_t i = 0; i < seen.objects.size(); ++i) {
    const policy::PrivilegedObject& object = seen.objects[i];
    const Pose pose = to_base * object.pose;
    Footprint footprint = footprint_of(object.parts, pose);
    if (object.center_of_mass) {
      recenter(footprint, pose.apply(*object.center_of_mass).head<2>());
    }
    if (int(i) == roles.source) {
      scene.source = std::move(footprint);
      scene.source_pose = pose;
      scene.source_parts = object.parts;
      for (std::vector<Vec3>& part : scene.source_parts) {
        for (Vec3& vertex : part) vertex = pose.apply(vertex);
      }
      scene.fingers_on_source = object.finger_contact;
    } else if (int(i) == roles.target) {
      scene.target = std::move(footprint);
      scene.target_pose = pose;
    } else {
      scene.others.push_back(std::move(footprint));
    }
  }
  for (const policy::PrivilegedFixture& fixture : seen.fixtures) {
    for (const std::vector<Vec3>& part : fixture.parts) {
      scene.fixtures.push_back(footprint_of(std::span(&part, 1), to_base * fixture.pose));
    }
  }
  scene.hand = hand.shape;
  scene.tcp = observation.proprioception.tcp_in_base;
  scene.tcp.rotation = scene.tcp.rotation * hand.approach;
  scene.joints = observation.proprioception.joints;
  scene.openness = observation.proprioception.openness;
  // The base stands upright, so one point of the surface tells its height.
  scene.surface =
      to_base.apply({seen.base.position.x(), seen.base.position.y(), seen.surface_z}).z();
  return scene;
}

std::vector<const Footprint*> others_of(const Scene& scene, bool with_target) {
  std::vector<const Footprint*> out;
  for (const Footprint& other : scene.others) out.push_back(&other);
  for (const Footprint& part : scene.fixtures) out.push_back(&part);
  if (with_target) out.push_back(&scene.target);
  return out;
}

double travel_height(const Scene& scene, double hang) {
  double top = scene.surface;
  for (const Footprint* other : others_of(scene, true)) {
    if (!other->whole.empty()) top = std::max(top, other->top);
  }
  return top + hang + kTravelGap;
}

double travel_height(const Scene& scene, double hang, const Vec3& from, const Vec3& to) {
  if (!scene.low_ways) return travel_height(scene, hang);
  const robot::HandShape& hand = scene.hand;
  // The hand may be turned any way, and the source hang beside it.
  const double hand_out = std::hypot(hand.palm_half, std::max(hand.palm_front, hand.palm_back));
  const double held_out =
      (scene.source.center - scene.tcp.position.head<2>()).norm() + scene.source.radius;
  const bool is_held = scene.openness < 0.99 && held_out < 2 * scene.source.radius;
  const double out = std::max(hand_out, is_held ? held_out : 0) + kTravelGap;
  const Outline line = {from.head<2>(), to.head<2>()};
  double top = scene.surface;
  for (const Footprint* other : others_of(scene, true)) {
    if (other->whole.empty() || other->top <= top) continue;
    if (separation(other->whole, line) < out) top = other->top;
  }
  return top + hang + kLowGap;
}

std::vector<Grasp> grasps_of(const Scene& scene) {
  return grasp_candidates(problem_of(scene, true));
}

Pick pick_of(const Scene& scene, const Grasp& grasp) {
  Pick pick;
  pick.grasp = grasp;
  pick.source_pose = scene.source_pose;
  const double z = grasp.tcp.position.z();
  // Going there the fingers must also clear the object itself.
  const double between =
      travel_height(scene, scene.hand.tip_below, scene.tcp.position, grasp.tcp.position);
  const double over = std::max(
      {z + kAbove, between,
       scene.source.top + scene.hand.tip_below + (scene.low_ways ? kLowGap : kOverSource)});
  pick.above = at_height(grasp.tcp, over);
  return pick;
}

std::optional<Pick> plan_pick(const Scene& scene, const Reach& reach, bool place,
                              std::span<const Pose> failed) {
  GraspProblem problem = problem_of(scene, place);
  // Rather a doubtful way than none. Fingers that are set close to the source take time.
  struct Room {
    bool crowded, narrow;
  };
  for (const auto& [crowded, narrow] : {Room{true, false}, Room{true, true}, Room{false, false}}) {
    if (narrow && !scene.low_ways && scene.hand.turning.empty()) continue;
    if (!crowded) problem.others.clear();
    problem.narrow = narrow;
    std::vector<Grasp> grasps = grasp_candidates(problem);
    std::stable_partition(grasps.begin(), grasps.end(), [&](const Grasp& grasp) {
      return std::none_of(failed.begin(), failed.end(), [&](const Pose& before) {
        return same_hold(scene.source_pose * before, grasp.tcp);
      });
    });
    for (std::size_t i = 0; i < std::min(grasps.size(), kMostGrasps); ++i) {
      const Pick pick = pick_of(scene, grasps[i]);
      if (reachable(scene, reach, pick, place && crowded)) return pick;
    }
  }
  return std::nullopt;
}

Vec3 carry_goal(const Scene& scene) { return over_target(scene, scene.tcp).position; }

double gap_to_target(const Scene& scene) {
  return scene.source.bottom - scene.target.top - kReleaseGap;
}

bool lies_on_target(const Scene& scene) {
  // Heights by the shapes: a model's origin may be anywhere in it.
  return (scene.source.center - scene.target.center).norm() < half_diagonal(scene.target) &&
         scene.source.bottom < scene.target.top + 0.02 &&
         scene.source.bottom > scene.target.bottom + 0.0005;
}

}  // namespace probe::expert
