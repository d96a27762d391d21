#include <doctest/doctest.h>

#include <cmath>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

// "red(-0.1,0.1) tray(...)" of one start.
std::string places(const test::Analysis& a, const sema::Task& task, std::size_t episode) {
  std::string text;
  for (const auto& placed : task.starts[episode].placed) {
    char part[96];
    std::snprintf(part, sizeof part, "%s%s(%.17g,%.17g)", text.empty() ? "" : " ",
                  a.model.objects[placed.object].name.c_str(), placed.x, placed.y);
    text += part;
  }
  return text;
}

}  // namespace

TEST_CASE("the first line of a layout varies slowest and the turn fastest") {
  const auto a = analyze_with_suite("");
  const sema::Task& task = a->task("red_on_tray");
  REQUIRE(task.starts.size() == 24);
  CHECK(places(*a, task, 0) ==
        "red(-0.10000000000000001,-0.10000000000000001) "
        "tray(-0.10000000000000001,0.10000000000000001)");
  CHECK(places(*a, task, 1) == places(*a, task, 0));
  CHECK(task.starts[0].placed[0].turn.rotation == std::array<double, 4>{1, 0, 0, 0});
  CHECK(task.starts[1].placed[0].turn.rotation[3] == doctest::Approx(std::sqrt(0.5)));
  CHECK(task.starts[2].placed[1].x == 0.1);
  CHECK(task.starts[2].placed[1].y == -0.1);
  CHECK(task.starts[6].placed[0].y == 0.1);
  CHECK(task.starts[6].placed[1].y == -0.1);
}

TEST_CASE("distractors fill the remaining cells in the order of their declaration") {
  const auto a = analyze_with_suite("variant v of red_on_tray { distractors blue, pale }");
  const sema::Task& task = a->task("v");
  REQUIRE(task.starts.size() == 24);
  CHECK(task.starts[0].placed.size() == 4);
  CHECK(task.starts[0].placed[2].x == 0.1);
  CHECK(task.starts[0].placed[2].y == -0.1);
  CHECK(task.starts[0].placed[3].y == 0.1);
}

TEST_CASE("a place by an object's own name wins over that of its role, whichever is said first") {
  const auto a = analyze_with_suite(
      "layout filled like pairs { place blue at (-27cm, 15cm) }\n"
      "layout held like pairs { place red at (-27cm, 15cm) }\n"
      "variant v of red_on_tray { distractors blue, pale }\n"
      "variant named of v { layout filled }\nvariant source_too of v { layout held }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const sema::Task& named = a->task("named");
  CHECK(named.axes == static_cast<std::uint32_t>(plan::Axis::kLayout));
  REQUIRE(named.starts.size() == 24);
  for (const sema::Start& start : named.starts) {
    REQUIRE(start.placed.size() == 4);
    CHECK(start.placed[2].x == -0.27);
    CHECK(start.placed[2].y == 0.15);
  }
  // The other distractor has the first of the cells that are left.
  CHECK(named.starts[0].placed[3].x == 0.1);
  CHECK(named.starts[0].placed[3].y == -0.1);
  // The target alone has a cell of its own: four places, two turns.
  const sema::Task& held = a->task("source_too");
  REQUIRE(held.starts.size() == 8);
  CHECK(held.starts[0].placed[0].x == -0.27);
}

TEST_CASE("what a layout places twice is told at the second place") {
  for (const char* lines :
       {"place red at (-16cm, 0cm); place red at (0cm, 0cm)", "place red, red at (0cm, 0cm)",
        "place source at (-16cm, 0cm); place source at (0cm, 0cm)",
        "place distractors at (-16cm, 0cm); place distractors at (0cm, 0cm)"}) {
    const auto a = analyze_with_suite("layout l like pairs { " + std::string(lines) + " }");
    CHECK_MESSAGE(a->codes() == "P0203", std::string(lines), ": ", a->said());
    CHECK(a->said().find("is placed twice") != std::string::npos);
  }
  // A copy's line takes the place of the one that it copied.
  CHECK(analyze_with_suite("layout l like pairs { place source, target at (0cm, 0cm) }")->codes() ==
        "");
}

TEST_CASE("two spreads are two grids in turn that never mix") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells spots = grid 2 x 2 at (-16cm, 0cm) spread (5cm, 5cm), (10cm, "
      "10cm)\n"
      "orient source yaw 0deg }\ntask t like red_on_tray { layout l }");
  const sema::Task& task = a->task("t");
  CHECK_MESSAGE(a->codes() == "", a->said());
  REQUIRE(task.starts.size() == 24);
  CHECK(task.starts[0].placed[0].x == -0.21);
  CHECK(task.starts[11].placed[0].x == -0.11);
  CHECK(task.starts[12].placed[0].x == -0.26);
}

