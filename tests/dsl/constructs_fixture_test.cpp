// Fixtures with joints, regions, where joints begin. Each case begins with the productions it
// holds.
#include <doctest/doctest.h>

#include "compiler/define/fixture.h"
#include "runtime/plan/fixtures.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

TEST_CASE("fixture, fixture_st: what a text says of joints, parts and regions is in the plan") {
  const Built built(
      std::string(kChest) +
      "fixture other like chest { at (0cm, -40cm, 110cm) pitch 90deg; friction 0.3 }\n"
      "scene two like room { fixture chest, other }\n"
      "task t like red_on_tray { scene two }\n");
  const plan::Plan& plan = built.plan();
  const auto fixtures = plan.fixtures();
  REQUIRE(fixtures.size() == 2);
  CHECK(plan.text(fixtures[0].name) == "chest");
  CHECK(plan.text(fixtures[1].name) == "other");
  CHECK(fixtures[1].friction == 0.3);
  CHECK(fixtures[1].position[1] == -0.4);
  CHECK(fixtures[1].rotation[2] == doctest::Approx(std::sqrt(0.5)));
  const auto joints = plan.joints(fixtures[0]);
  REQUIRE(joints.size() == 3);
  CHECK(plan.text(joints[0].joint) == "slide");
  CHECK(joints[0].friction == 2);
  CHECK(joints[0].damping == 5);
  CHECK(joints[0].start == 0.04);
  CHECK(joints[1].stiffness == 0.5);
  CHECK(plan.armatures(fixtures[0]).empty());
  // As bodies they are called after their fixture; a part has its own name, a link the URDF's.
  std::string names;
  for (const plan::BodyRecord& body : plan.bodies(built.task("t"))) {
    if (body.kind == static_cast<std::uint32_t>(plan::BodyKind::kPart))
      names += std::string(plan.text(body.name)) + " ";
  }
  CHECK(names ==
        "chest chest.drawer chest.door chest.lid other other.drawer other.door other.lid ");
}

TEST_CASE("fixture_st: inertia in a joint itself, in the joint's own unit") {
  const std::string chest(kChest);
  const Built built(
      chest +
      "fixture heavy like chest { joint hinge friction 1Nm armature 0.2kgm2 start -1deg }\n"
      "scene two like room { fixture heavy }\ntask t like red_on_tray { scene two }\n");
  const plan::Plan& plan = built.plan();
  REQUIRE(plan.fixtures().size() == 1);
  const auto armatures = plan.armatures(plan.fixtures()[0]);
  CHECK(std::vector<double>(armatures.begin(), armatures.end()) == std::vector<double>{0, 0.2, 0});
  const auto codes = [&](const std::string& joint) {
    return analyze_with_suite(chest + "fixture o like chest { joint " + joint + " }\n" +
                              "scene two like room { fixture o }\n")
        ->codes();
  };
  CHECK(codes("hinge armature 0.2kg").find("P0302") != std::string::npos);
  CHECK(codes("slide armature -1kg").find("P0304") != std::string::npos);
}

TEST_CASE("fixture_st: a link without collision that is seen only while a joint stands so") {
  const std::string chest(kChest);
  const auto with = [&](const std::string& shown) {
    return chest + "fixture glows like chest { " + shown +
           " }\nscene two like room { fixture glows }\ntask t like red_on_tray { scene two }\n";
  };
  const Built built(with("shown light while slide >= 5cm; joint slide friction 1N start 1cm"));
  const plan::Plan& plan = built.plan();
  REQUIRE(plan.fixtures().size() == 1);
  const auto shown = plan.shown(plan.fixtures()[0]);
  REQUIRE(shown.size() == 1);
  CHECK(plan.text(shown[0].link) == "light");
  CHECK(plan.text(plan.joints(plan.fixtures()[0])[shown[0].joint].joint) == "slide");
  CHECK(shown[0].side == static_cast<std::uint32_t>(plan::ShownSide::kAbove));
  CHECK(shown[0].at == 0.05);
  // A copy may show it otherwise; what it is shown by is part of the scene.
  const Built below(with("shown light while hinge <= -10deg; joint slide friction 1N start 1cm"));
  CHECK(below.plan().shown(below.plan().fixtures()[0])[0].side ==
        static_cast<std::uint32_t>(plan::ShownSide::kBelow));
  const auto start = [](const Built& of) { return of.plan().episodes(of.task("t"))[0].start_id; };
  CHECK(start(built) != start(below));

  // Pictures that differ in it alone are another scene's.
  CHECK(analyze_with_suite(chest +
                           "fixture a like chest { shown light while slide >= 5cm }\n"
                           "fixture b like a { shown light while slide <= 5cm }\n"
                           "scene with_a like room { fixture a }\nscene with_b like room { fixture b }\n"
                           "task t like red_on_tray { scene with_a }\nvariant u of t { scene with_b }\n")
            ->codes()
            .find("P0702") == std::string::npos);
  const auto codes = [&](const std::string& said) {
    return analyze_with_suite(with(said))->codes();
  };
  CHECK(codes("shown drawer while slide >= 5cm").find("P1301") != std::string::npos);
  CHECK(codes("shown bell while slide >= 5cm").find("P1301") != std::string::npos);
  CHECK(codes("shown lamp while slide >= 5cm").find("P0201") != std::string::npos);
  CHECK(codes("shown light while glue >= 5cm").find("P0201") != std::string::npos);
  CHECK(codes("shown light while slide >= 5deg").find("P0302") != std::string::npos);
  CHECK(codes("shown light while slide > 5cm").find("P0101") != std::string::npos);
  // Always, and never.
  for (const char* at : {">= 0cm", "<= 20cm", ">= 21cm", "<= -1cm"})
    CHECK(codes(std::string("shown light while slide ") + at).find("P0304") != std::string::npos);
  CHECK(codes("shown light while ring >= 400deg").find("P0304") == std::string::npos);
  CHECK(codes("shown light while slide >= 5cm; shown light while slide <= 1cm").find("P0203") !=
        std::string::npos);
}

