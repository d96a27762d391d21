// A horizon that was meant for another control rate.
#include <doctest/doctest.h>

#include <string>

#include "runtime/plan/axes.h"
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

TEST_CASE("a horizon that is a time has as many steps as reach it, whatever the control rate") {
  const auto a = test::analyze_with_suite(
      "robot quick like arm { control ee_delta_pose 20Hz }\n"
      "scene other like bench { robot quick at (50cm, 0cm) yaw 180deg }\n"
      "abstract task timed like red_on_tray { horizon 12.1s }\n"
      "task t like timed {}\n"
      "variant v of t { scene other }\n"
      "variant longer of t { horizon 15s }\n"
      "variant counted of t { horizon 75 steps }\n"
      "derive \"{t}_{d}\" for t in { red_on_tray }, d in 8s, 10s { horizon d }\n");
  CHECK_MESSAGE(a->said().find("P1513") == std::string::npos, a->said());
  CHECK(a->task("t").horizon == 61);
  CHECK(a->task("v").horizon == 242);
  CHECK(!plan::moves(a->task("v").axes, plan::Axis::kGoal));
  CHECK(a->task("longer").axes == plan::bit(plan::Axis::kGoal));
  CHECK(a->task("counted").axes == plan::bit(plan::Axis::kGoal));
  CHECK(a->task("red_on_tray_8s").horizon == 40);
  CHECK(a->task("red_on_tray_10s").horizon == 50);
}

TEST_CASE("a horizon without unit, of no length or too long is told") {
  const auto said = [](const std::string& horizon) {
    return test::analyze_with_suite("task t like red_on_tray { horizon " + horizon + " }\n")->said();
  };
  CHECK_MESSAGE(said("60").find("expected a time or `steps`, found a number") != std::string::npos,
                said("60"));
  CHECK_MESSAGE(said("60").find("write `60 steps`") != std::string::npos, said("60"));
  CHECK_MESSAGE(said("0s").find("expected a horizon between 1 and") != std::string::npos, said("0s"));
  CHECK_MESSAGE(said("1000000s").find("a control step is 200ms here") != std::string::npos,
                said("1000000s"));
  CHECK_MESSAGE(said("5cm").find("expected a time, found a length") != std::string::npos, said("5cm"));
}