TEST_CASE("a grid of four steps has the thirds of a spread, rounded once") {
  const auto a = analyze_with_suite(
      "layout l { cells patch = grid 2 x 4 at (-10.5cm, 20.6cm) spread (1cm, 1.5cm); place source "
      "in distinct patch\n"
      "place target at (-12.5cm, 2.5cm); orient source yaw 0deg, yaw 45deg, yaw -45deg; drop 50cm "
      "settle 1s; "
      "expect 24 episodes }\n"
      "task t like red_on_tray { layout l }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const sema::Task& task = a->task("t");
  REQUIRE(task.starts.size() == 24);
  CHECK(task.starts[0].placed[0].x == -0.115);
  CHECK(task.starts[0].placed[0].y == 0.191);
  CHECK(task.starts[3].placed[0].y == 0.201);
  CHECK(task.starts[6].placed[0].y == 0.211);
  CHECK(task.starts[12].placed[0].x == -0.095);
  CHECK(task.starts[12].placed[1].x == -0.125);
}

TEST_CASE("a pose of a task replaces the rest poses of that object only there") {
  const auto a = analyze_with_suite("variant v of red_on_tray { pose red yaw 0deg, yaw 0deg }");
  CHECK(a->task("v").starts[1].placed[0].turn == a->task("v").starts[0].placed[0].turn);
  CHECK_FALSE(a->task("red_on_tray").starts[1].placed[0].turn ==
              a->task("red_on_tray").starts[0].placed[0].turn);
  CHECK(a->task("v").axes == static_cast<std::uint32_t>(plan::Axis::kLayout));
}

TEST_CASE("turns are exact at multiples of ninety degrees and free of negative zeros") {
  const auto a = analyze_with_suite("object o like red { rest yaw 180deg, roll 90deg yaw 90deg }");
  const sema::Object& object = a->model.objects[static_cast<sema::ObjectId>(4)];
  CHECK(object.rest[0].rotation == std::array<double, 4>{0, 0, 0, 1});
  CHECK_FALSE(std::signbit(object.rest[0].rotation[0]));
  // Roll first, then yaw, about the world's axes: q = qz qx.
  for (const double part : object.rest[1].rotation) CHECK(part == doctest::Approx(0.5));
}

TEST_CASE("more objects than cells, unmet expectations and unplaced objects are reported") {
  CHECK(analyze_with_suite(
            "layout l like pairs { cells spots = grid 1 x 2 at (0cm, 0cm) spread (10cm, 10cm) }\n"
            "task t like red_on_tray { layout l; distractors blue }")
            ->codes() == "P0503");
  CHECK(analyze_with_suite(
            "layout l like pairs { expect 23 episodes }\ntask t like red_on_tray { layout l }")
            ->codes() == "P0504");
  CHECK(analyze_with_suite("layout l { place source at (0cm, 0cm); drop 1cm settle 1s }\ntask t "
                           "like red_on_tray { layout l }")
            ->codes() == "P0206");
  CHECK(analyze_with_suite("object o like red { rest yaw 0deg, yaw 1deg, yaw 2deg }\ntask t like "
                           "red_on_tray { source o }")
            ->codes() == "P0304");
}

TEST_CASE("jitter moves every object by its own draw, and other tasks shift nothing") {
  const std::string text =
      "layout shaken like pairs { jitter 5mm }\ntask t like red_on_tray { layout shaken }\n";
  const auto a = analyze_with_suite(text);
  const auto b = analyze_with_suite("task s like base { source blue; target tray; layout shaken }" +
                                    text + "variant u of t { say take }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const auto& plain = a->task("red_on_tray").starts;
  const auto& shaken = a->task("t").starts;
  REQUIRE(shaken.size() == plain.size());
  double least = 1, most = -1;
  for (std::size_t e = 0; e < plain.size(); ++e) {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& here = shaken[e].placed[i];
      CHECK(here.x == b->task("t").starts[e].placed[i].x);
      CHECK(here.y == b->task("t").starts[e].placed[i].y);
      CHECK(here.x == b->task("u").starts[e].placed[i].x);
      const double dx = here.x - plain[e].placed[i].x;
      CHECK(std::abs(dx) <= 0.005);
      least = std::min(least, dx);
      most = std::max(most, dx);
    }
  }
  CHECK(least < -0.003);
  CHECK(most > 0.003);
  CHECK(analyze_with_suite("layout l like pairs { jitter -5mm }")->codes() == "P0304");
}

TEST_CASE(
    "the draw of an object depends on the start and its own name, not on what stands around") {
  const auto a = analyze_with_suite(R"(
layout shaken like pairs { jitter 5mm }
task t like red_on_tray { layout shaken }
variant crowded of t { distractors pale }
variant other of t { source blue }
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const auto& plain = a->task("t").starts;
  const auto& crowded = a->task("crowded").starts;
  const auto& other = a->task("other").starts;
  REQUIRE(plain.size() == crowded.size());
  REQUIRE(plain.size() == other.size());
  std::size_t moved = 0;
  for (std::size_t e = 0; e < plain.size(); ++e) {
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(crowded[e].placed[i].x == plain[e].placed[i].x);
      CHECK(crowded[e].placed[i].y == plain[e].placed[i].y);
    }
    CHECK(other[e].placed[1].x == plain[e].placed[1].x);
    CHECK(other[e].placed[1].y == plain[e].placed[1].y);
    moved += other[e].placed[0].x != plain[e].placed[0].x ? 1 : 0;
  }
  CHECK(moved == plain.size());
}

TEST_CASE("cells of a grid ascend even where no decimal holds them") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells far = grid 7 x 1 at (499.9999999999999m, 0cm) spread "
      "(499.999999999999899m, 0.000000000000000001mm) }");
  for (const sema::Layout& layout : a->model.layouts) {
    if (layout.name != "l") continue;
    const auto& grid = layout.cells.back().grids.front();
    REQUIRE(grid.size() == 7);
    for (std::size_t i = 1; i < grid.size(); ++i) CHECK(grid[i].x > grid[i - 1].x);
  }
}

TEST_CASE("a task with no object in its scene has one start") {
  const auto a = analyze_with_suite(
      std::string(test::kChest) +
      "metrics pulled { success = at end slide(target) > 10cm }\n"
      "layout nothing { drop none; expect 1 episodes }\n"
      "layout nobody like nothing {\n"
      "  cells spots = grid 2 x 2 at (0cm, 0cm) spread (5cm, 5cm)\n"
      "  place distractors in remaining spots; orient by rest\n"
      "}\n"
      "task open { scene room; layout nothing; metrics pulled; horizon 60 steps\n"
      "            target chest.drawer; say \"open {the target}\" }\n"
      "task open_again like open { layout nobody }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  for (const char* name : {"open", "open_again"}) {
    REQUIRE(a->task(name).starts.size() == 1);
    CHECK(a->task(name).starts.front().placed.empty());
  }
}
