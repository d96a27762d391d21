#include <doctest/doctest.h>

#include "compiler/define/task.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::string members(const test::Analysis& a, std::string_view set) {
  std::string text;
  for (const sema::TaskSet& known : a.model.sets) {
    if (known.name != set) continue;
    for (const sema::TaskId id : known.members)
      text += (text.empty() ? "" : " ") + a.model.tasks[id].name;
  }
  return text;
}

}  // namespace

TEST_CASE("derive makes a variant of each member and each phrase, and knows where it came from") {
  const auto a = analyze_with_suite(R"(
set core = { red_on_tray, blue_on_tray }
task blue_on_tray like base { source blue; target tray }
derive "{t}_night" for t in core { light night }
derive "{t}_as_{p}" for t in core, p in phrases appearance of source where uses action or scene bench {
  refer source as p
}
variant late of red_on_tray_night { refer source as by_color }
set night = tasks where axis light
set worded = tasks where uses appearance
)");
  CHECK_MESSAGE(a->codes() == "P0401", a->said());  // blue is no red thing
  CHECK(members(*a, "night") == "red_on_tray_night blue_on_tray_night");
  CHECK(members(*a, "worded") ==
        "late red_on_tray_as_by_color red_on_tray_as_toy blue_on_tray_as_by_color "
        "blue_on_tray_as_toy");
  const sema::Task& task = a->task("red_on_tray_as_toy");
  CHECK(task.derived);
  CHECK(task.prompt == "put toy on the tray");
  CHECK(a->model.tasks[task.baseline].name == "red_on_tray");
  CHECK(a->sources.text(task.span) == "\"{t}_as_{p}\"");
  CHECK(a->task("late").axes == a->task("red_on_tray_as_by_color").axes);
}

