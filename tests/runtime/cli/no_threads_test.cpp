// Verbs on a system that gives no thread: fewer do the work, or the lack is named. None aborts.
#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::Sandbox;

TEST_CASE("where no thread can be started verbs do their work on one, or say so") {
  const Sandbox box;
  const std::string none = "LD_PRELOAD='" VLAPROBE_BINARY_DIR "/tests/libprobe_test_no_threads.so'";
  const Outcome run = box.vlaprobe(
      "run $SUITE --tasks carrot_on_plate --policy null --episodes 0-1 --seeds 42 --jobs 2 "
      "--assets $ASSETS -o run",
      none);
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  for (const char* verb : {"results run", "sheet run -o run.png", "report run -o run.html",
                           "replay run carrot_on_plate 0 --verify --assets $ASSETS",
                           "preview $SUITE carrot_on_plate --assets $ASSETS -o starts.png"}) {
    const Outcome read = box.vlaprobe(verb, none);
    CHECK_MESSAGE(read.exit == 0, verb, ": ", read.err);
  }
  const Outcome test = box.vlaprobe("policy test 'openpi://localhost:9?profile=openpi'", none);
  CHECK(test.exit == 2);
  CHECK(contains(test.out + test.err, "no thread can be started"));
}
