#include "runtime/robot/grip_command.h"

#include <doctest/doctest.h>

using namespace probe::robot;

TEST_CASE("the gripper's number is a place between closed and open, and the ends beyond them") {
  CHECK(finger_target(0.014, 0.038, -1) == doctest::Approx(0.014));
  CHECK(finger_target(0.014, 0.038, 1) == doctest::Approx(0.038));
  CHECK(finger_target(0.014, 0.038, 0) == doctest::Approx(0.026));
  CHECK(finger_target(0.014, 0.038, 7) == finger_target(0.014, 0.038, 1));
  // Fingers that close to the greater angle.
  CHECK(finger_target(0.8, 0, -1) == doctest::Approx(0.8));
  for (const double command : {-1.0, -0.3, 0.0, 0.5, 1.0})
    CHECK(command_of_openness(openness_of_command(command)) == doctest::Approx(command));
  CHECK(command_of_openness(1.2) == 1);
}
