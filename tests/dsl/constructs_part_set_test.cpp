// Sets of parts of fixtures, and parts as distractors. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include "runtime/plan/roles.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

const std::string kDrawers = std::string(kChest) + R"(
fixture near like chest { part drawer link drawer name "near drawer" }
fixture other like chest { at (0cm, 60cm, 85cm) yaw 90deg; part drawer link drawer name "far drawer" }
fixture third like chest { at (40cm, 60cm, 85cm) yaw 90deg; part drawer link drawer name "third drawer" }
scene hall like room { fixture near, other, third }
layout alone { cells spots = grid 2 x 2 at (0cm, -10cm) spread (10cm, 10cm)
  place distractors in distinct spots; orient by rest; drop 10cm settle 0.5s }
role drawers: set
predicate is_open(p: part) = travel(p) > 0.4 * range(p)
metrics opening {
  success = at end (all d in drawers: is_open(d))
  wrong   = once any d in distractors & parts: is_open(d)
  moved   = once any d in distractors & objects: speed(d) > 1m/s
}
task open_two like base {
  scene hall; layout alone; source none; target none; metrics opening
  drawers near.drawer, other.drawer; distractors third.drawer, red
  say "open {the drawers}"
}
)";

std::string codes(const std::string& more) { return analyze_with_suite(kDrawers + more)->codes(); }

}  // namespace

TEST_CASE("task_st: parts fill a set, and a part may be a distractor") {
  const Built built(kDrawers + R"(
variant others of open_two { drawers other.drawer, third.drawer; distractors near.drawer, red }
variant fewer of open_two { distractors red }
variant turned_about of open_two { drawers other.drawer, near.drawer }
)");
  CHECK(built.prompt("open_two") == "open the near drawer and the far drawer");
  const auto& tables = built.plan().tables();
  CHECK(plan::things_in(tables, built.task("open_two"), "drawers") ==
        std::vector<std::string_view>{"near.drawer", "other.drawer"});
  CHECK(plan::part_distractors_of(tables, built.task("open_two")) ==
        std::vector<std::string_view>{"third.drawer"});
  CHECK(built.task("open_two").distractors == 1);  // objects alone have a place
  const auto axes = [&](const std::string& task) { return plan::moved_axes(tables, built.task(task)); };
  CHECK(axes("others") == std::vector<std::string>{"object.drawers", "distractors"});
  CHECK(axes("fewer") == std::vector<std::string>{"distractors"});
  CHECK(axes("turned_about") == std::vector<std::string>{"object.drawers"});
}

TEST_CASE("task_st: words that count drawers are told apart from those that are there") {
  CHECK(codes("task t like open_two { say \"open {both drawers}\" }\n") != "");
  CHECK(codes("task t like open_two { drawers near.drawer, other.drawer, third.drawer; distractors red\n"
              "  say \"open {all three drawers}\" }\n") == "");
}

TEST_CASE("sets and distractors take objects and parts, each once, and no regions") {
  CHECK(codes("task t like open_two { drawers near.drawer, red; distractors none }\n").find("P1105") !=
        std::string::npos);
  CHECK(codes("task t like open_two { drawers near.inside }\n").find("P1105") != std::string::npos);
  CHECK(codes("task t like open_two { distractors near.inside, red }\n").find("P1105") !=
        std::string::npos);
  CHECK(codes("task t like open_two { distractors third.drawer, third.drawer }\n").find("P0203") !=
        std::string::npos);
  CHECK(codes("task t like open_two { distractors near.drawer, red }\n").find("P0203") !=
        std::string::npos);
  CHECK(codes("task t like open_two { scene room; drawers chest.drawer, near.drawer; distractors red }\n").find("P0201") !=
        std::string::npos);
}

TEST_CASE("what objects alone have is not asked of a drawer") {
  const auto said = failed_build(
      kDrawers +
      "task t like open_two { set moved = once any d in distractors: moved_xy(d) > 1cm }\n");
  CHECK(said.find("`moved_xy` takes an object, found `third.drawer`") != std::string::npos);
  CHECK(said.find("`distractors & objects`") != std::string::npos);
}

TEST_CASE("derive: a task's own distractors are parts, too") {
  const auto a = clean(kDrawers +
                       "derive \"{t}_not_{o}\" for t in { open_two }, o in distractors of t {\n"
                       "  say \"open {the drawers}, not {avoid the o}\"\n"
                       "}\n");
  CHECK(a->task("open_two_not_drawer").prompt == "open the near drawer and the far drawer, not the third drawer");
  CHECK(a->task("open_two_not_red").prompt == "open the near drawer and the far drawer, not the red block");
}

TEST_CASE("set1, thing_set: parts of fixtures that are named, or left out by name") {
  const Built built(kDrawers + R"(
task by_role like open_two { set success = at end (all d in drawers: is_open(d)) }
task named like open_two { set success = at end (all p in {near.drawer, other.drawer}: is_open(p)) }
task spaced like open_two { set success = at end (all p in { near . drawer,
  other.drawer }: is_open(p)) }
task left_out like open_two {
  set success = at end (all p in parts - {third.drawer} - whole near.door: is_open(p))
}
)");
  const auto judge = built.task("by_role").judge_id;
  CHECK(built.task("named").judge_id == judge);
  CHECK(built.task("spaced").judge_id == judge);
  CHECK(built.task("left_out").judge_id != judge);
}

TEST_CASE("set1: a part that there is not is named at its place, and a region is no body") {
  const auto said = [](const std::string& set) {
    const auto a = analyze_with_suite(kDrawers + "task t like open_two { set success = at end (all p in " +
                                      set + ": is_open(p)) }\n");
    const std::string text = a->said();
    return text.substr(0, text.find('\n'));
  };
  CHECK(said("{near.drawr}") ==
        "error[P0201]: unknown part, joint or region of `near` `drawr`");
  CHECK(said("{naer.drawer}") == "error[P0201]: unknown name `naer`");
  CHECK(said("{near.inside}") == "error[P0601]: expected a body, found a region");
  CHECK(said("{near.drawer, red}") == "error[P0601]: expected a part, found a body");
}
