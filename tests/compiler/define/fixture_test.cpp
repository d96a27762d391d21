// Fixtures with joints: read with their URDF, and every mistake at its place.
#include "compiler/define/fixture.h"

#include <doctest/doctest.h>

#include "compiler/define/solution.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::unique_ptr<test::Analysis> with_chest(const std::string& more) {
  return analyze_with_suite(test::kChest + more);
}

// The code and the underlined words of one mistake in a fixture of its own: "P0201 `x`".
std::string mistake(const std::string& lines, const std::string& more = "") {
  const auto a = with_chest("fixture box { urdf \"chest/chest.urdf\"; at (0cm, 0cm, 0cm)\n" +
                            lines + "\n}\n" + more);
  return a->codes() + (a->codes().empty() ? "" : " `" + a->underlined() + "`");
}

// The same of a task in the room.
std::string in_task(const std::string& statement) {
  const auto a = with_chest("task t like red_on_tray { scene room; " + statement + " }");
  return a->codes() + (a->codes().empty() ? "" : " `" + a->underlined() + "`");
}

// A description of links and joints, in which only what differs is written.
std::string odd_link(const std::string& name, const std::string& mass = "1",
                     const std::string& com = "0 0 0", bool touches = true) {
  return "<link name=\"" + name + "\"><inertial><origin xyz=\"" + com + "\"/><mass value=\"" +
         mass +
         "\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" ixz=\"0\" "
         "iyz=\"0\"/></inertial>" +
         (touches ? "<collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision>"
                  : "") +
         "</link>";
}
std::string odd_joint(const std::string& name, const std::string& type, const std::string& parent,
                      const std::string& child, const std::string& axis, const std::string& origin,
                      const std::string& limits = "lower=\"-1\" upper=\"1\"",
                      const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><origin xyz=\"" + origin + "\"/><axis xyz=\"" + axis +
         "\"/><limit " + limits + " effort=\"1\" velocity=\"1\"/>" + more + "</joint>";
}

// A fixture `f` of that description in a room of its own.
std::unique_ptr<test::Analysis> with_odd(const std::string& described, const std::string& lines,
                                         const std::string& more = "") {
  static int count = 0;
  const std::string file = "odd/" + std::to_string(count++) + ".urdf";
  test::write_text(std::filesystem::path(test::asset_root()) / file,
                   "<robot name=\"odd\">" + described + "</robot>");
  return analyze_with_suite("fixture f { urdf \"" + file + "\"; at (0cm, 30cm, 185cm)\n" + lines +
                            "\n}\nscene room like bench { fixture f }\n" + more);
}
// Its code, what is underlined, and the message of the first mistake.
std::string odd(const std::string& described, const std::string& lines,
                const std::string& more = "") {
  const auto a = with_odd(described, lines, more);
  if (a->codes().empty()) return "";
  return a->codes() + " `" + a->underlined() + "` " + a->diagnostics.items().front().message;
}

}  // namespace

TEST_CASE("a fixture has the joints of its URDF with what the text says acts in them") {
  const auto a = with_chest("");
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  const sema::Fixture& chest = *a->model.fixtures.begin();
  REQUIRE(chest.joints.size() == 3);
  CHECK(chest.joints[0].name == "slide");
  CHECK(chest.joints[0].slides);
  CHECK(chest.joints[0].friction == 2);
  CHECK(chest.joints[0].damping == 5);
  CHECK(chest.joints[0].start == 0.04);
  CHECK(!chest.joints[0].closes_at_upper());
  CHECK(chest.joints[1].closes_at_upper());
  CHECK(chest.joints[1].stiffness == 0.5);
  CHECK(chest.joints[2].is_endless);
  REQUIRE(chest.parts.size() == 4);  // what nothing can touch is none
  CHECK(chest.body_name(chest.parts[0]) == "chest");
  CHECK(chest.body_name(chest.parts[1]) == "chest.drawer");
  CHECK(chest.parts[1].joint == 0u);
  CHECK(!chest.parts[0].joint);
  CHECK(!chest.parts[3].joint);  // the lid is glued
  CHECK(chest.regions[1].part == 0);
}

