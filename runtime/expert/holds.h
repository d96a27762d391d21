// Where the hand can take a part of a fixture to move it along its joint: fingers around a handle,
// or closed fingers against a face that goes the way of the push. Computed from the part's
// collision shapes alone; whether the arm follows is another file's question.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/expert/solids.h"
#include "runtime/policy/policy.h"

namespace probe::expert {

using PartJoint = policy::PrivilegedFixture::Joint;

// A part's pose when its joint has gone on by `by` (m or rad) from where the part is at `pose`.
Pose moved_part(const PartJoint& joint, const Pose& pose, double by);

// How the tool goes with the part.
enum class Follows : std::uint8_t {
  kRigid,     // as if it were one with the part
  kUpright,   // at the same place of the part, turned as at first: what is held turns between the
              // fingers
  kTouching,  // a push: closed fingers, turned as at first, at a face that turns with the part
};

struct Hold {
  Follows follows = Follows::kRigid;
  Pose tool;        // in the part's frame, when taken; the grasp frame
  Quat turned;      // of the tool in the base frame when taken
  double open = 1;  // openness of the gripper on the way there
  Vec3 contact = Vec3::Zero(), normal = Vec3::Zero();  // of a push, the part's frame
  double deep = 0;  // m of the fingertips past the contact, of hands that reach over an edge
  int solid = 0;    // of the part: what is held or pushed
  double cost = 0;
  bool pushes() const { return follows == Follows::kTouching; }
  bool reaches_over() const { return deep > 0; }
};

// Where the tool is when the part is at `pose`, by `gap` m off the face of a push.
Pose tool_at(const Hold& hold, const Pose& part, const robot::HandShape& hand, double gap = 0);

struct HoldProblem {
  const Surroundings* around = nullptr;
  int fixture = -1;  // the part
  PartJoint joint;
  double aim = 0;      // m or rad: where its joint shall go
  Quat now;            // of the tool, to prefer short turns
  bool grasps = true;  // prefer these to pushes
  bool hooks = false;  // nothing but hands that reach over a part's upper edge and draw it
  robot::HandShape hand;
};

// Those with room for the hand at the part, where it is and where it shall go; best first.
std::vector<Hold> hold_candidates(const HoldProblem& problem);

// The same hold with the fingers as far apart as they are now, moved along their line to where they
// are farthest from the handle and from all else.
Hold refined(const HoldProblem& problem, const Hold& hold, double openness);

// The hand's balls on the way there with a hold, and while it holds.
HandBalls balls_of(const Hold& hold, const robot::HandShape& hand);

}  // namespace probe::expert
