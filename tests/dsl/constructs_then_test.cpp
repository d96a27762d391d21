// Instructions that change in the course of an episode. Each case begins with the productions it
// holds.
#include <doctest/doctest.h>

#include "runtime/plan/ids.h"
#include "runtime/plan/later.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

const std::string kRoom = std::string(kChest) + R"(
layout alone { cells spots = grid 2 x 2 at (0cm, -10cm) spread (10cm, 10cm)
  place source in distinct spots; orient by rest; drop 10cm settle 0.5s }
predicate is_open(p: part) = travel(p) > 0.4 * range(p)
metrics stored { success = at end (is_open(chest.drawer) and z(source) < 85cm) }
task put_in like base {
  scene room; layout alone; source red; target none; metrics stored; horizon 200 steps
  say "open {the chest.drawer}"
  then say "put {the source} into it" when is_open(chest.drawer) or step >= 101
}
)";

std::string sentences(const Built& built, const std::string& task) {
  return plan::whole_instruction(built.plan().tables(), built.index(task));
}

}  // namespace

TEST_CASE("task_st: a later sentence is said when its condition has held") {
  const Built built(kRoom);
  CHECK(built.prompt("put_in") == "open the drawer");
  CHECK(sentences(built, "put_in") == "open the drawer; then: put the red block into it");
  const auto later = plan::later_of(built.plan().tables(), built.index("put_in"));
  REQUIRE(later.size() == 1);
  const plan::ProgramRecord& program = built.plan().programs()[later[0].program];
  REQUIRE(program.metrics.count == 1);
  CHECK(built.plan().text(built.plan().metrics(program)[0].name) == "when");
}

TEST_CASE("task_st: what is copied of later sentences is replaced together, or taken away") {
  const Built built(kRoom + R"(
variant twice of put_in {
  then say "put {the source} into it" when is_open(chest.drawer)
  then say "that is enough" when z(source) < 85cm for 5 steps
}
variant once_only of put_in { then none }
variant renamed of put_in { say "pull {the chest.drawer} open" }
variant same_words of put_in { then say "put {the source} into it" when step >= 101 }
@allow(confounded, "another thing is put there")
variant blue_in of put_in { source blue }
)");
  CHECK(sentences(built, "twice") ==
        "open the drawer; then: put the red block into it; then: that is enough");
  CHECK(sentences(built, "once_only") == "open the drawer");
  CHECK(sentences(built, "renamed") == "pull the drawer open; then: put the red block into it");
  CHECK(sentences(built, "blue_in") == "open the drawer; then: put the blue block into it");
  const auto axes = [&](const std::string& task) {
    std::string text;
    for (const std::string& axis : plan::moved_axes(built.plan().tables(), built.task(task)))
      text += (text.empty() ? "" : " ") + axis;
    return text;
  };
  CHECK(axes("twice") == "language.action");
  CHECK(axes("once_only") == "language.action");
  CHECK(axes("same_words") == "language.action");
  CHECK(axes("renamed") == "language.action");
  CHECK(axes("blue_in") == "object.source");
  // Words and times are the prompt's; starts and judgement are shared.
  const auto prompt = [&](const std::string& task) {
    return plan::prompt_id(built.plan().tables(), built.index(task));
  };
  CHECK(prompt("same_words") != prompt("put_in"));
  CHECK(prompt("once_only") == plan::prompt_id("open the drawer"));
  CHECK(built.task("same_words").judge_id == built.task("put_in").judge_id);
}

TEST_CASE("task_st: what a later sentence says in other words is a paraphrase") {
  const auto a = clean(
      kRoom +
      "variant reworded of put_in {\n"
      "  then say \"put {the source} down into it\" when is_open(chest.drawer) or step >= 101\n"
      "}\n");
  CHECK(axes_text(*a, "reworded") == "language.paraphrase");
}

TEST_CASE("later sentences are held to scene and success as the first is") {
  const auto said = [](const std::string& then) {
    return analyze_with_suite(kRoom + "task t like put_in { " + then + " }\n")->said();
  };
  CHECK(said("then say \"put {the tray} into it\" when step >= 9").find("P0404") !=
        std::string::npos);
  CHECK(said("then say \"\" when step >= 9").find("P0406") != std::string::npos);
  CHECK(said("then say \"open {the chest.drawer}\" when step >= 9").find("twice in turn") !=
        std::string::npos);
  CHECK(said("then say \"close {the chest.drawer}\" when is_open(chest.drawer)").find("P1202") !=
        std::string::npos);
  CHECK(said("then say \"put {the target} down\" when step >= 9").find("has no `target`") !=
        std::string::npos);
  CHECK(said("then say nowhere when step >= 9").find("P0201") != std::string::npos);
  CHECK(said("then say \"go on\" when z(tray) > 1m").find("P0201") != std::string::npos);
  CHECK(said("then say \"go on\" when z(source)").find("P0601") != std::string::npos);
  // What one sentence asks for is done where the next one comes.
  const auto closing = analyze_with_suite(kRoom + R"(
metrics shut { success = at end travel(chest.drawer) < 0.1 * range(chest.drawer) }
task both like put_in {
  metrics shut; say "open {the chest.drawer}"; then say "close {the chest.drawer}, not {the source}" when is_open(chest.drawer)
}
)");
  CHECK_MESSAGE(closing->codes() == "", closing->said());
}

TEST_CASE("a condition that cannot hold in time, or always does, is said where it stands") {
  CHECK(failed_build(kRoom + "task t like put_in { then say \"go on\" when step >= 200 }\n")
            .find("it never comes in time") != std::string::npos);
  CHECK(failed_build(kRoom + "task t like put_in { then say \"go on\" when step >= 1 }\n")
            .find("it comes after the first step") != std::string::npos);
  CHECK(failed_build(kRoom + "task t like put_in { then say \"go on\" when step >= 199 }\n") == "");
  // Where the drawer begins 10 of its 20 cm open there is nothing to wait for.
  CHECK(failed_build(kRoom + "task t like put_in { start chest.slide 10cm }\n")
            .find("holds where `t` begins") != std::string::npos);
  // What brings the third sentence is waited for when the drawer has been closed.
  CHECK(failed_build(kRoom + R"(
task t like put_in {
  start chest.slide 10cm; say "close {the chest.drawer}"
  then say "open {the chest.drawer}" when travel(chest.drawer) < 0.1 * range(chest.drawer)
  then say "put {the source} into it" when is_open(chest.drawer)
}
)") == "");
}

TEST_CASE("words that were proved to mean one thing are proved in later sentences, too") {
  const std::string text = kRoom + R"(
layout both { cells spots = grid 2 x 2 at (0cm, -10cm) spread (10cm, 10cm)
  place source, distractors in distinct spots; orient by rest; drop 10cm settle 0.5s }
task crowded like put_in { layout both; distractors blue; refer source as toy }
)";
  CHECK(analyze_with_suite(text)->said().find("P0402") != std::string::npos);
}