TEST_CASE("a copy stands elsewhere and keeps the rest") {
  const auto a = with_chest(
      "fixture other like chest { at (0cm, -30cm, 85cm) }\n"
      "scene two like room { fixture chest, other }");
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  const sema::Fixture& other = a->model.fixtures[static_cast<sema::FixtureId>(1)];
  CHECK(other.position[1] == -0.3);
  CHECK(other.joints[0].friction == 2);
  CHECK(other.body_name(other.parts[1]) == "other.drawer");
}

TEST_CASE("mistakes in a fixture are said at their place") {
  CHECK(mistake("joint slide friction 2N").empty());
  CHECK(mistake("joint slyde friction 2N") == "P0201 `slyde`");
  CHECK(mistake("joint glue friction 2N") == "P1301 `glue`");
  CHECK(mistake("joint slide friction 2Nm") == "P0302 `joint slide friction 2Nm`");
  CHECK(mistake("joint slide start 30cm") == "P0304 `30cm`");
  CHECK(mistake("joint slide start 10deg") == "P0302 `joint slide start 10deg`");
  CHECK(mistake("joint slide friction -2N") == "P0304 `-2N`");
  CHECK(mistake("joint hinge friction 0.1Nm stiffness 1Nm/rad at 0deg stay") ==
        "P1303 `joint hinge friction 0.1Nm stiffness 1Nm/rad at 0deg stay`");
  CHECK(mistake("part a link drower") == "P0201 `drower`");
  CHECK(mistake("part a link bell") == "P1301 `bell`");
  CHECK(mistake("part a link door; part b link door") == "P0203 `door`");
  CHECK(mistake("joint slide friction 2N; part slide link door") == "P0203 `slide`");
  CHECK(mistake("region r of door box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1cm)") == "P0201 `door`");
  CHECK(mistake("region r of box box (0cm, 0cm, 0cm) .. (1cm, 1cm, 0cm)") ==
        "P0304 `(0cm, 0cm, 0cm) .. (1cm, 1cm, 0cm)`");
  CHECK(with_chest("fixture f { at (0cm, 0cm, 0cm) }")->codes() == "P0206");
  CHECK(with_chest("fixture f { urdf \"none.urdf\"; at (0cm, 0cm, 0cm) }")->codes() == "P0202");
  CHECK(with_chest("scene s like bench { fixture chest, chest }")->codes() == "P0203");
  CHECK(with_chest("scene s like bench { fixture chair }")->codes() == "P0201");
  CHECK(with_chest("scene s like bench { region r of fixture box (0cm, 0cm, 0cm) .. (1cm, 1cm, "
                   "1cm) }")
            ->codes() == "P0201");
}

TEST_CASE("joints start as the task says, else its layout, else the fixture") {
  const auto starts = [](const std::string& more, const char* task) {
    const auto a = with_chest(more);
    REQUIRE_MESSAGE(a->codes().empty(), a->said());
    return sema::joint_starts_of(a->model, a->task(task));
  };
  const std::string text =
      "layout ajar like pairs { start chest.slide 10cm }\n"
      "task a like red_on_tray { scene room }\n"
      "task b like a { layout ajar }\n"
      "task c like b { start chest.slide 1cm; start chest.hinge -10deg }\n";
  CHECK(starts(text, "a")[0] == 0.04);
  CHECK(starts(text, "b")[0] == 0.1);
  CHECK(starts(text, "c")[0] == 0.01);
  CHECK(starts(text, "c")[1] < -0.1);
  CHECK(in_task("start chest.slide 1cm").empty());
  CHECK(in_task("start chest.slide 30cm") == "P0304 `30cm`");
  CHECK(in_task("start chest.slide 3deg") == "P0302 `3deg`");
  CHECK(in_task("start chest.glue 3cm") == "P0201 `glue`");
  CHECK(in_task("start chset.slide 3cm") == "P0201 `chset`");
  CHECK(with_chest("task t like red_on_tray { start chest.slide 1cm }")->codes() == "P0201");
}

