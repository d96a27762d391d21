#include "runtime/inspect/axes.h"

#include "runtime/base/file.h"

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

// The same without the compiler's word.
Names by_records(const plan::Plan& plan, std::uint32_t a, std::uint32_t b) {
  return stored(difference(plan, a, b).axes);
}

// The plan of a text that uses the suites and the standard library.
plan::Plan compiled(const std::string& text) {
  const std::string root = VLAPROBE_SOURCE_DIR;
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_axes_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << text;
  const std::string files[] = {file.string()};
  auto built = build(
      files,
      {.asset_root = test::asset_root(), .suite = "", .library_folders = {root + "/dsl", root}});
  std::filesystem::remove(file);
  REQUIRE(built.ok());
  INFO(render_text(built->diagnostics, built->sources));
  REQUIRE(built->ok);
  auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE(plan.ok());
  return std::move(*plan);
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
    CHECK(by_records(plan, t, task.baseline) == stored(task.axes & ~plan::kLanguageAxes));
    CHECK(by_records(plan, task.baseline, t) == stored(task.axes & ~plan::kLanguageAxes));
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
    CHECK(by_records(shaken, *shaken.find_task(name), base) == stored(task.axes));
  }
}

TEST_CASE("a robot whose law differs in a number is another scene, not another goal") {
  const auto text = read_file(VLAPROBE_SOURCE_DIR "/suite/panda_robot.probe", {});
  REQUIRE(text.ok());
  const std::size_t begin = text->find("robot panda {"), end = text->find("\n}", begin);
  REQUIRE(end != std::string::npos);
  std::string other = text->substr(begin, end + 2 - begin);
  other.replace(other.find("panda {"), 5, "stiffer");
  REQUIRE(other.find("kp 150") != std::string::npos);
  other.replace(other.find("kp 150"), 6, "kp 151");
  const plan::Plan plan = compiled("use \"suite/panda.probe\"\n" + other + R"(
camera front like agentview { mount stiffer.link0 at (131.86131746834771cm, 0cm, 69.83500240372423cm) look (-0.7779, 0, -0.6284) }
camera hand like eye_in_hand { mount stiffer.right_hand at (5cm, 0cm, 0cm) quat (0, 0.70710678118654757, 0, 0.70710678118654757) }
scene stiffer_table like panda_table {
  robot stiffer at (-66cm, 0cm, 91.2cm) yaw 0deg
  camera front as agentview, hand as wrist
}
variant stiff of panda_carrot_on_plate { scene stiffer_table }
suite laws { tasks { panda_carrot_on_plate, stiff }; seeds 1 }
)");
  const std::uint32_t base = *plan.find_task("panda_carrot_on_plate");
  const std::uint32_t stiff = *plan.find_task("stiff");
  CHECK(stored(plan.tasks()[stiff].axes) == Names{"scene"});
  CHECK(axes_between(plan, base, stiff) == Names{"scene"});
  CHECK(axes_between(plan, stiff, base) == Names{"scene"});
  CHECK(by_records(plan, base, stiff) == Names{"scene"});
}

TEST_CASE("a copy of a fixture whose joint starts elsewhere differs by the fixture alone") {
  const plan::Plan plan = compiled(R"(
use "examples/drawer.probe"
fixture ajar like cabinet { joint top friction 1N damping 5Ns/m start 2cm }
scene wide like panda_table { surface 90cm area (-40cm, -60cm) .. (40cm, 60cm) }
scene shut_scene like wide { fixture cabinet }
scene ajar_scene like wide { fixture ajar }
task shut like panda_carrot_on_plate { scene shut_scene; layout before_it }
variant begun of shut { scene ajar_scene }
suite begun_suite { tasks { shut, begun }; seeds 1 }
)");
  const std::uint32_t base = *plan.find_task("shut"), begun = *plan.find_task("begun");
  CHECK(stored(plan.tasks()[begun].axes) == Names{"fixture"});
  CHECK(axes_between(plan, base, begun) == Names{"fixture"});
  CHECK(by_records(plan, base, begun) == Names{"fixture"});
}

TEST_CASE("a surface of another height takes the fixtures that stand on it with it") {
  const plan::Plan plan = compiled(R"(
use "suite/kitchen.probe"
scene high like counter { surface 94cm area (-42cm, -26cm) .. (26cm, 30cm) }
variant higher of carrot_in_the_drawer { scene high }
task as_high like carrot_in_the_drawer { scene high }
suite heights { tasks { carrot_in_the_drawer, higher, as_high }; seeds 1 }
)");
  const std::uint32_t base = *plan.find_task("carrot_in_the_drawer");
  const std::uint32_t higher = *plan.find_task("higher"), alike = *plan.find_task("as_high");
  CHECK(stored(plan.tasks()[higher].axes) == Names{"scene.geometry"});
  CHECK(axes_between(plan, base, higher) == Names{"scene.geometry"});
  CHECK(by_records(plan, base, higher) == Names{"scene.geometry"});
  CHECK(axes_between(plan, base, alike) == Names{"scene.geometry"});
  CHECK(axes_between(plan, alike, higher).empty());
}

TEST_CASE("words that follow what fills a role are the same words") {
  const plan::Plan plan = compiled(R"(
use "suite/panda.probe"
role goods: set
layout sets like grid_24 {
  cells corners = grid 2 x 2 at (-14cm, 0cm) spread (7.5cm, 7.5cm)
  place target, goods in distinct corners
  orient by rest
  expect 48 episodes
}
metrics all_there { success = at end (all g in goods: height(g) > height(target)) }
task two like panda_carrot_on_plate {
  layout sets; source none; goods green_cube, yellow_cube; target plate; metrics all_there
  say "put {both goods} on {the target}"
}
variant others of two { goods green_cube, carrot }
variant third of two { goods carrot, yellow_cube }
variant said of two { say "move {both goods} onto {the target}" }
suite sets_suite { tasks { two, others, third, said }; seeds 1 }
)");
  const std::uint32_t base = *plan.find_task("two");
  const std::uint32_t others = *plan.find_task("others"), third = *plan.find_task("third");
  CHECK(plan.text(plan.tasks()[base].prompt) != plan.text(plan.tasks()[others].prompt));
  CHECK(axes_between(plan, base, others) == Names{"object.goods"});
  CHECK(axes_between(plan, others, third) == Names{"object.goods"});
  CHECK(axes_between(plan, others, *plan.find_task("said")) == Names{"object.goods", "language"});
}
