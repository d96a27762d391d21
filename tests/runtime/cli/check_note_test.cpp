// What `check` says of starts and of the expert beside what is wrong with a text.
#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::Sandbox;
using probe::test::write_file;

namespace {

const std::string kRaised = R"(use "suite/intact.probe"
use "std/place.probe"
metrics both_up { success = at end (lifted(source) and lifted(target)) }
task raised like carrot_on_plate { metrics both_up; say "pick up {the source} and {the target}" }
task raised_too like raised { horizon 90 steps }
suite own trained on bridge_v2 { tasks { raised, raised_too }; seeds 1 }
)";

}  // namespace

TEST_CASE("check names the tasks for which the expert finds no skills, and what to write") {
  const Sandbox box;
  write_file(box / "raised.probe", kRaised);
  const Outcome some = box.vlaprobe("check raised.probe");
  CHECK_MESSAGE(some.exit == 0, some.err);
  CHECK(contains(some.err, "note: policy `expert` finds no skills for 2 of 53 tasks: `raised`, "
                           "`raised_too`; `solution { .. }` says how\n"));
  // A text for programs has no note.
  CHECK_FALSE(contains(box.vlaprobe("check raised.probe --json").err, "finds no skills"));
  CHECK_FALSE(contains(box.vlaprobe("check $SUITE").err, "finds no skills"));
}

TEST_CASE("a task that several texts use is named once, and one that is not chosen is not") {
  const Sandbox box;
  write_file(box / "common.probe", kRaised);
  write_file(box / "a.probe",
             "use \"common.probe\"\nsuite a trained on bridge_v2 { tasks { raised }; seeds 1 }\n");
  write_file(box / "b.probe",
             "use \"common.probe\"\nsuite b trained on bridge_v2 { tasks { raised }; seeds 1 }\n");
  const Outcome both = box.vlaprobe("check a.probe b.probe");
  CHECK_MESSAGE(contains(both.err, "no skills for 2 of 106 tasks: `raised`, `raised_too`;"),
                both.err);
}

TEST_CASE("check says nothing of skills while a text has mistakes") {
  const Sandbox box;
  write_file(box / "raised.probe", kRaised + "task wrong like raised { horizon 0 steps }\n");
  const Outcome some = box.vlaprobe("check raised.probe");
  CHECK(some.exit == 1);
  CHECK_FALSE(contains(some.err, "finds no skills"));
}

TEST_CASE("check says how many starts `where clear` keeps of how many, in which tasks") {
  const Sandbox box;
  const Outcome said = box.vlaprobe("check '" VLAPROBE_SOURCE_DIR "/examples/spatial.probe'");
  CHECK_MESSAGE(said.exit == 0, said.err);
  CHECK_MESSAGE(contains(said.err,
                         "note: `where clear` keeps 12 of 24 starts in `left_can_named`, "
                         "`left_can_on_the_left`\n"),
                said.err);
  CHECK_FALSE(contains(box.vlaprobe("check $SUITE").err, "where clear"));
}