TEST_CASE("box: two corners, the second above the first on every axis") {
  const auto a = clean(
      "object tub like tray { region inside box (-2cm, -1cm, 0cm) .. (2cm, 1cm, 30mm); name "
      "\"tub\" "
      "}\n");
  const auto& regions = named(a->model.objects, "tub").regions;
  REQUIRE(regions.size() == 1);
  CHECK(regions[0].low[0] == -0.02);
  CHECK(regions[0].high[2] == 0.03);
  const auto flat = analyze_with_suite(
      "object tub like tray { region inside box (-2cm, -1cm, 0cm) .. (2cm, 1cm, 0cm) }\n");
  CHECK(flat->codes() == "P0304");
}

TEST_CASE("scene_st, layout_st, task_st: a joint begins where the task says, else the layout") {
  const Built built(std::string(kChest) +
                    "layout ajar like pairs { start chest.slide 10cm; start chest.hinge -45deg }\n"
                    "task t like red_on_tray { scene room }\n"
                    "task u like red_on_tray { scene room; layout ajar }\n"
                    "task v like red_on_tray { scene room; layout ajar; start chest.slide 2cm }\n");
  const auto starts = [&](const char* name) {
    const plan::TaskRecord& task = built.task(name);
    std::string text;
    for (const double at :
         plan::joint_starts_of(built.plan().tables(), built.plan().scenes()[task.scene],
                               built.plan().episodes(task)[0]))
      text += number_text(at) + " ";
    return text;
  };
  CHECK(starts("t") == "0.04 0 0 ");
  CHECK(starts("u") == "0.1 -0.785398 0 ");
  CHECK(starts("v") == "0.02 -0.785398 0 ");
}

TEST_CASE("predicate: travels of parameters are compared only where both slide or both turn") {
  const auto said = [](const char* success) {
    return failed_build(std::string(kChest) +
                        "predicate more(p: part, q: part) = travel(p) >= 0.5 * range(q)\n"
                        "predicate fuller(p: part, q: part) = travel(p) * range(q) >= 0.5 * "
                        "range(p) * range(q)\n"
                        "metrics m { success = at end " +
                        success +
                        " }\ntask t like red_on_tray { scene room; metrics m; say \"open it with "
                        "{the source}, before {the target}\" }\n");
  };
  CHECK(said("more(chest.drawer, chest.drawer)") == "");
  CHECK(said("fuller(chest.drawer, chest.door)") == "");
  CHECK(said("more(chest.drawer, chest.door)").find("error[P0601]") != std::string::npos);
}

TEST_CASE(
    "task_st, layout_st: `start none` takes copied starts away, and `none` behind a joint that "
    "one") {
  const auto a =
      test::clean(std::string(test::kChest) +
                  "layout ajar like pairs { start chest.slide 10cm; start chest.hinge -45deg }\n"
                  "layout shut like ajar { start none; start chest.hinge -30deg }\n"
                  "layout half like ajar { start chest.slide none }\n"
                  "task u like red_on_tray { scene room; layout ajar; start chest.slide 2cm }\n"
                  "task v like u { start none }\n"
                  "task w like u { layout shut; start chest.slide none }\n"
                  "task x like v { layout half; start chest.hinge -10deg; start none }\n");
  const auto begins = [&](const char* task) {
    std::string text;
    for (const double at : sema::joint_starts_of(a->model, a->task(task)))
      text += (text.empty() ? "" : " ") + test::number_text(at);
    return text;
  };
  CHECK(begins("u") == "0.02 -0.785398 0");
  CHECK(begins("v") == "0.1 -0.785398 0");
  CHECK(begins("w") == "0.04 -0.523599 0");
  CHECK(begins("x") == "0.04 -0.174533 0");
  CHECK(analyze_with_suite(std::string(test::kChest) +
                           "task t like red_on_tray { scene room; start none; start none }\n")
            ->codes() == "P0203");
  CHECK(analyze_with_suite(std::string(test::kChest) +
                           "task t like red_on_tray { scene room; start none.slide none }\n")
            ->codes() == "P0201");
}