TEST_CASE("a variant that moves a joint differs on the axis of fixtures alone") {
  const auto a = with_chest(
      "task a like red_on_tray { scene room }\nvariant open of a { start chest.slide 19cm }\n"
      "variant same of a { start chest.slide 4cm }");
  CHECK(a->codes() == "P0702");
  CHECK(a->task("open").axes == static_cast<std::uint32_t>(plan::Axis::kFixture));
}

TEST_CASE("parts, joints and regions are measured for what they are") {
  const auto judged = [](const std::string& metric) {
    const auto a = with_chest("metrics m like plain { x = " + metric + " }");
    return a->codes();
  };
  CHECK(judged("at end travel(chest.drawer) > 4cm").empty());
  CHECK(judged("at end travel(chest.slide) > 0.5 * range(chest.slide)").empty());
  CHECK(judged("at end travel(chest.drawer) > 4deg") == "P0302");
  CHECK(judged("at end turn(chest.door) > 4deg").empty());
  CHECK(judged("max rate(chest.drawer)").empty());
  CHECK(judged("at end within(position(source), chest.inside)").empty());
  CHECK(judged("once impulse(chest.door, source) > 0Ns").empty());
  CHECK(judged("at end height(chest) > 0cm").empty());
  CHECK(judged("final height(local(position(source), chest.drawer))").empty());
  CHECK(judged("at end travel(source) > 4cm") == "P0601");
  CHECK(judged("at end within(source, chest.drawer)") == "P0601");
  CHECK(judged("at end travel(chest.lid) > 1cm") == "P0201");
  CHECK(judged("at end any p in parts: travel(p) > 0.5 * range(p)").empty());
  const std::string is_open = "predicate is_open(p: part) = travel(p) > 0.8 * range(p)\n";
  CHECK(with_chest(is_open + "metrics m like plain { x = at end is_open(chest.drawer) }")
            ->codes()
            .empty());
  CHECK(with_chest(is_open + "metrics m like plain { x = at end is_open(source) }")->codes() ==
        "P0601");
  CHECK(with_chest("predicate p(a: part) = travel(a) > 4cm\n")->codes() == "P0302");
}

TEST_CASE("a part or region has no name of a joint of the URDF, said or not") {
  CHECK(mistake("part hinge link drawer") == "P0203 `hinge`");
  CHECK(mistake("region slide of box box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1cm)") == "P0203 `slide`");
  CHECK(mistake("part glue link drawer").empty());  // what is fixed is named nowhere
  CHECK(mistake("joint slide friction 2N; joint hinge friction 1Nm").empty());
}

TEST_CASE("a part has no name of another link that can be touched, which is a part of that name") {
  CHECK(mistake("part door link drawer") == "P0203 `door`");
  CHECK(mistake("part door link drawer; part drawer link door").empty());
  CHECK(mistake("part bell link drawer").empty());  // nothing can touch that one
}

TEST_CASE("a part that follows another by mimic has no travel of its own") {
  const std::string described = odd_link("base") + odd_link("lead") + odd_link("fol") +
                                odd_link("tip") + odd_link("child") +
                                odd_joint("a", "prismatic", "base", "lead", "1 0 0", "0 0 0") +
                                odd_joint("b", "prismatic", "lead", "fol", "1 0 0", "0 0 0",
                                          "lower=\"0\" upper=\"1\"", "<mimic joint=\"a\"/>") +
                                odd_joint("g", "fixed", "fol", "tip", "1 0 0", "0 0 0") +
                                odd_joint("c", "prismatic", "tip", "child", "1 0 0", "0 0 0");
  const std::string parts =
      "part d link tip; part own link child; part first link lead; region in of d box (0cm, 0cm, "
      "0cm) .. (1cm, 1cm, 1cm)";
  const auto judged = [&](const std::string& metric) {
    return odd(described, parts,
               "metrics m like plain { x = " + metric +
                   " }\ntask t like red_on_tray { scene room; metrics m }");
  };
  const std::string follows = "`f.d` follows `f.a` and has no travel of its own: measure `f.a`";
  CHECK(judged("at end slide(f.d) > 4cm") == "P0601 `slide(f.d)` " + follows);
  CHECK(judged("at end travel(f.d) > 4cm") == "P0601 `travel(f.d)` " + follows);
  CHECK(judged("max rate(f.d)") == "P0601 `rate(f.d)` " + follows);
  CHECK(judged("at end slide(f.own) > 4cm").empty());
  CHECK(judged("at end slide(f.first) > 4cm").empty());
  CHECK(judged("at end within(source, f.in)").empty());
  CHECK(judged("once impulse(f.d, source) > 0Ns").empty());
  CHECK(judged("at end any p in parts: travel(p) > 0.5 * range(p)").empty());
  CHECK(odd(described, "part still link base",
            "metrics m like plain { x = at end travel(f.still) > 4cm }") ==
        "P0601 `travel(f.still)` nothing moves `f.still`, it has no travel");
}

