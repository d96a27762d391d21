// An episode that fails while its objects settle, as every verb that reads runs meets it.
#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::Sandbox;

TEST_CASE("an episode that fails before its start is kept, and no verb refuses the folder for it") {
  const Sandbox box;
  // The carrot is dropped from farther than a world reaches.
  probe::test::write_file(box / "high.probe",
                          "use \"" VLAPROBE_SOURCE_DIR
                          "/suite/intact.probe\"\n"
                          "layout high like grid_24 { drop 900m settle 10s }\n"
                          "variant carrot_from_the_sky of carrot_on_plate { layout high }\n"
                          "suite high { tasks { carrot_on_plate, carrot_from_the_sky }; seeds 42; "
                          "expect 2 tasks, 48 episodes }\n");
  const Outcome run = box.vlaprobe(
      "run high.probe --suite high --policy null --episodes 0-0 --assets $ASSETS -o run");
  REQUIRE_MESSAGE(run.exit == 2, run.err);  // an episode is invalid
  const Outcome results = box.vlaprobe("results run");
  CHECK(results.exit == 0);
  CHECK(contains(results.out, "carrot_from_the_sky: 1 episodes, 1 invalid"));
  CHECK(contains(results.out, "world: body `carrot` is farther than 100 m away"));
  for (const char* verb :
       {"export run -o run.jsonl", "export run -o run.h5", "sheet run -o run.png",
        "judge run --with high.probe --suite high --assets $ASSETS", "merge run -o merged",
        "replay run carrot_from_the_sky 0 --verify --assets $ASSETS",
        "why run carrot_from_the_sky 0", "report run -o run.html"}) {
    const Outcome read = box.vlaprobe(verb);
    CHECK_MESSAGE(read.exit == 0, verb, ": ", read.err);
  }
  CHECK(contains(box.vlaprobe("results merged").out, "1 invalid"));
  CHECK(contains(probe::test::read_file(box / "run.jsonl"),
                 "\"invalid\":\"world: body `carrot` is farther than 100 m away\""));
}
