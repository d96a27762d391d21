// What is loaded for one text serves the next as long as things only stand elsewhere.
#include <doctest/doctest.h>

#include "runtime/compile/files.h"
#include "runtime/stage/assets.h"

using namespace probe;

namespace {

plan::Plan plan_of(const std::string& more) {
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/reuse_test.probe";
  compile::FilesRequest request;
  request.unsaved[file] = "use \"intact.probe\"\n" + more;
  auto compiled = compile::compile_files({file}, request);
  REQUIRE(compiled);
  REQUIRE(compiled->ok);
  return plan::Plan::from_bytes(std::move(compiled->plan)).value();
}

std::string at(const std::string& place, const std::string& source = "carrot") {
  return "layout mine { place source at " + place +
         "; place target at (-14cm, 6cm); orient by rest; drop 50cm settle 0.5s }\n"
         "task own like carrot_on_plate { layout mine; source " + source + " }\n";
}

}  // namespace

TEST_CASE("a comment and another place need no other files") {
  const plan::Plan before = plan_of(at("(-20cm, -8cm)"));
  CHECK(stage::serves_both(before, plan_of("# a note\n" + at("(-20cm, -8cm)"))));
  CHECK(stage::serves_both(before, plan_of(at("(-18cm, -8cm)"))));
}

TEST_CASE("another object, task or size is loaded anew") {
  const plan::Plan before = plan_of(at("(-20cm, -8cm)"));
  CHECK_FALSE(stage::serves_both(before, plan_of(at("(-20cm, -8cm)", "eggplant"))));
  CHECK_FALSE(stage::serves_both(before, plan_of(at("(-20cm, -8cm)") + "task b like own { }\n")));
  CHECK_FALSE(stage::serves_both(
      before, plan_of("object big like carrot { scale 1.1 }\n" + at("(-20cm, -8cm)", "big"))));
}
