#include <doctest/doctest.h>

#include "compiler/define/axes.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::string axes(const sema::Task& task) {
  std::string text;
  for (const plan::Axis axis : plan::axes_in(task.axes))
    text += (text.empty() ? "" : " ") + std::string(plan::axis_name(axis));
  return text;
}

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

TEST_CASE("a variant moves the axes it changes and no others") {
  const auto a = analyze_with_suite(R"(
variants of red_on_tray {
  source { source blue }
  target { target pale }
  among { distractors blue }
  action { say take }
  words { refer source as by_color }
  riddle { refer source as loved }
  dark { light night }
  longer { horizon 90 steps }
  goal { set success = at end (height(source) > 90cm) }
}
variant article of red_on_tray { say "put {the source} on {target}"; light night }
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(axes(a->task("source")) == "object.source");
  CHECK(axes(a->task("target")) == "object.target");
  CHECK(axes(a->task("among")) == "distractors");
  CHECK(axes(a->task("action")) == "language.action");
  CHECK(axes(a->task("words")) == "language.appearance");
  CHECK(axes(a->task("riddle")) == "language.commonsense");
  CHECK(axes(a->task("dark")) == "light");
  CHECK(axes(a->task("longer")) == "goal");
  CHECK(axes(a->task("goal")) == "goal");
  // An article is no move; words on the spot take their first word as the verb frame.
  CHECK(axes(a->task("article")) == "light");
}

TEST_CASE("other words in the same verb frame are a paraphrase, articles and named roles are not") {
  const auto a = analyze_with_suite(R"(
template gently frame put "put {the source} down on top of {the target}"
template set_down frame put "set {the source} down on {the target}"
variants of red_on_tray {
  gentle { say gently }
  down { say set_down }
  down_by_color { say set_down; refer source as by_color }
}
variant same of red_on_tray { say "put the {source} on a {target}"; light night }
variant named of red_on_tray { say "put {red} on {the tray}"; light night }
variant other of gentle { source blue }
derive "{t}_softly" for t in { red_on_tray, other } { say "put {the source} softly on {the target}" }
set reworded = tasks where uses paraphrase
set moved = tasks where axis language.paraphrase
)");
  CHECK_MESSAGE(a->codes() == "P0701", a->said());
  CHECK(axes(a->task("gentle")) == "language.paraphrase");
  CHECK(axes(a->task("down")) == "language.paraphrase");
  CHECK(axes(a->task("down_by_color")) == "language.appearance language.paraphrase");
  CHECK(axes(a->task("same")) == "light");
  CHECK(axes(a->task("named")) == "light");
  CHECK(axes(a->task("other")) == "object.source");
  CHECK(axes(a->task("red_on_tray_softly")) == "language.paraphrase");
  CHECK(axes(a->task("other_softly")) == "language.paraphrase");
  CHECK(members(*a, "reworded") ==
        "gentle down down_by_color other red_on_tray_softly other_softly");
  CHECK(members(*a, "moved") == "gentle down down_by_color red_on_tray_softly other_softly");
}

TEST_CASE("a new object drops the phrase that was chosen for the old one") {
  const auto a = analyze_with_suite(
      "task t like red_on_tray { refer source as loved }\ntask u like t { source blue }");
  CHECK(a->task("t").prompt == "put everybody's darling on the tray");
  CHECK(a->task("u").prompt == "put blue block on the tray");
}

TEST_CASE("a comparison on two axes is a warning unless a reason is given") {
  const char* text = "variant v of red_on_tray { source blue; say take }";
  CHECK(analyze_with_suite(text)->codes() == "P0701");
  const auto allowed =
      analyze_with_suite(std::string("@allow(confounded, \"as published\")\n") + text);
  CHECK(allowed->codes() == "");
  CHECK(allowed->task("v").allow_confounded == "as published");
  CHECK(analyze_with_suite(std::string("@allow(confusing, \"as published\")\n") + text)
            ->codes()
            .find("P0208") != std::string::npos);
}

TEST_CASE("a variant that changes nothing is an error") {
  CHECK(analyze_with_suite("variant v of red_on_tray { source red }")->codes() == "P0702");
}

TEST_CASE("baselines in a circle and abstract tasks in a suite are errors") {
  CHECK(analyze_with_suite("task a like red_on_tray against b { source blue }\ntask b like "
                           "red_on_tray against a { say take }")
            ->codes() == "P0703");
  CHECK(analyze_with_suite("suite s { tasks { base }; seeds 1 }")->codes() == "P0703");
}

TEST_CASE("what was not seen in training is out of distribution") {
  const auto a = analyze_with_suite(
      "variants of red_on_tray { s { source pale }\n r { source blue }\n t { target pale } }");
  CHECK(a->task("red_on_tray").ood == 0);
  CHECK(a->task("s").ood == 1);
  CHECK(a->task("t").ood == 2);
  // Both are known, their relation is not.
  CHECK(a->task("r").ood == 4);
}

TEST_CASE("sets follow from conditions and name one another in any order") {
  const auto a = analyze_with_suite(R"(
set late = early | { v_dark }
set early = tasks where uses action
set rest = tasks - late - { red_on_tray }
set wordy = tasks where uses appearance and not has distractors
set moved = variants of { red_on_tray } where axis light or axis distractors
set fresh = tasks where ood source
set lenient = tasks where metrics ever
metrics ever { success = once height(source) > height(target) }
variants of red_on_tray {
  v_take { say take }
  v_dark { light night }
  v_color { refer source as by_color }
  v_new { source pale }
  v_ever { metrics ever }
}
variant v_take_dark of v_take { light night }
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(members(*a, "early") == "v_take v_take_dark");
  CHECK(members(*a, "late") == "v_take v_take_dark v_dark");
  CHECK(members(*a, "rest") == "v_color v_new v_ever");
  CHECK(members(*a, "lenient") == "v_ever");
  CHECK(members(*a, "wordy") == "v_color");
  CHECK(members(*a, "moved") == "v_dark");
  CHECK(members(*a, "fresh") == "v_new");
}

TEST_CASE("a suite that expects other numbers is told the real ones") {
  const auto a =
      analyze_with_suite("suite s { tasks tasks; seeds 1; expect 2 tasks, 48 episodes }");
  CHECK(a->codes() == "P0504");
  CHECK(a->diagnostics.items().front().message == "suite `s` has 1 tasks and 24 episodes");
  CHECK(analyze_with_suite("suite s { tasks tasks; seeds 1; expect 1 tasks, 24 episodes }")
            ->codes() == "");
}

TEST_CASE("a hold that is longer than the horizon can never become true") {
  const auto a = analyze_with_suite(
      "metrics m like plain { steady = once (speed(source) < 1e-3 * speed(target) for 80 steps) "
      "}\ntask t "
      "like red_on_tray { metrics m }");
  CHECK_MESSAGE(a->codes() == "P0604", a->said());
  CHECK(a->underlined() == "for 80 steps");
}

TEST_CASE("what is heard, seen and judged alike is one experiment, whatever declares it") {
  const char* const slots = "variant v of red_on_tray { say \"put red block on the tray\" }";
  const auto base = analyze_with_suite("");
  REQUIRE(base->task("red_on_tray").prompt == "put red block on the tray");
  CHECK(analyze_with_suite(slots)->codes() == "P0702");
  CHECK(analyze_with_suite("template lift frame pick \"put {source} on {the target}\"\n"
                           "variant v of red_on_tray { say lift }")
            ->codes() == "P0702");
  CHECK(analyze_with_suite("object twin like red { phrase odd appearance \"red block\" bare "
                           "means color red; name \"else\" }\n"
                           "variant v of red_on_tray { source twin; refer source as odd }")
            ->codes() == "P0702");
  CHECK(analyze_with_suite("object twin like red { density 400kg/m3 }\n"
                           "variant v of red_on_tray { source twin }")
            ->codes() == "");
}
