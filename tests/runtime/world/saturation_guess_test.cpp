#include <doctest/doctest.h>

#include "runtime/world/drives.h"

namespace probe::world {
namespace {

TEST_CASE("a jump of the target moves a light joint at its drive's speed, not at its force limit") {
  Drives drives;
  drives.count = 1;
  drives.stiffness[0] = 1000;
  drives.damping[0] = 200;
  drives.limit[0] = 100;
  Joints joints;
  joints.target[0] = 0.3;  // e is 300 N m, three times the limit
  JointMatrix mass{};
  mass[0][0] = 0.003;
  ArmResponse arm;
  guess_saturation(drives, joints, mass, 0.002, &arm);
  CHECK(arm.saturated[0] == 0);
  REQUIRE(respond(drives, joints, mass, 0.002, &arm));
  // 100 N m on 3 g m2 for 2 ms would be 67 rad/s.
  CHECK(arm.free_speed[0] < 300.0 / 200.0);
  CHECK(!find_overload(drives, joints, arm.free_speed, 0.002, &arm));
}

TEST_CASE(
    "a heavy joint that the drive cannot speed up in a substep is at its limit from the start") {
  Drives drives;
  drives.count = 1;
  drives.stiffness[0] = 1000;
  drives.damping[0] = 1;
  drives.limit[0] = 100;
  Joints joints;
  joints.target[0] = -0.3;
  JointMatrix mass{};
  mass[0][0] = 5;
  ArmResponse arm;
  guess_saturation(drives, joints, mass, 0.002, &arm);
  CHECK(arm.saturated[0] == -1);
}

}  // namespace
}  // namespace probe::world
