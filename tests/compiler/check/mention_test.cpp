#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::string codes(const std::string& words, const std::string& more = "") {
  return analyze_with_suite(more + "variant v of red_on_tray { say \"" + words + "\" }")->codes();
}

const std::string kTowel = "object towel like pale { name \"towel\" }\n";
const std::string kOrange = "object orange like pale { name \"orange\" }\n";
const std::string kCan = "object can like pale { name \"can\" }\n";

}  // namespace

TEST_CASE("words that are written out name what is in the scene") {
  CHECK(codes("put {source} on the towel", kTowel) == "P0404");
  CHECK(codes("put {source} on {target}, then move towel", kTowel) == "");
  CHECK(codes("put the towel, please", kTowel) == "P0404");
  CHECK(codes("put the Pale Block on {target}") == "P0404");
  CHECK(codes("put {source} on the towel",
              kTowel + "variant w of red_on_tray { distractors towel }\n") == "P0404");
  const auto there =
      analyze_with_suite(kTowel +
                         "variant v of red_on_tray { distractors towel }\n"
                         "variant w of v { say \"put {source} on {target}, beside the towel\" }");
  CHECK_MESSAGE(there->codes() == "", there->said());
}

TEST_CASE("a name that is an adjective, a verb or part of another name is no mention") {
  CHECK(codes("put {source} on the orange square", kOrange) == "");
  CHECK(codes("put {source} on the orange", kOrange) == "P0404");
  CHECK(codes("please, if you can put {source} on {target}", kCan) == "");
  // `red block` may be meant.
  CHECK(codes("put the block on {target}", "object block like pale { name \"block\" }\n") == "");
}

TEST_CASE("the fixture of the scene is there, although it is no object") {
  const std::string sink = "object sink like pale { name \"sink\" }\n";
  const auto codes_in = [&](const std::string& scene) {
    return analyze_with_suite(
               sink + scene +
               "task t like red_on_tray { scene s; say \"put {source} in the sink\" }")
        ->codes();
  };
  CHECK(codes_in("scene s like bench { fixture \"steel_sink\" at (0cm, 0cm, 0cm) }\n") == "");
  CHECK(codes_in("scene s like bench { fixture \"crate\" at (0cm, 0cm, 0cm) }\n") == "P0404");
}

TEST_CASE("a published sentence that tells of what is not there is kept under an allow") {
  const auto a = analyze_with_suite(
      kTowel +
      "@allow(absent, \"published so\")\n"
      "variant v of red_on_tray { say \"put {source} on {target}, not on the towel\" }\n"
      "variant w of v { light night }");
  CHECK_MESSAGE(a->codes() == "", a->said());
}

TEST_CASE("a name in the plural is a mention, too") {
  const auto thing = [](const std::string& name) {
    return "object thing like pale { name \"" + name + "\" }\n";
  };
  const std::pair<const char*, const char*> plurals[] = {{"carrot", "carrots"},
                                                         {"box", "boxes"},
                                                         {"dish", "dishes"},
                                                         {"berry", "berries"},
                                                         {"knife", "knives"},
                                                         {"shelf", "shelves"},
                                                         {"green cube", "green cubes"},
                                                         {"tomato", "tomatoes"},
                                                         {"tray lid", "tray lids"},
                                                         {"toy", "toys"}};
  for (const auto& plural : plurals) {
    const char* const one = plural.first;
    const char* const many = plural.second;
    CAPTURE(one);
    CHECK(codes(std::string("put the ") + many + " on {target}", thing(one)) == "P0404");
    CHECK(codes(std::string("put the ") + one + " on {target}", thing(many)) == "P0404");
  }
  // `red block` may be meant by "blocks", and no plural is made of what only looks like one.
  CHECK(codes("put the blocks on {target}", thing("block")) == "");
  CHECK(codes("put the gas on {target}", thing("ga")) == "P0404");
  CHECK(codes("put the glass on {target}", thing("glas")) == "");
  CHECK(codes("put the news on {target}", thing("ne")) == "");
}
