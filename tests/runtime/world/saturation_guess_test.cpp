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
  JointResponse response;
  guess_saturation(drives, joints, {0, 1}, mass, 0.002, &response);
  CHECK(response.saturated[0] == 0);
  REQUIRE(respond(drives, joints, {0, 1}, mass, nullptr, 0.002, &response));
  // 100 N m on 3 g m2 for 2 ms would be 67 rad/s.
  CHECK(response.free_speed[0] < 300.0 / 200.0);
  CHECK(!find_overload(drives, joints, {0, 1}, response.free_speed, 0.002, true, &response));
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
  JointResponse response;
  guess_saturation(drives, joints, {0, 1}, mass, 0.002, &response);
  CHECK(response.saturated[0] == -1);
}

Drives finger(Joints* joints) {
  Drives drives;
  drives.count = 1;
  drives.stiffness[0] = 50;
  drives.damping[0] = 2;
  drives.limit[0] = 10;
  joints->target[0] = 1;  // e is 50 N m, five times the limit
  return drives;
}

TEST_CASE("a drive that presses with its limit against something still does in the next substep") {
  Joints joints;
  const Drives drives = finger(&joints);
  JointMatrix mass{};
  mass[0][0] = 1e-4;
  JointResponse response;
  joints.saturated[0] = 1;
  guess_saturation(drives, joints, {0, 1}, mass, 0.002, &response);
  CHECK(response.saturated[0] == 1);
  // Moving so fast that the drive would not reach its limit, or never at its limit: a drive again.
  joints.u[0] = 23;
  guess_saturation(drives, joints, {0, 1}, mass, 0.002, &response);
  CHECK(response.saturated[0] == 0);
  joints.u[0] = 0;
  joints.saturated[0] = 0;
  guess_saturation(drives, joints, {0, 1}, mass, 0.002, &response);
  CHECK(response.saturated[0] == 0);
}

TEST_CASE("a drive taken to be at its limit that would not reach it is solved for again, once") {
  Joints joints;
  const Drives drives = finger(&joints);
  JointMatrix mass{};
  mass[0][0] = 1e-4;
  JointResponse response;
  response.saturated[0] = 1;
  const JointArray moving{22};  // where the drive would push with 4 of its 10 N m
  CHECK(!find_overload(drives, joints, {0, 1}, moving, 0.002, false, &response));
  REQUIRE(find_overload(drives, joints, {0, 1}, moving, 0.002, true, &response));
  REQUIRE(respond(drives, joints, {0, 1}, mass, nullptr, 0.002, &response));
  CHECK(response.free_speed[0] < 25);
  CHECK(!find_overload(drives, joints, {0, 1}, response.free_speed, 0.002, true, &response));
}

TEST_CASE("a limit force that flings its joint gives way to the drive for the rest of a substep") {
  Joints joints;
  const Drives drives = finger(&joints);
  JointMatrix mass{};
  mass[0][0] = 1e-4;
  JointResponse response;
  response.saturated[0] = 1;
  REQUIRE(respond(drives, joints, {0, 1}, mass, nullptr, 0.002, &response));
  CHECK(response.free_speed[0] == doctest::Approx(200));  // what held it is gone
  REQUIRE(find_overload(drives, joints, {0, 1}, response.free_speed, 0.002, false, &response));
  CHECK(response.saturated[0] == 0);
  CHECK(!find_overload(drives, joints, {0, 1}, JointArray{0}, 0.002, false,
                       &response));  // five times its limit
  guess_saturation(drives, joints, {0, 1}, mass, 0.002, &response);
  CHECK(find_overload(drives, joints, {0, 1}, JointArray{0}, 0.002, false, &response));
}

}  // namespace
}  // namespace probe::world
