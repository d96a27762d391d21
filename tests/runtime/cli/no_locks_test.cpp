// Verbs on a file system that gives no locks: nothing is written, and who reads is told what to do.
#include <doctest/doctest.h>

#include <cerrno>

#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::Sandbox;

TEST_CASE("where a file system gives no locks runs are neither written nor read, and say why") {
  const Sandbox box;
  const std::string none = "LD_PRELOAD='" VLAPROBE_BINARY_DIR "/tests/libprobe_test_no_locks.so'";
  const std::string run =
      "run $SUITE --tasks carrot_on_plate --policy null --episodes 0-0 --seeds 42 --assets $ASSETS "
      "-o ";
  const Outcome written = box.vlaprobe(run + "other", none);
  CHECK(written.exit == 2);
  CHECK_MESSAGE(contains(written.err,
                         "its file system gives no locks (No locks available), so that "
                         "nothing would keep two runs from writing"),
                written.err);
  REQUIRE(box.vlaprobe(run + "run").exit == 0);
  for (const char* verb : {"results run", "report run -o run.html", "compare run run",
                           "merge run -o all", "why run carrot_on_plate 0"}) {
    const Outcome read = box.vlaprobe(verb, none);
    CHECK_MESSAGE(read.exit != 0, verb, ": ", read.out, read.err);
    CHECK_MESSAGE(contains(read.err, "gives no locks (No locks available)"), verb, ": ", read.err);
  }
  for (const int error : {ENOSYS, ENOTSUP, EINVAL}) {
    const Outcome read =
        box.vlaprobe("results run", none + " PROBE_ERRNO=" + std::to_string(error));
    CHECK_MESSAGE(contains(read.err, "its file system gives no locks ("), read.err);
  }
  CHECK(box.vlaprobe("results run").exit == 0);
}
