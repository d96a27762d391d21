// Layouts: which starts, in which order. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

std::unique_ptr<Analysis> with_layout(const std::string& body, const std::string& task = "") {
  return clean("layout l { drop 10cm settle 0.5s; " + body +
               " }\ntask v like red_on_tray { layout l; " + task + " }\n");
}

using Starts = std::vector<std::string>;

}  // namespace

TEST_CASE("layout, layout_st: the first number of a grid runs along x, and x runs slowest") {
  // `spread` is half the extent: three cells a side stand at -spread, 0 and +spread.
  const auto a = with_layout(
      "cells c = grid 3 x 2 at (-10cm, 5cm) spread (10cm, 20cm); place source in distinct c\n"
      "place target at (30cm, 0cm); orient source yaw 0deg; orient target yaw 0deg");
  CHECK(starts_text(*a, "v") == Starts{"red -20,-15@0 tray 30,0@0", "red -20,25@0 tray 30,0@0",
                                       "red -10,-15@0 tray 30,0@0", "red -10,25@0 tray 30,0@0",
                                       "red 0,-15@0 tray 30,0@0", "red 0,25@0 tray 30,0@0"});
  // One cell a side has no extent, whatever the spread.
  const auto b = with_layout(
      "cells c = grid 1 x 3 at (0cm, 0cm) spread (10cm, 10cm); place source in distinct c\n"
      "place target at (30cm, 0cm); orient source yaw 0deg; orient target yaw 0deg");
  CHECK(starts_text(*b, "v") ==
        Starts{"red 0,-10@0 tray 30,0@0", "red 0,0@0 tray 30,0@0", "red 0,10@0 tray 30,0@0"});
}

TEST_CASE("layout_st: the first place line varies slowest, `distinct` gives each its own cell") {
  const auto a = with_layout(
      "cells c = grid 1 x 3 at (0cm, 0cm) spread (0cm, 20cm)\nplace target in distinct c\n"
      "place source in distinct c; orient source yaw 0deg");
  CHECK(starts_text(*a, "v") == Starts{"red 0,0@0 tray 0,-20@0", "red 0,20@0 tray 0,-20@0",
                                       "red 0,-20@0 tray 0,0@0", "red 0,20@0 tray 0,0@0",
                                       "red 0,-20@0 tray 0,20@0", "red 0,0@0 tray 0,20@0"});
}

TEST_CASE("layout_st: `remaining` takes the cells that are left, in the order of the distractors") {
  const auto a = with_layout(
      "cells c = grid 1 x 4 at (0cm, 0cm) spread (0cm, 30cm)\nplace source in distinct c\n"
      "place target at (30cm, 0cm); place distractors in remaining c; orient source yaw 0deg",
      "distractors pale, blue");
  CHECK(starts_text(*a, "v") == Starts{"red 0,-30@0 tray 30,0@0 pale 0,-10@0 blue 0,10@0",
                                       "red 0,-10@0 tray 30,0@0 pale 0,-30@0 blue 0,10@0",
                                       "red 0,10@0 tray 30,0@0 pale 0,-30@0 blue 0,-10@0",
                                       "red 0,30@0 tray 30,0@0 pale 0,-30@0 blue 0,-10@0"});
  CHECK(analyze_with_suite("variant v of red_on_tray { distractors pale, blue, g, h, i }\n"
                           "object g like pale { name \"g\" }\nobject h like pale { name \"h\" }\n"
                           "object i like pale { name \"i\" }")
            ->codes() == "P0503");
}

TEST_CASE("layout_st: two spreads are two grids tried in turn, never mixed") {
  const auto a = with_layout(
      "cells c = grid 1 x 2 at (0cm, 0cm) spread (0cm, 10cm), (0cm, 20cm)\n"
      "place source, target in distinct c; orient source yaw 0deg");
  CHECK(starts_text(*a, "v") == Starts{"red 0,-10@0 tray 0,10@0", "red 0,10@0 tray 0,-10@0",
                                       "red 0,-20@0 tray 0,20@0", "red 0,20@0 tray 0,-20@0"});
}

TEST_CASE("layout_st: an object may have a place of its own, wherever it is in a task") {
  const auto a = with_layout(
      "place source at (-20cm, 0cm); place target at (20cm, 0cm); place pale at (0cm, 20cm)\n"
      "place distractors at (0cm, -20cm); orient source yaw 0deg",
      "distractors blue, pale");
  CHECK(starts_text(*a, "v") == Starts{"red -20,0@0 tray 20,0@0 blue 0,-20@0 pale 0,20@0"});
  CHECK(analyze_with_suite("layout l { drop 1cm settle 1s; place source at (0cm, 0cm) }\n"
                           "variant v of red_on_tray { layout l }")
            ->codes() == "P0206");
}

