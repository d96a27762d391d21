#include <doctest/doctest.h>

#include <cmath>

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

TEST_CASE("words on the spot that begin like the copied instruction keep its frame") {
  const auto a = analyze_with_suite(R"(
template lay frame lay "put {the source} on {the target}"
task laid like red_on_tray { distractors blue; say lay }
variant again of laid { say "put {the source} on {the target}, not on {avoid the blue}" }
variant other of laid { say "take {the source} to {the target}, not on {avoid the blue}" }
)");
  CHECK(a->task("again").axes == static_cast<std::uint32_t>(plan::Axis::kLanguageNegation));
  CHECK((a->task("other").axes & static_cast<std::uint32_t>(plan::Axis::kLanguageAction)) != 0);
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

TEST_CASE("a sample is a choice that a new task disturbs by at most one") {
  const std::string tasks =
      "variants of red_on_tray { a { horizon 61 steps }\n b { horizon 62 steps }\n c { horizon 63 "
      "steps }\n d { horizon 64 steps }\n e { horizon 65 steps } }\n";
  const std::string set = "set some = sample 3 of variants of { red_on_tray } seed 7\n";
  const auto before = analyze_with_suite(tasks + set);
  CHECK_MESSAGE(before->codes() == "", before->said());
  const auto after =
      analyze_with_suite(tasks + set + "variant f of red_on_tray { horizon 66 steps }");
  const std::string chosen = members(*before, "some");
  CHECK(chosen.size() == 5);
  CHECK(members(*analyze_with_suite(tasks + set), "some") == chosen);
  std::size_t kept = 0;
  for (const char name : chosen) {
    if (name != ' ' && members(*after, "some").find(name) != std::string::npos) ++kept;
  }
  CHECK(kept >= 2);
  CHECK(analyze_with_suite("set some = sample 3 of tasks seed 7")->codes() == "P0304");
}

TEST_CASE("jitter moves every object by its own draw, and other tasks shift nothing") {
  const std::string text =
      "layout shaken like pairs { jitter 5mm }\ntask t like red_on_tray { layout shaken }\n";
  const auto a = analyze_with_suite(text);
  const auto b = analyze_with_suite("task s like base { source blue; target tray; layout shaken }" +
                                    text + "variant u of t { say take }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const auto& plain = a->task("red_on_tray").starts;
  const auto& shaken = a->task("t").starts;
  REQUIRE(shaken.size() == plain.size());
  double least = 1, most = -1;
  for (std::size_t e = 0; e < plain.size(); ++e) {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& here = shaken[e].placed[i];
      CHECK(here.x == b->task("t").starts[e].placed[i].x);
      CHECK(here.y == b->task("t").starts[e].placed[i].y);
      CHECK(here.x == b->task("u").starts[e].placed[i].x);
      const double dx = here.x - plain[e].placed[i].x;
      CHECK(std::abs(dx) <= 0.005);
      least = std::min(least, dx);
      most = std::max(most, dx);
    }
  }
  CHECK(least < -0.003);
  CHECK(most > 0.003);
  CHECK(analyze_with_suite("layout l like pairs { jitter -5mm }")->codes() == "P0304");
}

TEST_CASE("an @allow silences warnings about its declaration, and a word when there are none") {
  const char* night = "variant v of red_on_tray { light night }";
  CHECK(analyze_with_suite(std::string("@allow(confounded, \"why\")\n") + night)->codes() ==
        "P0209");
  CHECK(analyze_with_suite("@allow(shared_name, \"why\")\nobject blue_two like blue { }\n"
                           "variant v of red_on_tray { distractors blue_two }")
            ->codes() == "P0209");
}
