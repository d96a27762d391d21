// Instructions: templates, slots, phrases in scenes. Each case begins with the productions it
// holds.
#include <doctest/doctest.h>

#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

TEST_CASE("template: the frame is the verb; other words in one frame are a paraphrase") {
  const auto a = clean(
      "template please frame put \"please put {the source} onto {the target}\"\n"
      "template lay frame lay \"lay {the source} on {the target}\"\n"
      "template put_down \"put {the source} down on {the target}\"\n"
      "variants of red_on_tray {\n"
      "  laid { say lay }\n"
      "  asked { say please }\n"
      "  down { say put_down }\n"
      "  there { say \"put {source} down on {the target}\" }\n"
      "  moved { say \"move {source} to {the target}\" }\n"
      "}\n");
  CHECK(a->task("asked").prompt == "please put the red block onto the tray");
  CHECK(axes_text(*a, "laid") == "language.action");
  CHECK(axes_text(*a, "asked") == "language.paraphrase");
  // Without a frame the first word is the frame, also of words on the spot.
  CHECK(axes_text(*a, "down") == "language.paraphrase");
  CHECK(axes_text(*a, "there") == "language.paraphrase");
  CHECK(axes_text(*a, "moved") == "language.action");
  // Articles move nothing.
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"put {the source} on {target}\" }")
            ->codes() == "P0702");
}

TEST_CASE(
    "words of the frame untold are held to nothing, may be none, and are never the task's own") {
  const auto a = clean(
      "template silence frame untold \"\"\n"
      "template other   frame untold \"open the drawer, then put the blue block in it\"\n"
      "template own     frame untold \"put {source} on {the target}\"\n"
      "derive \"{t}_{w}\" for t in { red_on_tray }, w in templates of untold { say w }\n");
  CHECK(a->task("red_on_tray_silence").prompt.empty());
  CHECK(axes_text(*a, "red_on_tray_silence") == "language.action");
  CHECK(a->task("red_on_tray_other").prompt == "open the drawer, then put the blue block in it");
  CHECK(axes_text(*a, "red_on_tray_other") == "language.action");
  for (const auto& task : a->model.tasks) CHECK(task.name != "red_on_tray_own");
  // The same words of a verb are held to the scene, and have to be some.
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"push the blue block\" }")->codes() ==
        "P0404");
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"\" }")->codes() == "P0406");
}

TEST_CASE("slot: role, object, article, negation and category") {
  const auto a = clean(
      "variant a of red_on_tray { say \"put {source} on {the target}\"; horizon 61 steps }\n"
      "variant b of red_on_tray { say \"put {the source} on {the target}\"; refer source as loved "
      "}\n"
      "variant c of red_on_tray { say \"put {the source: toy} on {target: dish}\"; horizon 61 "
      "steps }\n"
      "variant d of red_on_tray { distractors pale }\n"
      "@allow(confounded, \"test\")\nvariant e of d { say \"put {source}, not {avoid the pale}, on "
      "{target}\"; horizon 62 steps }\n"
      "@allow(confounded, \"test\")\nvariant f of d { say \"put {source} on the tray next to {the pale}\"; "
      "horizon 62 steps }\n");
  CHECK(a->task("a").prompt == "put red block on the tray");
  // A bare form takes no article.
  CHECK(a->task("b").prompt == "put everybody's darling on the tray");
  CHECK(a->task("c").prompt == "put the red block on tray");
  CHECK(a->task("e").prompt == "put red block, not the pale block, on tray");
  CHECK(axes_text(*a, "e") == "language.negation goal");
  CHECK(axes_text(*a, "f") == "language.paraphrase goal");
  CHECK(a->task("f").prompt == "put red block on the tray next to the pale block");
  CHECK(analyze_with_suite(
            "variant v of red_on_tray { say \"put {source: dish} on {target}\"; light night }")
            ->codes() == "P0407");
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"put {source} by {the pale}\" }")
            ->codes()
            .find("P0404") != std::string::npos);
}

TEST_CASE("template: braces that name nothing and empty words are errors in their place") {
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"put {sorce} on {target}\" }")
            ->underlined() == "sorce");
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"\" }")->codes() == "P0406");
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"put {source\" }")->codes() == "P0406");
}

TEST_CASE("query: a phrase must mean its referent and nothing else in every scene") {
  const char* refer = "variant v of red_on_tray { refer source as toy; ";
  CHECK(clean(std::string(refer) + "}")->task("v").prompt == "put toy on the tray");
  CHECK(analyze_with_suite(std::string(refer) + "distractors blue }")->codes().find("P0402") !=
        std::string::npos);
  CHECK(analyze_with_suite("variant v of red_on_tray { source blue; refer source as by_color }")
            ->codes()
            .find("P0401") != std::string::npos);
  // pale has no color: nobody knows.
  const auto unknown = analyze_with_suite(
      "variant d of red_on_tray { distractors pale }\n"
      "variant v of d { refer source as by_color }");
  CHECK(unknown->codes() == "P0403");
}
