// Spaces: what may vary about a task. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include <algorithm>

#include "compiler/model/model.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

std::string axes_of(const sema::Space& space) {
  std::string text;
  for (const sema::SpaceAxis& axis : space.axes) text += axis.name + " ";
  return text;
}

}  // namespace

TEST_CASE(
    "space, space_st, lit, sense, range: ranges with what the task has, in the order of the text") {
  const auto text = analyze_with_suite(
      "task t like red_on_tray { }\n"
      "space s of t {\n"
      "  light ambient 0.1 .. 0.5, power 0.5 .. 2, direction within 30deg\n"
      "  sensor noise 0 .. 0.1, exposure 0.5 .. 2\n"
      "  delay 0ms .. 400ms\n"
      "  clutter 0 .. 3 from (blue, pale)\n"
      "  place source in disc 2cm, target in disc 3cm\n"
      "}\n");
  REQUIRE(text->codes().empty());
  REQUIRE(text->model.spaces.size() == 1);
  const sema::Space& space = text->model.spaces[0];
  CHECK(space.name == "s");
  CHECK(text->model.tasks[space.of].name == "t");
  CHECK(axes_of(space) ==
        "light.ambient light.power light.direction sensor.noise sensor.exposure delay clutter "
        "place.source place.target ");
  CHECK(space.axes[0].low == 0.1);
  CHECK(space.axes[0].own == 0.3);
  CHECK(space.axes[1].own == 1);
  CHECK(space.axes[2].low == 0);
  CHECK(space.axes[2].high == doctest::Approx(0.5235988));
  CHECK(space.axes[5].high == 2);  // steps of 5 Hz
  CHECK(space.clutter.size() == 2);
  CHECK(space.axes[8].high == 0.03);
}

TEST_CASE("pool_of: words of a frame that fit the task, and phrases of what fills a role") {
  const auto text = analyze_with_suite(
      "template lay frame put \"lay {the source} on {the target}\"\n"
      "template drop frame put \"drop {the source}, not {avoid the target}\"\n"
      "task t like red_on_tray { refer source as loved }\n"
      "space s of t { words templates of put, phrases of source }\n");
  REQUIRE(text->codes().empty());
  const sema::Space& space = text->model.spaces[0];
  REQUIRE(axes_of(space) == "words phrase.source ");
  CHECK(space.axes[0].choices == std::vector<std::string>{"", "lay", "drop"});
  CHECK(space.axes[1].choices == std::vector<std::string>{"loved", "by_color", "toy"});
}
