#include "runtime/inspect/axes.h"

#include "tests/runtime/inspect/small_plan.h"

using namespace probe;
using namespace probe::inspect;
using Names = std::vector<std::string>;

namespace {

Names between(const char* a, const char* b) {
  return axes_between(test::small_plan(), test::task(a), test::task(b));
}

// By the names of the table, as a variant has them stored.
Names stored(std::uint32_t axes) {
  const auto names = probe::plan::axis_names(axes);
  return {names.begin(), names.end()};
}

}  // namespace

TEST_CASE("the records of a variant and its baseline say the same axes as the compiler") {
  const plan::Plan& plan = test::small_plan();
  std::size_t pairs = 0;
  for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) {
    const plan::TaskRecord& task = plan.tasks()[t];
    if (task.baseline == plan::kNone) continue;
    ++pairs;
    INFO(plan.text(task.name));
    CHECK(axes_between(plan, t, task.baseline) == stored(task.axes));
    CHECK(axes_between(plan, task.baseline, t) == stored(task.axes));
    CHECK(difference(plan, t, task.baseline).language == ((task.axes & plan::kLanguageAxes) != 0));
  }
  CHECK(pairs == 6);
}

TEST_CASE("tasks with other objects and the same words differ on no language axis") {
  CHECK(between("base", "other") == Names{"object.source"});
}

TEST_CASE("between tasks that are not compared language is one axis") {
  CHECK(between("worded", "colored") == Names{"language"});
  CHECK(between("worded", "dim") == Names{"light", "language"});
  CHECK(between("both", "worded") == Names{"distractors"});
}

TEST_CASE("a task differs from itself on no axis") { CHECK(between("both", "both").empty()); }

TEST_CASE("other places are another layout, whatever the layout is called") {
  const plan::Plan moved = test::compile_small(R"(
layout same like grid_24 { expect 24 episodes }
layout apart like grid_24 { cells corners = grid 2 x 2 at (-16cm, 0cm) spread (7cm, 7cm) }
task same_places like on_table { source carrot; target plate; layout same }
task other_places like on_table { source carrot; target plate; layout apart }
suite moved { tasks { same_places, other_places }; seeds 1 }
)");
  const std::uint32_t base = *moved.find_task("base");
  CHECK(axes_between(moved, base, *moved.find_task("same_places")).empty());
  CHECK(axes_between(moved, base, *moved.find_task("other_places")) == Names{"layout"});
}

TEST_CASE("a layout that shifts objects is the same layout for another object") {
  const plan::Plan shaken = test::compile_small(R"(
layout shaken like grid_24 { jitter 2mm }
task carrots like on_table { source carrot; target plate; layout shaken }
variants of carrots { spoons { source spoon }; covered { distractors towel }; straight { layout grid_24 } }
)");
  const std::uint32_t base = *shaken.find_task("carrots");
  CHECK(axes_between(shaken, base, *shaken.find_task("spoons")) == Names{"object.source"});
  CHECK(axes_between(shaken, *shaken.find_task("spoons"), base) == Names{"object.source"});
  CHECK(axes_between(shaken, base, *shaken.find_task("covered")) == Names{"distractors"});
  CHECK(axes_between(shaken, base, *shaken.find_task("straight")) == Names{"layout"});
  for (const char* name : {"spoons", "covered", "straight"}) {
    const plan::TaskRecord& task = shaken.tasks()[*shaken.find_task(name)];
    CHECK(axes_between(shaken, *shaken.find_task(name), base) == stored(task.axes));
  }
}
