// A fixture with joints, as data: a drawer, a door, a knob. It is an articulation that nobody
// drives.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/urdf.h"
#include "runtime/world/spec.h"

namespace probe::stage {

// A link that is seen only while a joint stands at a value or beyond.
struct ShownWhile {
  std::string link;       // of the URDF
  std::size_t joint = 0;  // of Fixture::joints
  bool from_below = false;
  double at = 0;  // m or rad

  bool holds(double position) const { return from_below ? position <= at : position >= at; }
};

struct Fixture {
  std::string name;                      // "cabinet"; its joints and links are "cabinet.top"
  std::string urdf;                      // under the asset root
  Pose base;                             // of its root link, world
  std::vector<world::JointSpec> joints;  // one for each that moves: friction, damping, a spring
  std::vector<double> positions;         // m and rad, of the joints before objects fall
  double friction = 1;                   // of its links' material
  std::vector<ShownWhile> shown;
};

// As a plan's record has it; its springs rest where the record says.
Fixture fixture_of(const plan::Plan& plan, const plan::FixtureRecord& record);

// Whether the record's parts are the links of its description that can be touched, in their order:
// by that order contacts find the part; and whether nothing can touch what is seen at times. Fails
// (kUrdf) naming part, link and description.
Status check_parts(const plan::Plan& plan, const plan::FixtureRecord& record,
                   const robot::RobotModel& model);

// What a trace calls a joint or a link of a fixture.
inline std::string name_in(const Fixture& fixture, const std::string& part) {
  return fixture.name + "." + part;
}

}  // namespace probe::stage