TEST_CASE("a part that follows another runs into the surface where its leader takes it") {
  const std::string seesaw =
      odd_link("base") + odd_link("lead") + odd_link("fol") +
      odd_joint("a", "prismatic", "base", "lead", "0 0 1", "0 0 0", "lower=\"0\" upper=\"1\"") +
      odd_joint("b", "prismatic", "base", "fol", "0 0 1", "0.3 0 0", "lower=\"-2\" upper=\"2\"",
                "<mimic joint=\"a\" multiplier=\"-1.5\"/>");
  CHECK(odd(seesaw, "") ==
        "P1302 `f` `f.fol` runs 50cm into the surface of `room` when `f.a` stands at 100cm");
}

TEST_CASE("what stays is held against all that it carries, wherever the joints stand") {
  const auto stay = [](const std::string& described, const std::string& lines) {
    return odd(described, lines).substr(0, 5);
  };
  // 2 kg at 0.2 m from the hinge: 3.92 Nm, and the flap's own mass is at the hinge.
  const std::string flap = odd_link("base") + odd_link("flap") + odd_link("weight", "2") +
                           odd_joint("h", "revolute", "base", "flap", "0 1 0", "0 0 0.4") +
                           odd_joint("fx", "fixed", "flap", "weight", "1 0 0", "0.2 0 0");
  CHECK(stay(flap, "joint h friction 0.1Nm stay") == "P1303");
  CHECK(stay(flap, "joint h friction 3.92Nm stay") == "P1303");
  CHECK(stay(flap, "joint h friction 3.93Nm stay").empty());
  // Upright, a hinge carries nothing; along the axis there is no lever.
  const std::string door = odd_link("base") + odd_link("door", "2", "0.2 0 0") +
                           odd_joint("h", "revolute", "base", "door", "0 0 1", "0 0 0.4");
  CHECK(stay(door, "joint h friction 0.01Nm stay").empty());
  const std::string knob = odd_link("base") + odd_link("knob", "2", "0.2 0 0.01") +
                           odd_joint("h", "revolute", "base", "knob", "1 0 0", "0 0 0.4");
  CHECK(stay(knob, "joint h friction 0.19Nm stay") == "P1303");
  CHECK(stay(knob, "joint h friction 0.2Nm stay").empty());
  // A slide on an arm that turns may stand upright: 2 kg are 19.62 N. On a slide it stays level.
  const auto arm = [](const std::string& above) {
    return odd_link("base") + odd_link("arm") + odd_link("sl", "2") +
           odd_joint("t", above, "base", "arm", "0 1 0", "0 0 0.4") +
           odd_joint("s", "prismatic", "arm", "sl", "1 0 0", "0 0 0",
                     "lower=\"-0.2\" upper=\"0.3\"");
  };
  CHECK(stay(arm("revolute"), "joint s friction 1N stay") == "P1303");
  CHECK(stay(arm("revolute"), "joint s friction 19.63N stay").empty());
  CHECK(stay(arm("prismatic"), "joint s friction 0.01N stay").empty());
  // The arm's hinge carries the slide at its farthest: 2 kg at 0.3 m are 5.886 Nm.
  CHECK(stay(arm("revolute"), "joint t friction 5.88Nm stay") == "P1303");
  CHECK(stay(arm("revolute"), "joint t friction 5.89Nm stay").empty());
  // What follows a joint hangs on it as well: 1 kg and twice 2 kg are 49.05 N.
  const std::string lift =
      odd_link("base") + odd_link("lead") + odd_link("fol", "2") +
      odd_joint("a", "prismatic", "base", "lead", "0 0 1", "0 0 0", "lower=\"0\" upper=\"0.1\"") +
      odd_joint("b", "prismatic", "base", "fol", "0 0 1", "0.1 0 0", "lower=\"-2\" upper=\"2\"",
                "<mimic joint=\"a\" multiplier=\"-2\"/>");
  CHECK(stay(lift, "joint a friction 49N stay") == "P1303");
  CHECK(stay(lift, "joint a friction 49.1N stay").empty());
}

