#include "runtime/cluster/measured_time.h"

#include <doctest/doctest.h>

using namespace probe::cluster;

TEST_CASE("a task's time is whole episodes in each of its worlds, and half as much again") {
  const MeasuredTime measured{.seconds = 600, .episodes = 10, .worlds = 8};
  CHECK(time_for(measured, 8, 8) == 900);
  CHECK(time_for(measured, 1, 8) == 900);  // one is not done sooner by eight
  CHECK(time_for(measured, 9, 8) == 1800);
  CHECK(time_for(measured, 0, 8) == 0);
}
