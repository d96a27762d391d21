#include <doctest/doctest.h>

#include "compiler/define/template.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("an article stands where the slot asks for it and the words are not bare") {
  const auto a = analyze_with_suite(
      "variants of red_on_tray { x { say take; refer source as loved }\n y { say take }\n z { "
      "refer source as by_color } }");
  CHECK(a->task("x").prompt == "take everybody's darling to the tray");
  CHECK(a->task("y").prompt == "take the red block to the tray");
  CHECK(a->task("z").prompt == "put red thing on the tray");
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

TEST_CASE("words may name a fixture with joints that the scene has") {
  const auto a = test::analyze_with_suite(
      std::string(test::kChest) +
      "fixture tall_chest like chest { at (0cm, -80cm, 85cm) }\n"
      "scene both like room { fixture chest, tall_chest }\n"
      "task near like red_on_tray { scene both; say \"put {source} on {target} beside {the "
      "tall_chest}\" }\n"
      "variant other of near { say \"put {source} on {target} beside {the chest}\" }\n");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(a->task("near").prompt == "put red block on tray beside the tall chest");
  CHECK(a->task("other").prompt == "put red block on tray beside the chest");
  const auto absent = test::analyze_with_suite(
      std::string(test::kChest) +
      "task t like red_on_tray { say \"put {source} on {target} beside {the chest}\" }");
  CHECK(absent->codes() == "P0404");
  CHECK_MESSAGE(
      absent->said().find("fixture `chest` is not in the scene of `t`") != std::string::npos,
      absent->said());
  CHECK(test::analyze_with_suite(std::string(test::kChest) +
                                 "template a \"put {source} beside {the chest: dish}\"")
            ->codes()
            .find("P0407") != std::string::npos);
}
