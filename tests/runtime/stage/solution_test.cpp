// Solutions of tasks from their text to episodes: the expert does what the text says.
#include "runtime/stage/solution.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/skills.h"
#include "runtime/stage/stage.h"
#include "runtime/vm/derived_solution.h"
#include "runtime/vm/source_goal.h"
#include "tests/runtime/stage/solves.h"

namespace probe::stage {
namespace {

plan::Plan kitchen_of(const std::string& tasks) {
  const std::string root = VLAPROBE_SOURCE_DIR;
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_solution_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << R"(
use "suite/panda.probe"
use "std/fixtures.probe"
fixture cabinet {
  urdf "fixtures/cabinet/cabinet.urdf"; at (2cm, 32cm, 90cm) yaw -90deg
  joint top friction 1N damping 5Ns/m
  joint middle friction 1N damping 5Ns/m
  joint bottom friction 1N damping 5Ns/m
  part top_drawer link top_drawer name "top drawer"
  region inside_top of top_drawer box (-8cm, -12cm, -3cm) .. (10cm, 12cm, 2cm)
}
fixture stove {
  urdf "fixtures/stove/stove.urdf"; at (14cm, -25cm, 90cm) yaw 180deg
  joint left friction 0.05Nm
  joint right friction 0.05Nm
  part left_knob link left_knob
}
fixture microwave {
  urdf "fixtures/microwave/microwave.urdf"; at (-22cm, -34cm, 90cm) yaw 90deg
  joint hinge friction 0.1Nm damping 0.5Nms/rad
  part door link door name "microwave door"
}
scene wide like panda_table { surface 90cm area (-40cm, -60cm) .. (40cm, 60cm) }
scene drawers like wide { fixture cabinet }
scene cooker like wide { fixture stove }
scene oven like wide { fixture microwave }
layout left like grid_24 { cells corners = grid 2 x 2 at (-20cm, 17cm) spread (6.5cm, 6.5cm) }
abstract task kept like panda_carrot_on_plate { horizon 600 steps }
)" << tasks;
  const std::vector<std::string> files = {file.string()};
  auto made = build(
      files,
      {.asset_root = root + "/assets", .suite = "", .library_folders = {root + "/dsl", root}});
  std::filesystem::remove(file);
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
  REQUIRE_MESSAGE(!made->diagnostics.has_errors(), render_text(made->diagnostics, made->sources));
  auto plan = plan::Plan::from_bytes(std::move(made->plan));
  REQUIRE_MESSAGE(plan.ok(), (plan.ok() ? "" : to_text(plan.failure())));
  return std::move(*plan);
}

plan::Plan the_kitchen() {
  const std::string root = VLAPROBE_SOURCE_DIR;
  const std::vector<std::string> files = {root + "/suite/kitchen.probe"};
  auto made = build(files, {.asset_root = root + "/assets",
                            .suite = "kitchen",
                            .library_folders = {root + "/dsl", root}});
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
  auto plan = plan::Plan::from_bytes(std::move(made->plan));
  REQUIRE_MESSAGE(plan.ok(), (plan.ok() ? "" : to_text(plan.failure())));
  return std::move(*plan);
}

// A table of starts beside the text, of a carrot, a plate and the drawers as rows say.
std::string table_of(const std::string& joints) {
  std::string rows = "start,object,x_m,y_m,z_m,qw,qx,qy,qz,value\n";
  std::size_t start = 0;
  for (std::size_t from = 0; from < joints.size(); ++start) {
    const std::size_t end = joints.find(';', from);
    const std::string number = std::to_string(start);
    rows +=
        number + ",source,-0.2,0.1,0.92,1,0,0,0,\n" + number + ",target,-0.2,-0.1,0.92,1,0,0,0,\n";
    const std::string here = joints.substr(from, end - from);
    const std::size_t comma = here.find(',');
    rows += number + ",cabinet.top,,,,,,,," + here.substr(0, comma) + "\n";
    rows += number + ",cabinet.middle,,,,,,,," + here.substr(comma + 1) + "\n";
    from = end + 1;
  }
  const std::string name = "probe_solution_" + std::to_string(getpid()) + ".csv";
  std::ofstream(std::filesystem::temp_directory_path() / name) << rows;
  return name;
}

// Whether the expert makes the success of a task's start.
bool solves(const plan::Plan& plan, const std::string& name, std::uint32_t start) {
  const std::uint32_t tasks[] = {plan.find_task(name).value()};
  const auto loaded = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE_MESSAGE(loaded.ok(), (loaded.ok() ? "" : to_text(loaded.failure())));
  const auto stage = Stage::create(plan, tasks[0], *loaded, {{}, false});
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  return solves(**stage, plan, start);
}

TEST_CASE("a solution's words are in the plan and in no id, roles stand for what fills them") {
  const plan::Plan plan = kitchen_of(R"(
metrics away { success = at end (closed(cabinet.top_drawer) and put_in(source, cabinet.inside_top)) }
task silent like kept { scene drawers; metrics away; say "put {the source} away" }
task said like silent {
  solution { open cabinet.top_drawer; pick source; put source in cabinet.inside_top; close cabinet.top_drawer }
}
variant spoon of said { source spoon }
variant unsaid of said { solution none; say "put {the source} into the drawer" }
)");
  const auto task = [&](const char* name) { return plan.find_task(name).value(); };
  const auto words = [&](const char* name) {
    std::string text;
    for (const plan::SkillRecord& skill : plan::skills_of(plan.tables(), task(name)))
      text += plan::skill_text(plan.tables(), skill) + "; ";
    return text;
  };
  CHECK(words("silent").empty());
  CHECK(words("unsaid").empty());
  CHECK(words("said") ==
        "open cabinet.top_drawer; pick carrot; put carrot in cabinet.inside_top; "
        "close cabinet.top_drawer; ");
  CHECK(words("spoon").find("put spoon in cabinet.inside_top") != std::string::npos);
  const plan::TaskRecord &a = plan.tasks()[task("silent")], &b = plan.tasks()[task("said")];
  CHECK(a.judge_id == b.judge_id);
  CHECK(plan.episodes(a)[0].episode_id == plan.episodes(b)[0].episode_id);
}

TEST_CASE(
    "what the arm does not reach or the hand cannot hold is not attempted, by skill and reason") {
  const plan::Plan plan = kitchen_of(R"(
use "suite/intact.probe"
fixture near_chest {
  urdf "fixtures/cabinet/cabinet.urdf"; at (-27cm, 30cm, 87cm)
  joint top friction 1N damping 5Ns/m
  part drawer link top_drawer name "drawer"
}
fixture far_chest {
  urdf "fixtures/cabinet/cabinet.urdf"; at (-27cm, 160cm, 87cm)
  joint top friction 1N damping 5Ns/m
  part drawer link top_drawer name "drawer"
}
scene near_widowx like table { fixture near_chest }
scene far_widowx like table { fixture far_chest }
metrics near_open { success = at end opened(near_chest.drawer) }
metrics far_open { success = at end opened(far_chest.drawer) }
task thin like carrot_on_plate { scene near_widowx; metrics near_open; say "open the drawer" }
task far like carrot_on_plate { scene far_widowx; metrics far_open; say "open the drawer" }
)");
  const auto refusal = [&](const char* name) {
    const std::uint32_t tasks[] = {plan.find_task(name).value()};
    const auto loaded = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
    REQUIRE(loaded.ok());
    const auto stage = Stage::create(plan, tasks[0], *loaded, {{}, false});
    REQUIRE(stage.ok());
    const auto expert = expert::make_expert({});
    REQUIRE((*stage)->reset(0).ok());
    REQUIRE((*expert)->begin((*stage)->introduction()).ok());
    const auto action = (*expert)->act(*(*stage)->observe());
    REQUIRE_FALSE(action.ok());
    CHECK(action.failure().code == Fault::kNoSkill);
    return action.failure().message;
  };
  CHECK(refusal("thin") ==
        "skill 1 `open near_chest.drawer`: closed fingers stay 1.2 cm apart, and what they could "
        "hold is thinner");
  CHECK(refusal("far").starts_with(
      "skill 1 `open far_chest.drawer`: it is out of the arm's reach ("));
}

TEST_CASE("what is left or right of something only where things were made up to be is no solution") {
  const plan::Plan plan = kitchen_of(R"(
use "std/space.probe"
use "std/place.probe"
metrics left { success = at end (left_of(source, target) and let_go(source) and displaced(source)) }
metrics right { success = at end (right_of(source, target) and let_go(source) and displaced(source)) }
task to_left like kept { scene drawers; metrics left; say "move {the source} to the left of {the target}" }
task to_right like to_left { metrics right; say "move {the source} to the right of {the target}" }
metrics far { success = at end (far_from(source, target) and let_go(source) and displaced(source)) }
task off like to_left { metrics far; say "move {the source} far from {the target}" }
metrics far_held { success = at end far_from(source, target) }
task away like to_left { metrics far_held; say "move {the source} far from {the target}" }
metrics high { success = at end (height(source) > height(target) + 25cm and let_go(source)) }
task up like to_left { metrics high; say "put {the source} somewhere high" }
metrics behind { success = at end (behind(source, target) and let_go(source) and displaced(source)) }
task to_back like to_left { metrics behind; say "move {the source} behind {the target}" }
role other
layout three { cells c = grid 1 x 3 at (-20cm, 0cm) spread (0cm, 13cm)
  place source, target in distinct c; place other at (-4cm, 0cm)
  orient by rest; drop 30cm settle 0.5s }
metrics amid { success = at end between(source, target, other) }
task to_middle like to_left { layout three; source green_cube; other towel; metrics amid
  say "put {the source} between {the target} and {the other}" }
)");
  for (const char* const name :
       {"to_left", "to_right", "off", "away", "up", "to_back", "to_middle"}) {
    CAPTURE(name);
    const auto has = vm::has_skills(plan, *plan.find_task(name));
    REQUIRE(has.ok());
    CHECK_FALSE(*has);
  }
}

TEST_CASE("where nothing makes success, a thing that has a region of its own is not put into it") {
  const plan::Plan plan = kitchen_of(R"(
object dish like plate { region middle box (-4cm, -4cm, 0cm) .. (4cm, 4cm, 4cm) }
metrics contrary { success = at end (z(source) > z(target) + 30cm and z(target) > z(source) + 30cm and within(position(source), target.middle)) }
task never like kept { target dish; metrics contrary }
suite all { tasks { never }; seeds 0 }
)");
  const auto derived = vm::derive_solution(plan, plan.find_task("never").value());
  REQUIRE_MESSAGE(derived.ok(), (derived.ok() ? "" : to_text(derived.failure())));
  CHECK(derived->empty());
}

TEST_CASE(
    "two things that go to two places in one order are put so, where the text says no skills") {
  const plan::Plan plan = kitchen_of(R"(
use "std/place.probe"
role helper
layout three { cells c = grid 1 x 3 at (-20cm, 0cm) spread (0cm, 13cm)
  place source, target, helper in distinct c; place towel at (-4cm, 0cm)
  orient by rest; drop 30cm settle 0.5s }
metrics in_order { success = at end put_in_order(helper, towel, source, target) }
metrics anyhow { success = at end (on_top_of(source, target) and on_top_of(helper, towel)) }
task ordered like kept { layout three; helper green_cube; metrics in_order
  say "put {the helper} on the towel, then {the source} on {the target}" }
task free like ordered { metrics anyhow; say "put {the source} on {the target} and {the helper} on the towel" }
suite all { tasks { ordered, free }; seeds 0 }
)");
  const auto derived = [&](const char* task) {
    const auto skills = vm::derive_solution(plan, plan.find_task(task).value());
    REQUIRE(skills.ok());
    std::string text;
    for (const plan::SkillRecord& skill : *skills)
      text += (text.empty() ? "" : "; ") + plan::skill_text(plan.tables(), skill);
    return text;
  };
  CHECK(derived("ordered") == "put green_cube on towel; put carrot on plate");
  CHECK(derived("free") == "put carrot on plate; put green_cube on towel");
  CHECK(solves(plan, "ordered", 0));
}

TEST_CASE("what is to be done is found for each start, as its joints begin") {
  const plan::Plan plan = kitchen_of(R"(
use "std/place.probe"
layout begun { starts ")" + table_of("0,0;0.13,0;0.13,0.13;") +
                                     R"("; drop 1cm settle 0.5s }
abstract task begins like kept { scene drawers; layout begun }
metrics laid { success = at end (on_top_of(source, target) and closed(cabinet.top_drawer)) }
metrics shut { success = at end (closed(cabinet.top_drawer) and travel(cabinet.middle) < 1cm) }
task lay like begins { metrics laid; say "put {the source} on {the target} and close the top drawer" }
task shut like begins { metrics shut; say "close all drawers behind {the source} and {the target}" }
suite all { tasks { lay, shut }; seeds 0 }
)");
  const auto to_do = [&](const char* name, std::uint32_t start) {
    const std::uint32_t tasks[] = {plan.find_task(name).value()};
    const auto loaded = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
    REQUIRE(loaded.ok());
    const auto stage = Stage::create(plan, tasks[0], *loaded, {{}, false});
    REQUIRE(stage.ok());
    REQUIRE((*stage)->reset(0).ok());
    REQUIRE((*stage)->reset(start).ok());
    const policy::Privileged& view = *(*stage)->observe()->privileged;
    std::string text = view.goal == policy::Goal::kNothing    ? "nothing"
                       : view.goal == policy::Goal::kOnTarget ? "onto the target"
                                                              : "";
    for (const policy::Skill& skill : view.solution)
      text += skill.name.substr(skill.name.find('`'));
    return text;
  };
  CHECK(to_do("lay", 0) == "onto the target");
  CHECK(to_do("lay", 1) == "`put carrot on plate``close cabinet.top_drawer`");
  CHECK(to_do("shut", 0) == "nothing");
  CHECK(to_do("shut", 1) == "`close cabinet.top_drawer`");
  CHECK(solves(plan, "lay", 0));
  CHECK(solves(plan, "lay", 1));
  CHECK(solves(plan, "shut", 0));
  CHECK(solves(plan, "shut", 1));
}

TEST_CASE("regions of two drawers are two places, though their boxes are one in their own frames") {
  const plan::Plan plan = kitchen_of(R"(
fixture pair {
  urdf "fixtures/cabinet/cabinet.urdf"; at (2cm, 32cm, 90cm) yaw -90deg
  part top_drawer link top_drawer name "top drawer"
  part middle_drawer link middle_drawer name "middle drawer"
  region in_top of top_drawer box (-8cm, -12cm, -3cm) .. (10cm, 12cm, 2cm)
  region in_middle of middle_drawer box (-8cm, -12cm, -3cm) .. (10cm, 12cm, 2cm)
}
scene paired like wide { fixture pair }
layout alone { cells c = grid 2 x 2 at (-20cm, -13cm) spread (6.5cm, 6.5cm); place source in distinct c; orient by rest; drop 10cm settle 0.5s }
metrics stowed { success = at end lies_in(source, target) }
task upper like kept { scene paired; layout alone; metrics stowed; target pair.in_top; say "put {the source} into the top drawer" }
task lower like upper { target pair.in_middle; say "put {the source} into the middle drawer" }
suite all { tasks { upper, lower }; seeds 0 }
)");
  for (const auto& [task, region] : {std::pair{"upper", "top"}, {"lower", "middle"}}) {
    const auto derived = vm::derive_solution(plan, plan.find_task(task).value());
    REQUIRE(derived.ok());
    std::string text;
    for (const plan::SkillRecord& skill : *derived)
      text += plan::skill_text(plan.tables(), skill) + "; ";
    CHECK_MESSAGE(text.find(std::string("put carrot in pair.in_") + region) != text.npos, text);
  }
}

TEST_CASE("a turned region is put into where it is, not in the larger box around it") {
  const plan::Plan plan = kitchen_of(R"(
scene slotted like wide {
  region slot of surface box (-4cm, -9cm, 0cm) .. (4cm, 9cm, 8cm) at (0cm, 10cm, 0cm) yaw 45deg
}
metrics stowed { success = at end within(position(source), surface.slot) }
task straight like kept { scene slotted; metrics stowed; say "put {the source} there"; solution { put source in surface.slot } }
suite all { tasks { straight }; seeds 0 }
)");
  const std::uint32_t task = plan.find_task("straight").value();
  const std::uint32_t tasks[] = {task};
  const auto assets = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE(assets.ok());
  const auto bodies = task_bodies(plan, plan.tasks()[task], **assets);
  REQUIRE(bodies.ok());
  const auto skills = solution_of(plan, plan::skills_of(plan.tables(), task), *bodies);
  REQUIRE(skills.size() == 1);
  REQUIRE(skills[0].region.has_value());
  const policy::Skill::Box& box = *skills[0].region;
  CHECK((box.low - Vec3(-0.04, -0.09, -0.04)).norm() < 1e-12);
  CHECK((box.high - Vec3(0.04, 0.09, 0.04)).norm() < 1e-12);
  CHECK((box.turned.position - Vec3(0, 0.1, 0.94)).norm() < 1e-12);
  const double turned = box.turned.rotation.angularDistance(Quat::Identity());
  CHECK(turned == doctest::Approx(std::numbers::pi / 4));
  const auto derived = vm::derive_solution(plan, task);
  REQUIRE(derived.ok());
  REQUIRE(derived->size() == 1);
  CHECK(plan::skill_text(plan.tables(), derived->front()) == "put carrot in surface.slot");
}

TEST_CASE("the expert opens a drawer, puts the carrot in and closes it") {
  const plan::Plan plan = kitchen_of(R"(
metrics away { success = at end (closed(cabinet.top_drawer) and put_in(source, cabinet.inside_top)) }
task put_away like kept {
  scene drawers; metrics away; say "put {the source} into the top drawer"; horizon 1000 steps
  solution { open cabinet.top_drawer; put source in cabinet.inside_top; close cabinet.top_drawer }
}
)");
  CHECK(solves(plan, "put_away", 0));
}

TEST_CASE("what rides in a drawer that is opened is displaced, and not by itself") {
  const plan::Plan plan = kitchen_of(R"(
use "std/carried.probe"
layout stowed like left { place target at (-20cm, 5cm); place source in cabinet.inside_top; expect 2 episodes }
metrics riding { success = at end (opened(cabinet.top_drawer) and displaced(source) and not once displaced_itself(source, cabinet.top_drawer)) }
task ride like kept {
  scene drawers; layout stowed; metrics riding; say "open the top drawer with {the source} in it, before {the target}"
  solution { open cabinet.top_drawer }
}
suite all { tasks { ride }; seeds 0 }
)");
  CHECK(solves(plan, "ride", 0));
}

TEST_CASE("the expert turns a knob, opens a door and closes it") {
  const plan::Plan plan = kitchen_of(R"(
metrics cooking { success = at end turned(stove.left_knob, 80deg) }
metrics opening { success = at end opened(microwave.door) }
metrics closing { success = at end closed(microwave.door) }
task turn_on like kept { scene cooker; layout left; metrics cooking; say "turn on the stove"; solution { turn stove.left_knob to 90deg } }
task open_oven like kept { scene oven; layout left; metrics opening; say "open the microwave"; solution { open microwave.door } }
task close_oven like kept {
  scene oven; layout left; metrics closing; say "close the microwave"; start microwave.hinge 90deg; solution { close microwave.door }
}
)");
  CHECK(solves(plan, "turn_on", 0));
  CHECK(solves(plan, "open_oven", 1));
  CHECK(solves(plan, "close_oven", 2));
}

TEST_CASE("two things that are put on one plate get places of their own") {
  CHECK(solves(the_kitchen(), "both_on_the_plate", 3));
}

TEST_CASE("a carrot goes across into a drawer in which the fingers cannot open wide") {
  CHECK(solves(the_kitchen(), "carrot_away", 1));
}

TEST_CASE("a knob is turned back until it is closed") {
  CHECK(solves(the_kitchen(), "turn_off_the_stove", 0));
}

}  // namespace
}  // namespace probe::stage
