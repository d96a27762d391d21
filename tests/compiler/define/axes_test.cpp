#include "compiler/define/axes.h"

#include <doctest/doctest.h>

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

TEST_CASE("a scene of other friction moves its light and its height beside itself, a scene of other things does not") {
  const auto a = analyze_with_suite(R"(
scene slippery like bench { physics 500Hz friction 0.2 }
scene all_at_once like bench {
  physics 500Hz friction 0.2; light night; surface 90cm area (-50cm, -50cm) .. (50cm, 50cm)
}
scene wider like bench {
  physics 500Hz friction 0.2; light night; surface 90cm area (-45cm, -45cm) .. (45cm, 45cm)
}
variants of red_on_tray {
  everything { scene all_at_once }
  smooth { scene slippery }
  wide { scene wider }
}
)");
  CHECK_MESSAGE(a->codes() == "P0701", a->said());
  CHECK(axes(a->task("smooth")) == "scene");
  CHECK(axes(a->task("everything")) == "scene scene.geometry light");
  CHECK(axes(a->task("wide")) == "scene");
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

TEST_CASE("what was not seen in training is out of distribution") {
  const auto a = analyze_with_suite(
      "variants of red_on_tray { s { source pale }\n r { source blue }\n t { target pale } }");
  CHECK(a->task("red_on_tray").ood == 0);
  CHECK(a->task("s").ood == 1);
  CHECK(a->task("t").ood == 2);
  // Both are known, their relation is not.
  CHECK(a->task("r").ood == 4);
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

TEST_CASE("metrics that say the same are one goal, wherever they stand") {
  const auto a = analyze_with_suite(R"(
predicate up_high(o: object, least: length = 5cm) = height(o) > height(start(o)) + least
predicate far_up(o: object, least: length = 5cm) = height(o) > height(start(o)) + least
metrics one { success = at end (up_high(source) and no x in distractors: up_high(x, 50mm)) }
metrics two { success = at end (far_up(source) and no x in distractors: far_up(x, 5cm)) }
metrics three { success = at end (far_up(source) and far_up(target) and no x in distractors: far_up(x, 5cm)) }
task t like red_on_tray { metrics one }
variant same of t { metrics two; light night }
variant other of t { metrics three }
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(axes(a->task("same")) == "light");
  CHECK(axes(a->task("other")) == "goal");
}

TEST_CASE("a verb is one in any case, and a capital alone is a paraphrase") {
  const auto a =
      analyze_with_suite("variant v of red_on_tray { say \"Put {source} on {the target}\" }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(axes(a->task("v")) == "language.paraphrase");
}

TEST_CASE("words that ask for something else are another action, not a paraphrase") {
  const auto moved = [](const std::string& from, const std::string& to) {
    const auto a = analyze_with_suite("task t like red_on_tray { distractors blue; say \"" + from +
                                      "\" }\nvariant v of t { say \"" + to + "\" }");
    // Success here knows no sides, which is said of these words and is another matter.
    const std::string codes = a->codes();
    CHECK_MESSAGE((codes == "" || codes == "P1202" || codes == "P1202 P1202"), a->said());
    return axes(a->task("v"));
  };
  CHECK(moved("put {source} left of {target}", "put {source} right of {target}") ==
        "language.action");
  CHECK(moved("put {source} to the left of {target}", "put it, {the source}, on the right") ==
        "language.action");
  CHECK(moved("first move {source} then {blue}", "first move {blue} then {source}") ==
        "language.action");
  CHECK(moved("first move {source}, then move {blue}", "first take {blue} and then {source}") ==
        "language.action");
  CHECK(moved("put {source} on {target}", "put {target} on {source}") == "language.action");
  CHECK(moved("put {source} on {target}", "put {source} under {target}") == "language.action");
  // The same in other words.
  CHECK(moved("put {source} on {target}", "put {source} down on top of {target}") ==
        "language.paraphrase");
  CHECK(moved("put {source} above {target}", "put, with {target} below, {source}") ==
        "language.paraphrase");
  CHECK(moved("pick {source}, then drop it on {target}",
              "pick first {source}, then drop it onto {target}") == "language.paraphrase");
}

TEST_CASE("a clause more that another success is of is another action") {
  const auto moved = [](const std::string& words, const std::string& success) {
    // That success holds nothing to some of these words is another matter.
    const auto a =
        analyze_with_suite("metrics m like plain { success = at end (" + success +
                           ") }\nvariant v of red_on_tray { say \"" + words + "\"; metrics m }");
    return axes(a->task("v"));
  };
  const std::string higher = "height(source) > height(target) and height(target) > 1m";
  CHECK(moved("put {source} on {the target} and lift {the target}", higher) ==
        "language.action goal");
  CHECK(moved("put {the target} up, then put {source} on {the target}", higher) ==
        "language.action goal");
  CHECK(moved("put {source} on {the target} and lift {the target}",
              "height(source) > height(target)") == "language.paraphrase");
  CHECK(moved("put {source} down on {the target}", higher) == "language.paraphrase goal");
}

TEST_CASE("a capital is no other action") {
  const auto a = analyze_with_suite(
      "variant loud of red_on_tray { say \"Put {source} on {the target}\" }\n"
      "variant other of red_on_tray { say \"Lay {source} on {the target}\" }\n");
  CHECK(axes(a->task("loud")).find("language.action") == std::string::npos);
  CHECK(axes(a->task("other")) == "language.action");
}
