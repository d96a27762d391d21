// The places a pick and a place go through, computed from what is seen and a grasp: where the tool
// stands above, at, and off the object, and how it must shift so that what it holds lies on the
// target. Poses in the robot base frame.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/expert/grasp_candidates.h"
#include "runtime/expert/reach.h"
#include "runtime/policy/policy.h"

namespace probe::expert {

// An observation as the planner needs it.
struct Scene {
  Footprint source, target;
  std::vector<Footprint> others;                // neither source nor target
  std::vector<Footprint> fixtures;              // a convex part each
  std::vector<std::vector<Vec3>> source_parts;  // vertices, base frame
  Pose source_pose, target_pose;                // model frames
  std::vector<bool> fingers_on_source;          // a finger
  robot::HandShape hand;
  Pose tcp;  // the grasp frame
  std::vector<double> joints;
  double openness = 1;
  double surface = 0;
  // Whether ways go over what lies between their ends alone: of an arm that is slow, and has no
  // time to go over everything.
  bool low_ways = false;
};

// Indices of objects in the view; target -1 for none.
struct Roles {
  int source = 0, target = 1;
};
Scene look(const policy::Observation& observation, const Roles& roles, const robot::Hand& hand);

struct Pick {
  Grasp grasp;
  Pose above;        // straight over the grasp, fingers clear of everything
  Pose source_pose;  // when planned
};

// All grasps of the source among everything else, best first.
std::vector<Grasp> grasps_of(const Scene& scene);

Pick pick_of(const Scene& scene, const Grasp& grasp);

// The best grasp whose whole way the arm can follow, place included. Without any within the
// margins, the best that fits at all; nullopt if the object cannot be gripped from above. `failed`
// are grasps tried before, tool poses in the source's frame: others come first.
std::optional<Pick> plan_pick(const Scene& scene, const Reach& reach, bool place,
                              std::span<const Pose> failed = {});

// The tool's height so that its tips and what hangs below them (`hang` m under the tool centre
// point) clear everything but the source.
double travel_height(const Scene& scene, double hang);
// The same of what is near the straight line between two places, where ways are low.
double travel_height(const Scene& scene, double hang, const Vec3& from, const Vec3& to);

// Everything else than the source, each as it is seen from above; the target if asked.
std::vector<const Footprint*> others_of(const Scene& scene, bool with_target);

// Where the tool must go so that the held source lies over the middle of the target, at the tool's
// present height...
Vec3 carry_goal(const Scene& scene);
// ...and how far above the target the source's lowest point is.
double gap_to_target(const Scene& scene);

// Whether the source lies on the target, by the suite's distances: xy within the target's half
// diagonal, above it.
bool lies_on_target(const Scene& scene);

}  // namespace probe::expert
