#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("a phrase that describes two objects of the scene is ambiguous") {
  const auto a =
      analyze_with_suite("task v like red_on_tray { distractors blue; refer source as toy }");
  CHECK_MESSAGE(a->diagnostics.items().front().code == Code::P0402, a->said());
  CHECK(a->underlined() == "toy");
  CHECK(a->diagnostics.items().front().message == "\"toy\" denotes 2 objects in `v`");
  CHECK(a->diagnostics.items().front().helps.at(0) ==
        "`color red` holds for `red` and not for `blue`");
}

TEST_CASE("the same phrase is fine where the other object is absent") {
  CHECK(analyze_with_suite("variant v of red_on_tray { refer source as toy }")->codes() == "");
}

TEST_CASE("an inherited phrase that no longer describes its object does not denote it") {
  const auto a =
      analyze_with_suite("task v like red_on_tray { source blue; refer source as by_color }");
  CHECK(a->codes() == "P0401");
  CHECK_MESSAGE(a->said().find("note: `color red` is not true of `blue`, whose color is blue\n") !=
                    std::string::npos,
                a->said());
}

TEST_CASE("an object of unknown colour may be meant too: a warning, not silence") {
  const auto a =
      analyze_with_suite("task v like red_on_tray { distractors pale; refer source as by_color }");
  CHECK(a->codes() == "P0403");
  CHECK(a->diagnostics.items().front().severity == Severity::kWarning);
}

TEST_CASE("an object that is named must be in the scene") {
  const auto a = analyze_with_suite(
      "variant v of red_on_tray { say \"put {the source} on {the target}, not {avoid the blue}\" "
      "}");
  CHECK(a->codes() == "P0404");
  CHECK(a->underlined() == "{avoid the blue}");
  CHECK(a->diagnostics.items().front().primary_label == "the scene has red, tray");
  CHECK(analyze_with_suite(
            "@allow(confounded, \"needs something to avoid\")\nvariant v of red_on_tray {\n"
            "distractors blue; say \"put {the source} on {the target}, not {avoid the blue}\" }")
            ->codes() == "");
}

TEST_CASE("a published sentence that tells of an absent object is kept under an allow") {
  CHECK(analyze_with_suite("@allow(absent, \"published like this\")\nvariant v of red_on_tray {\n"
                           "say \"put {the source} on {the target}, not {avoid the blue}\" }")
            ->codes() == "");
  // It holds for tasks that keep the sentence, and no longer for one that says something else.
  const char* const kept =
      "@allow(absent, \"published like this\")\nvariant v of red_on_tray {\n"
      "say \"put {the source} on {the target}, not {avoid the blue}\" }\n"
      "light night2 { ambient 0.1 }\nvariant w of v { light night2 }\n"
      "derive \"{t}_dark\" for t in { v } { light night2 }\n";
  CHECK(analyze_with_suite(kept)->codes() == "");
  const auto other =
      analyze_with_suite(std::string(kept) + "variant x of w { say \"put {source}, not {blue}\" }");
  CHECK_MESSAGE(other->codes().find("P0404") != std::string::npos, other->said());
}

TEST_CASE("a slot that wants a category takes only its objects") {
  CHECK(analyze_with_suite(
            "variant v of red_on_tray { say \"put {the source: toy} on {target: dish}, please\" }")
            ->codes()
            .find("P0407") == std::string::npos);
  CHECK(analyze_with_suite(
            "variant v of red_on_tray { say \"serve {the source: dish} on {target}\" }")
            ->codes() == "P0407");
}

TEST_CASE("two objects of one name are a warning") {
  CHECK(analyze_with_suite("object twin like blue { name \"red block\" }\nvariant v of red_on_tray "
                           "{ distractors twin }")
            ->codes() == "P0405");
}

TEST_CASE("an unknown fact is doubted, a known one is an error, and all rivals are said at once") {
  const std::string objects =
      "object plain like pale { name \"b\" }\n"
      "object perhaps like blue { maybe favorite; name \"p\" }\n"
      "object too like blue { is favorite; name \"t\" }\n"
      "object third like blue { is favorite; name \"u\" }\n";
  const auto with = [&](const std::string& distractors) {
    return analyze_with_suite(objects + "variant v of red_on_tray { refer source as loved }\n" +
                              "variant w of v { distractors " + distractors + " }");
  };
  CHECK(with("plain")->codes() == "");
  CHECK(with("perhaps")->codes() == "P0403");
  const auto sure = with("too, third");
  CHECK_MESSAGE(sure->codes() == "P0402", sure->said());
  CHECK(sure->diagnostics.items().front().message ==
        "\"everybody's darling\" denotes 3 objects in `w`");
  // The words were fine where they were chosen: what came in here is pointed at.
  CHECK(sure->underlined() == "too");
}

