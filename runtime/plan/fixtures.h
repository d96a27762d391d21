// What the records of fixtures with joints say together.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "runtime/plan/tables.h"

namespace probe::plan {

// Turns without end: has no limits.
inline bool is_endless(const FixtureJointRecord& joint) {
  return joint.lower == 0 && joint.upper == 0;
}
// rad or m; a limit is one of its positions.
inline bool is_within(const FixtureJointRecord& joint, double position) {
  return is_endless(joint) || (joint.lower <= position && position <= joint.upper);
}
inline bool slides(const FixtureJointRecord& joint) {
  return joint.motion == static_cast<std::uint32_t>(JointMotion::kSlides);
}

// A joint is closed at the limit nearest 0, the lower one of two; it is open at the other.
inline bool closes_at_upper(double lower, double upper) {
  return std::abs(upper) < std::abs(lower);
}

// All joints of a scene's fixtures, in the order in which programs, starts and traces count them.
std::vector<const FixtureJointRecord*> joints_of(const Tables& tables, const SceneRecord& scene);
// "cabinet.top": as traces call them. In the same order.
std::vector<std::string> joint_names_of(const Tables& tables, const SceneRecord& scene);
// Where these joints are when the episode begins, before objects fall (m, rad).
std::vector<double> joint_starts_of(const Tables& tables, const SceneRecord& scene,
                                    const EpisodeRecord& episode);

}  // namespace probe::plan