TEST_CASE("layout_st: turns run fastest; `by rest` is each object's own list, in step") {
  const auto a =
      with_layout("place source at (-20cm, 0cm); place target at (20cm, 0cm); orient by rest");
  CHECK(starts_text(*a, "v") == Starts{"red -20,0@0 tray 20,0@0", "red -20,0@90 tray 20,0@0"});
  const auto b = with_layout(
      "place source at (-20cm, 0cm); place target at (20cm, 0cm)\n"
      "orient source yaw 0deg, yaw 45deg, yaw -45deg; orient tray yaw 10deg");
  CHECK(starts_text(*b, "v") == Starts{"red -20,0@0 tray 20,0@10", "red -20,0@45 tray 20,0@10",
                                       "red -20,0@-45 tray 20,0@10"});
  // Without `orient` everything lies in its first rest pose.
  const auto c = with_layout("place source at (-20cm, 0cm); place target at (20cm, 0cm)");
  CHECK(starts_text(*c, "v") == Starts{"red -20,0@0 tray 20,0@0"});
  // Lists of two lengths that are both longer than one do not go in step.
  CHECK(analyze_with_suite("layout l like pairs { orient source yaw 0deg, yaw 1deg, yaw 2deg\n"
                           "orient target yaw 0deg, yaw 1deg }\n"
                           "variant v of red_on_tray { layout l }")
            ->codes() == "P0304");
}

TEST_CASE("layout_st: a copied line for the same object is replaced where it stood") {
  const auto a = clean(
      "layout l like pairs { place source, target in distinct spots; orient source yaw 5deg }\n"
      "layout m like pairs { cells spots = grid 1 x 2 at (0cm, 0cm) spread (0cm, 10cm) }\n"
      "variant v of red_on_tray { layout l; distractors none }\n"
      "variant w of red_on_tray { layout m }\n");
  CHECK(named(a->model.layouts, "l").by_rest == false);
  CHECK(named(a->model.layouts, "l").drop == 0.1);
  CHECK(starts_text(*a, "w") == Starts{"red 0,-10@0 tray 0,10@0", "red 0,-10@90 tray 0,10@0",
                                       "red 0,10@0 tray 0,-10@0", "red 0,10@90 tray 0,-10@0"});
}

TEST_CASE("layout_st: with `drop none` an episode begins as things are placed") {
  const Built built("layout still like pairs { drop none }\nvariant v of red_on_tray { layout still }\n");
  CHECK(built.task("v").drop == 0);
  CHECK(built.task("v").settle == 0);
  CHECK(clean("layout still like pairs { drop none }\nlayout again like still { drop 1cm settle 1s }\n")
            ->model.layouts.size() > 2);
  CHECK(analyze_with_suite("layout l like pairs { drop none settle 1s }\n")->codes() == "P0101");
}

TEST_CASE("layout_st: drop and settle are how long and from where things fall") {
  const Built built(
      "layout high like pairs { drop 25cm settle 2s }\n"
      "variant v of red_on_tray { layout high }\n");
  CHECK(built.task("v").drop == 0.25);
  CHECK(built.task("v").settle == 2);
  const auto& plan = built.plan();
  CHECK(plan.placements(plan.episodes(built.task("v"))[0])[0].position[2] == 0.8 + 0.25);
}

TEST_CASE("layout_st: `expect` counts the starts of every task that uses the layout") {
  CHECK(clean("layout l like pairs { expect 24 episodes }\nvariant v of red_on_tray { layout l; "
              "distractors pale }")
            ->task("v")
            .starts.size() == 24);
  const auto a = analyze_with_suite(
      "layout l like pairs { expect 12 episodes }\nvariant v of red_on_tray { layout l; horizon 61 "
      "steps }");
  CHECK(a->codes() == "P0504");
}

TEST_CASE("layout_st: jitter shifts every start by a draw that depends on the start alone") {
  const auto a = clean(
      "layout l like pairs { jitter 4mm }\nvariant v of red_on_tray { layout l }\n"
      "variant w of v { say take }\n");
  const auto plain = a->task("red_on_tray").starts, moved = a->task("v").starts;
  REQUIRE(plain.size() == moved.size());
  std::set<double> shifts;
  for (std::size_t e = 0; e < plain.size(); ++e) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double dx = moved[e].placed[i].x - plain[e].placed[i].x;
      const double dy = moved[e].placed[i].y - plain[e].placed[i].y;
      const bool small = std::abs(dx) <= 0.004 && std::abs(dy) <= 0.004;
      CHECK(small);
      shifts.insert({dx, dy});
    }
  }
  CHECK(shifts.size() == 4 * plain.size());
  CHECK(starts_text(*a, "v") == starts_text(*a, "w"));
  CHECK(axes_text(*a, "v") == "layout");
}

TEST_CASE("clear: of a layout's starts, those in which phrases of roles are clear") {
  const std::string text =
      "relation first(a: object) \"first\" = all o in alike - {a}: x(a) < x(o) - 1cm\n"
      "object one like red { phrase ahead spatial \"first toy\" means category toy and first }\n"
      "task all like red_on_tray { source one; distractors blue }\n";
  const auto a = clean(text + "task v like all { layout pairs where clear ahead of source }\n");
  CHECK(a->task("all").starts.size() == 24);
  CHECK(a->task("v").starts.size() == 4);
  for (const sema::Start& start : a->task("v").starts) CHECK(start.placed[0].x < start.placed[2].x);
}
