// What the judge can measure at one control step, after physics. A trace stores these, so that a
// rollout can be judged again without physics. World frame, SI units; bodies are task-local indices
// in the plan's order (BodyRecord).
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::vm {

struct BodySample {
  Vec3 position =
      Vec3::Zero();  // centre of mass; a link: its frame's origin; the surface: (0, 0, surface_z)
  Vec3 origin = Vec3::Zero();    // model origin; equal to position where there is no other
  Vec3 velocity = Vec3::Zero();  // of `position`
  Vec3 spin = Vec3::Zero();      // angular velocity
  Quat rotation = Quat::Identity();
};

// A joint of the robot or of a fixture: rad and rad/s where it turns, m and m/s where it slides.
struct JointSample {
  double position = 0;
  double rate = 0;
};

// Fixed during an episode: taken once after settling.
struct BodyStart {
  Vec3 position = Vec3::Zero();  // centre of mass after settling
  Vec3 half = Vec3::Zero();     // half extents, permuted so that z is the axis nearest the vertical
                                // after settling
  Vec3 opening = Vec3::Zero();  // fingers: unit opening axis in the link frame
};

// Of a body that moves by itself: where its own motion has it, or had it when somebody touched it
// or it came to its end. What such a body is compared with where others are with their start.
struct OwnPlace {
  std::uint16_t body = 0;
  Vec3 position = Vec3::Zero();  // centre of mass
};

// Contact impulse between two bodies over the last physics substep, N s; a < b; `push` is exerted
// by a on b. Pairs without contact are absent, so this list is short.
struct ContactSample {
  std::uint16_t a = 0;
  std::uint16_t b = 0;
  Vec3 push = Vec3::Zero();
};

struct StepSample {
  std::vector<BodySample> bodies;
  std::vector<ContactSample> contacts;  // ascending by (a, b)
  std::vector<JointSample> joints;      // the robot's in drive order, then those of fixtures
  std::vector<OwnPlace> own;            // of what moves by itself, ascending by body
  Vec3 tcp = Vec3::Zero();
  double grip = 0;  // closedness 0..1
  double step = 0;  // control steps done
  double time = 0;  // s
};

}  // namespace probe::vm
