// A horizon that was meant for another control rate.
#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/small_suite.h"

using namespace probe;

TEST_CASE("a horizon that is allowed for a task is allowed for those that copy it as it is") {
  const auto said = [](const std::string& allow) {
    return test::analyze_with_suite(
               "robot quick like arm { control ee_delta_pose 20Hz }\n"
               "scene other like bench { robot quick at (50cm, 0cm) yaw 180deg }\n" +
               allow +
               "task t like red_on_tray { scene other }\n"
               "task u like t { source blue }\n")
        ->said();
  };
  CHECK_MESSAGE(said("").find("`t` has the 60 steps") != std::string::npos, said(""));
  CHECK_MESSAGE(said("@allow(horizon, \"as many\")\n").find("P1513") == std::string::npos,
                said("@allow(horizon, \"as many\")\n"));
}

TEST_CASE("one that only an abstract task copies is told of those that are run") {
  const std::string said =
      test::analyze_with_suite("robot quick like arm { control ee_delta_pose 20Hz }\n"
                               "scene other like bench { robot quick at (50cm, 0cm) yaw 180deg }\n"
                               "abstract task quick_base like red_on_tray { scene other }\n"
                               "task u like quick_base { source blue }\n")
          ->said();
  CHECK_MESSAGE(said.find("`u` has the 60 steps") != std::string::npos, said);
}