TEST_CASE("limits of a joint that no plan holds are refused with its name") {
  const auto limits = [](const std::string& written) {
    return odd(odd_link("base") + odd_link("drawer") +
                   odd_joint("j", "prismatic", "base", "drawer", "1 0 0", "0 0 0", written),
               "");
  };
  CHECK(limits("lower=\"-1000\" upper=\"1000\"").empty());
  CHECK(limits("lower=\"0\" upper=\"1001\"")
            .ends_with("joint `j` has limits of 0 and 1001, a joint's position is at most 1000 m"));
  CHECK(limits("lower=\"-1e300\" upper=\"0\"").starts_with("P0304 `\"odd/"));
}

TEST_CASE("a region of a fixture whose root link nothing can touch says so") {
  const std::string described = odd_link("base", "1", "0 0 0", false) + odd_link("lid") +
                                odd_joint("j", "revolute", "base", "lid", "0 0 1", "0 0 1");
  const std::string box = " box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1cm)";
  CHECK(odd(described, "region r of f" + box) ==
        "P1301 `f` the root link of `f` has no collision, it is no body");
  CHECK(odd(described, "part lid link lid; region r of lid" + box).empty());
}

TEST_CASE("what stands on a surface goes with its height, fixtures with joints, too") {
  const auto a = analyze_with_suite(
      std::string(test::kChest) +
      "scene low like room { surface 70cm area (-50cm, -50cm) .. (50cm, 50cm) }\n"
      "scene lower like low { surface 65cm area (-50cm, -50cm) .. (50cm, 50cm) }\n"
      "scene written like room { surface 70cm area (-50cm, -50cm) .. (50cm, 50cm); fixture chest "
      "}\n"
      "task t like red_on_tray { scene room }\n"
      "variants of t { t_low { scene low }; t_lower { scene lower }; t_written { scene written } "
      "}\n");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const auto lift = [&](const char* name) {
    return a->model.scenes[a->task(name).scene].fixtures_lift;
  };
  CHECK(lift("t") == 0);
  CHECK(lift("t_low") == doctest::Approx(-0.1));
  CHECK(lift("t_lower") == doctest::Approx(-0.15));
  CHECK(lift("t_written") == 0);
  CHECK(a->task("t_low").axes == plan::bit(plan::Axis::kSceneGeometry));
  CHECK(a->task("t_lower").axes == plan::bit(plan::Axis::kSceneGeometry));
  const auto same = with_chest(
      "scene other like room { fixture chest }\n"
      "task t like red_on_tray { scene room }\nvariant v of t { scene other }");
  CHECK(same->codes() == "P0702");
}

TEST_CASE("in a solution a joint stands for the part that it moves, as in measures") {
  const auto a = with_chest(
      "metrics pulled { success = at end travel(chest.slide) > 10cm }\n"
      "task t like red_on_tray { scene room; metrics pulled; say \"open it with {the source}, "
      "before {the target}\"; solution { open chest.slide; close chest.drawer } }");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const sema::Task& task = a->task("t");
  REQUIRE(task.solution.size() == 2);
  const sema::SkillThing by_joint = sema::find_thing(a->model, task, task.solution[0].what),
                         by_part = sema::find_thing(a->model, task, task.solution[1].what);
  CHECK(by_joint.kind == sema::SkillThing::Kind::kPart);
  CHECK(by_joint.part == by_part.part);
}