TEST_CASE("an absent object is named as it is said, with a task that has it") {
  const auto a = analyze_with_suite(
      "variant among of red_on_tray { distractors blue }\n"
      "variant v of red_on_tray { say \"put {source} on {target}, not {avoid the blue}\" }");
  CHECK_MESSAGE(a->codes() == "P0404", a->said());
  const Diagnostic& absent = a->diagnostics.items().front();
  CHECK(absent.message == "\"not the blue block\" names an object that is not in the scene of `v`");
  CHECK(absent.helps.front() == "add `distractors blue`, or derive from `among`");
}

TEST_CASE("the source is never avoided, the target only with another goal") {
  const auto codes = [](const std::string& body) {
    return analyze_with_suite("variant v of red_on_tray { " + body + " }")->codes();
  };
  CHECK(codes("say \"put {source} on {the target}, not {avoid the source}\"") == "P0404");
  CHECK(codes("say \"put {source} on {the target}, not {avoid the red}\"") == "P0404");
  CHECK(codes("say \"put {source} on {the target}, not {avoid the target}\"") == "P0404");
  CHECK(codes("say \"put {source} down, not on {avoid the tray}\"") == "P0404");
  const auto other = analyze_with_suite(
      "@allow(confounded, \"the goal follows the words\")\n"
      "variant v of red_on_tray { say \"put {source} down, not on {avoid the target}\"\n"
      "  set success = at end (height(source) < height(target)) }");
  CHECK_MESSAGE(other->codes() == "", other->said());
}

TEST_CASE("names that differ in case alone are the same words") {
  CHECK(analyze_with_suite("object other like pale { name \"Red Block\" }\n"
                           "task t like red_on_tray { distractors other }")
            ->codes() == "P0405");
  CHECK(analyze_with_suite("object other like pale { name \"small Red block\" }\n"
                           "task t like red_on_tray { distractors other }")
            ->codes() == "P0405");
}

TEST_CASE("an instruction has words, and nothing in it is hidden") {
  const auto said = [](const std::string& words) {
    return analyze_with_suite("variant v of red_on_tray { say \"" + words + "\" }");
  };
  for (const char* blank : {"", " ", "\u00a0 ", "\u3000"}) {
    const auto a = said(blank);
    CAPTURE(a->said());
    CHECK(a->codes() == "P0406");
    CHECK(a->underlined() == std::string("say \"") + blank + "\"");
  }
  for (const char* hidden : {"\u200b", "\u202e", "\u2067", "\ufeff", "\u00ad"}) {
    const auto a = said(std::string("put {source}") + hidden + " on {target}");
    CAPTURE(a->said());
    CHECK(a->codes() == "P0406");
    CHECK(a->said().find("holds the invisible character U+") != std::string::npos);
    CHECK(a->underlined().starts_with("say "));
  }
  // A word of Persian is spelt with a joiner.
  CHECK(said("\u0645\u06cc\u200c\u062e\u0648\u0627\u0647\u0645 {source} {target}")->codes() == "");
}

TEST_CASE("a pose is of an object that the task has") {
  const auto a =
      analyze_with_suite("variant v of red_on_tray { pose blue yaw 90deg, yaw 90deg; say take }");
  CHECK(a->codes() == "P0404");
  CHECK(a->underlined() == "blue");
  CHECK_MESSAGE(a->said().find("`blue` is not in the scene of `v`") != std::string::npos,
                a->said());
  CHECK(analyze_with_suite(
            "variant v of red_on_tray { distractors blue; pose blue yaw 90deg, yaw 90deg }")
            ->codes() == "");
  // What a task copies may be of an object that it has no more, and a pattern is of any.
  CHECK(analyze_with_suite("variant v of red_on_tray { pose red yaw 90deg, yaw 90deg }\n"
                           "task w like v { source blue }")
            ->codes() == "");
  CHECK(analyze_with_suite("abstract task b like base { pose blue yaw 90deg, yaw 90deg }\n"
                           "task w like b { source red; target tray }")
            ->codes() == "");
  // One line in many tasks is said once.
  CHECK(analyze_with_suite("variant dark of red_on_tray { light night }\n"
                           "derive \"{t}_x\" for t in { red_on_tray, dark } { pose blue yaw 90deg, "
                           "yaw 90deg; say take }")
            ->codes() == "P0404");
}