TEST_CASE("a derive goes over objects, and leaves out those that are there already") {
  const auto a = analyze_with_suite(R"(
derive "{o}_on_tray_too" for t in { red_on_tray }, o in objects (red, blue, tray, pale) { source o }
derive "{t}_beside_{o}" for t in { red_on_tray }, o in objects (blue, pale) { distractors o }
set swapped = variants of { red_on_tray } where axis object.source
set beside = variants of { red_on_tray } where axis distractors
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(members(*a, "swapped") == "blue_on_tray_too pale_on_tray_too");
  CHECK(members(*a, "beside") == "red_on_tray_beside_blue red_on_tray_beside_pale");
  CHECK(a->task("blue_on_tray_too").prompt == "put blue block on the tray");
}

TEST_CASE("a derive goes over the templates of a frame that say it in other words") {
  const auto a = analyze_with_suite(R"(
template put_the frame put "put {the source} on {the target}"
template set_on  frame put "set {the source} on {the target}"
derive "{t}_{w}" for t in { red_on_tray }, w in templates of put { say w }
set said = variants of { red_on_tray }
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(members(*a, "said") == "red_on_tray_set_on");
  CHECK(a->task("red_on_tray_set_on").prompt == "set the red block on the tray");
}

TEST_CASE("a derive goes over the distractors of its task, also in words on the spot") {
  const auto a = analyze_with_suite(R"(
variant crowd of red_on_tray { distractors blue, pale }
derive "{t}_not_{o}" for t in { crowd }, o in distractors of t {
  say "put {the source} on {the target}, not on {avoid the o}"
}
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(a->task("crowd_not_blue").prompt == "put the red block on the tray, not on the blue block");
  CHECK(a->task("crowd_not_pale").prompt == "put the red block on the tray, not on the pale block");
}

TEST_CASE("clear phrases describe their object alone in the scene") {
  const auto a = analyze_with_suite(R"(
variant crowd of red_on_tray { distractors blue }
variant doubt of red_on_tray { distractors pale }
derive "{t}_{p}" for t in { red_on_tray, crowd, doubt }, p in clear phrases appearance of source {
  refer source as p
}
set clear = tasks where uses appearance
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  // `toy` may be blue as well, and of pale no colour is known.
  CHECK(members(*a, "clear") == "red_on_tray_by_color red_on_tray_toy crowd_by_color doubt_toy");
}

TEST_CASE("binders name what there is") {
  CHECK(analyze_with_suite("derive \"{t}_{o}\" for t in tasks, o in objects (rad) { source o }")
            ->codes() == "P0201");
  CHECK(analyze_with_suite("derive \"{t}_{w}\" for t in tasks, w in templates of putt { say w }")
            ->codes() == "P0201");
  CHECK(analyze_with_suite(
            "derive \"{t}_{o}\" for t in tasks, o in distractors of s { distractors o }")
            ->codes() == "P0201");
}

TEST_CASE("a derive sees the tasks of the derives above it") {
  const auto a = analyze_with_suite(R"(
derive "{t}_night" for t in { red_on_tray } { light night }
derive "{t}_take" for t in tasks { say take }
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(a->task("red_on_tray_night_take").prompt == "take the red block to the tray");
  CHECK(a->model.tasks[a->task("red_on_tray_night_take").baseline].name == "red_on_tray_night");
}

TEST_CASE("derived names that clash, are no names, or name no binder") {
  CHECK(analyze_with_suite("derive \"x\" for t in { red_on_tray }, p in phrases appearance of "
                           "source { refer source as p }")
            ->codes() == "P0203");
  CHECK(analyze_with_suite("derive \"red_on_tray\" for t in { red_on_tray } { light night }")
            ->codes() == "P0203");
  CHECK(analyze_with_suite("derive \"{t}-x\" for t in { red_on_tray } { light night }")->codes() ==
        "P0101");
  CHECK(analyze_with_suite("derive \"{u}_x\" for t in { red_on_tray } { light night }")->codes() ==
        "P0201");
  CHECK(analyze_with_suite("derive \"{t}_x\" for t in { red_on_tray }, u in tasks { light night }")
            ->codes() == "P0203");
  CHECK(analyze_with_suite("derive \"x_{p}\" for p in phrases appearance of source { say take }")
            ->codes() == "P0206");
  CHECK(analyze_with_suite("derive \"{t}_{p}\" for t in { red_on_tray }, p in phrases colour of "
                           "source { refer source as p }")
            ->codes() == "P0201");
}

TEST_CASE("one mistake in a derive is said once for all of its tasks") {
  const auto a = analyze_with_suite(R"(
task blue_on_tray like base { source blue; target tray }
derive "{t}_x" for t in { red_on_tray, blue_on_tray } { light nigth }
derive "{t}_copy" for t in { red_on_tray, blue_on_tray } { source red }
)");
  CHECK_MESSAGE(a->codes() == "P0201 P0702", a->said());
}

TEST_CASE("an expansion beyond the limit is stopped and said once") {
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += "derive \"{t}_" + std::to_string(i) + "\" for t in tasks { horizon " +
            std::to_string(61 + i) + " steps }\n";
  const auto a = analyze_with_suite(text);
  CHECK_MESSAGE(a->codes().find("P0210") != std::string::npos, a->codes());
  CHECK(a->model.tasks.size() <= sema::kMaxTasks);
  // A layout that would give billions of starts is counted, not enumerated.
  CHECK(analyze_with_suite("layout huge like pairs { cells spots = grid 1000 x 1000 at (0cm, 0cm) "
                           "spread (10cm, 10cm) }\ntask t like red_on_tray { layout huge }")
            ->codes() == "P0210");
}

TEST_CASE("a derived name begins with a letter, as every name does") {
  const auto a = analyze_with_suite("derive \"_{t}\" for t in { red_on_tray } { light night }");
  CHECK(a->codes() == "P0101");
}

TEST_CASE("a binder that no statement says varies nothing") {
  const auto unused = analyze_with_suite(
      "derive \"{t}_{k}\" for t in { red_on_tray }, k in 1 .. 2 { light night }");
  CHECK_MESSAGE(unused->codes() == "P0205", unused->said());
  CHECK(unused->underlined() == "k");
  CHECK(analyze_with_suite("derive \"{t}_{o}\" for t in { red_on_tray }, o in objects (blue) { say "
                           "\"put {source} on "
                           "{the target}, not {avoid the o}\"; distractors blue }")
            ->codes()
            .find("P0205") == std::string::npos);
}

TEST_CASE("variants of one sweep that are the same are named") {
  // At 5 Hz both are one step late.
  const auto late = analyze_with_suite(
      "derive \"{t}_{d}\" for t in { red_on_tray }, d in 200ms, 0.2s, 400ms { delay d }");
  REQUIRE_MESSAGE(late->codes() == "P0702", late->said());
  CHECK(
      late->diagnostics.items().front().message ==
      "`red_on_tray_0_2s` does not differ from `red_on_tray_200ms`, which is made of `red_on_tray` "
      "as well");
  CHECK(analyze_with_suite(
            "derive \"{t}_{d}\" for t in { red_on_tray }, d in 200ms, 400ms { delay d }")
            ->codes() == "");
}

TEST_CASE("a number that a task has already is no choice, as its own objects and light are none") {
  const auto a = analyze_with_suite(R"(
derive "{t}_d{k}" for t in { red_on_tray }, k in 0 .. 2 { distractors k of (blue, pale) seed 1 }
derive "{t}_h{k}" for t in { red_on_tray }, k in 40, 60, 80 { horizon k steps }
derive "{t}_i{k}" for t in { red_on_tray }, k in 0 .. 1 { idle k steps }
set crowds = variants of { red_on_tray } where axis distractors
set others = variants of { red_on_tray } - crowds
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(members(*a, "crowds") == "red_on_tray_d1 red_on_tray_d2");
  CHECK(members(*a, "others") == "red_on_tray_h40 red_on_tray_h80 red_on_tray_i1");
  CHECK(analyze_with_suite(
            "derive \"{t}_h{k}\" for t in { red_on_tray }, k in 60, 60 { horizon k steps }")
            ->codes() == "P0211");
}
