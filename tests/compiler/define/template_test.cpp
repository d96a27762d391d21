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
