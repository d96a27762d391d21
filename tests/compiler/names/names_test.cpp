#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("the small suite has nothing to say about") {
  const auto a = analyze_with_suite("");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(a->task("red_on_tray").prompt == "put red block on the tray");
  CHECK(a->task("red_on_tray").starts.size() == 24);
}

TEST_CASE("an unknown name is reported once, with the nearest spelling of its kind") {
  const auto a = analyze_with_suite("variant v of red_on_tray { source bleu }");
  CHECK(a->codes() == "P0201");
  CHECK(a->underlined() == "bleu");
  const Diagnostic& said = a->diagnostics.items().front();
  CHECK(said.message == "unknown object `bleu`");
  REQUIRE(said.fix.has_value());
  CHECK(said.fix->replacements.at(0).text == "blue");
}

TEST_CASE("a name of another kind is no suggestion") {
  // `day` is a light; as a scene there is nothing near.
  const auto a = analyze_with_suite("variant v of red_on_tray { scene day }");
  CHECK(a->codes() == "P0201");
  CHECK_FALSE(a->diagnostics.items().front().fix.has_value());
}

TEST_CASE("where nothing is near, what there is is told: at most eight, the nearest first") {
  const auto scene = analyze_with_suite("variant v of red_on_tray { scene day }");
  CHECK(scene->said().find("there is `bench`") != std::string::npos);
  std::string objects;
  for (int i = 0; i < 6; ++i)
    objects += "object extra" + std::to_string(i) + " like red { name \"extra\" }\n";
  const auto object = analyze_with_suite(objects + "variant v of red_on_tray { source xtr }");
  CHECK(object->said().find("there are `red`, `tray`, `extra0`, `extra1`, `extra2`, `extra3`, "
                            "`extra4`, `extra5` and 2 more") != std::string::npos);
}

TEST_CASE("every kind of reference is checked") {
  const std::pair<const char*, const char*> cases[] = {
      {"task t like bse { }", "bse"},
      {"variant v of red_on_try { source blue }", "red_on_try"},
      {"variant v of red_on_tray { refer source as by_colour }", "by_colour"},
      {"variant v of red_on_tray { say pat }", "pat"},
      {"variant v of red_on_tray { distractors blue, pail }", "pail"},
      {"set s = { red_on_tary }", "red_on_tary"},
      {"set s = tsks", "tsks"},
      {"set s = tasks where uses acton", "acton"},
      {"suite s trained on lob { tasks tasks; seeds 1 }", "lob"},
      {"object o like red { colour red }", "colour"},
      {"scene s like bench { camera eyes }", "eyes"},
      {"layout l like pairs { place target in distinct spot }", "spot"},
      {"predicate p(a: object) = hieght(a) > 1cm", "hieght"},
      {"metrics m { x = at end (height(sorce) > 1cm) }", "sorce"},
      {"metrics m { x = at end (any f in finger: impulse(f, source) > 1e-6Ns) }", "finger"},
      {"camera c like eye { mount arm.bse at (0m, 0m, 0m) look (1, 0, 0) }", "bse"},
  };
  for (const auto& [text, wrong] : cases) {
    CAPTURE(text);
    const auto a = analyze_with_suite(text);
    CHECK_MESSAGE(a->codes() == "P0201", a->said());
    CHECK(a->underlined() == wrong);
  }
}

TEST_CASE("a second declaration is reported at its name and the first one stays") {
  const auto a = analyze_with_suite("task red_on_tray like base { source blue; target tray }");
  CHECK(a->codes() == "P0203");
  CHECK(a->model.objects[a->task("red_on_tray").source].name == "red");
}

TEST_CASE("a value outside its attribute is reported with the place that lists the values") {
  const auto a = analyze_with_suite("object o like red { color bleu }");
  CHECK(a->codes() == "P0204");
  CHECK(a->diagnostics.items().front().labels.size() == 1);
}

TEST_CASE("records that copy each other in a circle are reported once") {
  CHECK(analyze_with_suite("object a like b { }\nobject b like a { }")->codes() == "P0207");
  CHECK(analyze_with_suite("predicate p(a: object) = q(a)\npredicate q(a: object) = p(a)")
            ->codes()
            .substr(0, 5) == "P0601");
}

TEST_CASE("a task without a statement it needs is told which") {
  const auto a = analyze_with_suite("task t { scene bench; source red; target tray; say put }");
  CHECK(a->codes() == "P0206");
  CHECK(a->diagnostics.items().front().message == "task `t` has no `layout`, `metrics`, `horizon`");
}

TEST_CASE("a missing robot description is reported at the path in the text") {
  const auto a = test::analyze_text(
      "robot r { urdf \"nowhere.urdf\"; tcp t; fingers a opens +y, b opens -y; control "
      "ee_delta_pose 5Hz\n"
      "drive j stiffness 1N/m damping 1Ns/m limit 1N; grip 1cm .. 2cm friction 1 patch 1cm }");
  CHECK_MESSAGE(a->codes() == "P0202", a->said());
  CHECK(a->underlined() == "\"nowhere.urdf\"");
}

TEST_CASE("a scene that lacks a statement is told so once, and its tasks say nothing more") {
  const auto a = analyze_with_suite(
      "scene empty { surface 1m area (0m, 0m) .. (1m, 1m) }\ntask t like red_on_tray { scene empty "
      "}");
  CHECK(a->codes() == "P0206 P0206 P0206 P0206 P0206");
}

TEST_CASE("what a syntax error leaves out is not looked at") {
  for (const char* text : {"set s =", "set s = tasks where", "suite s { tasks }",
                           "predicate p(a: object) =", "metrics m { x = once }",
                           "object o like red { phrase p appearance \"x\" means }", "variant v of",
                           "task t like base { source }"}) {
    CAPTURE(text);
    const auto a = analyze_with_suite(text);
    CHECK(a->codes().substr(0, 5) == "P0101");
  }
}

TEST_CASE("the beginning of one name alone is taken for it") {
  const auto dataset = analyze_with_suite(
      "dataset bridge_v2 \"Bridge\" { relations red on tray }\n"
      "suite s trained on bridge { tasks { red_on_tray }; seeds 1 }");
  REQUIRE(dataset->diagnostics.items().front().fix.has_value());
  CHECK(dataset->diagnostics.items().front().fix->replacements.at(0).text == "bridge_v2");
}
