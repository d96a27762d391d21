#include "runtime/inspect/plan_diff.h"
#include "runtime/inspect/task_diff.h"
#include "tests/runtime/inspect/small_plan.h"

using namespace probe;
using namespace probe::inspect;

TEST_CASE("a reworded task has the same starts and the same judge") {
  const auto diff = diff_tasks(test::small_plan(), test::task("base"), test::task("colored"));
  CHECK(diff["baseline"] == "a");
  CHECK(diff["axes"].dump() == R"(["language.appearance"])");
  CHECK(diff["equal"].dump() ==
        R"({"starts":24,"episodes":0,"of":24,"prompt":false,"judge":true,"program":true})");
  CHECK(diff_text(diff) ==
        R"(                base                                       colored
* prompt        put [carrot] on [plate]                    put [the orange object] on [the yellow
                                                           object]
  source        carrot                                     carrot
  target        plate                                      plate
  distractors   none                                       none
* baseline      none                                       base
  scene         table                                      table
  robot         widowx, ee_delta_pose at 5 Hz              widowx, ee_delta_pose at 5 Hz
  camera        third_view                                 third_view
  light         studio                                     studio
  horizon       60                                         60
  metrics       success, intention, grasp, steady, moved,  success, intention, grasp, steady, moved,
                wrong                                      wrong
  judge's ops   83                                         83
  episodes      24                                         24

axes       language.appearance
declared   colored is a variant of base: language.appearance
start id   24 of 24 equal
prompt id  differs
judge id   equal; program equal
episode id 0 of 24 equal
)");
}

TEST_CASE("a later sentence that differs is among the words that differ") {
  const plan::Plan plan = test::compile_small(
      "\nvariant in_turn of base { then say drop_on when step >= 9 }\n"
      "suite more { tasks { base, in_turn }; seeds 1 }\n");
  const auto index = [&](std::string_view name) { return plan.find_task(name).value(); };
  const auto diff = diff_tasks(plan, index("base"), index("in_turn"));
  CHECK(diff["right"]["prompt"] == "put carrot on plate");
  const std::string text = diff_text(diff);
  const auto prompt = text.find("\n* prompt");
  REQUIRE(prompt != std::string::npos);
  CHECK(text.find("then: ", prompt) < text.find("\n  source", prompt));
}

TEST_CASE("a distractor changes the starts but not what is meant by the judgement") {
  const auto diff = diff_tasks(test::small_plan(), test::task("crowded"), test::task("base"));
  CHECK(diff["baseline"] == "b");
  CHECK(diff["axes"].dump() == R"(["distractors"])");
  CHECK(diff["equal"]["starts"] == 0);
  CHECK(diff["equal"]["prompt"] == true);
  CHECK(diff["right"]["distractors"].empty());
}

TEST_CASE("another height of the surface is the axis that the compiler says, and both are told") {
  const plan::Plan lower = test::compile_small(
      "\nscene low like table { surface 85cm area (-34cm, -20cm) .. (4cm, 20cm) }\n"
      "variant lowered of base { scene low }\nsuite more { tasks { lowered }; seeds 1 }\n");
  const auto index = [&](std::string_view name) {
    for (std::uint32_t t = 0; t < lower.tasks().size(); ++t)
      if (lower.text(lower.tasks()[t].name) == name) return t;
    return plan::kNone;
  };
  REQUIRE(index("lowered") != plan::kNone);
  const auto diff = diff_tasks(lower, index("base"), index("lowered"));
  CHECK(diff["axes"] == diff["declared_axes"]);
  CHECK(diff["axes"].dump() == R"(["scene.geometry"])");
  CHECK(diff["left"]["surface"] == "87 cm");
  CHECK(diff["right"]["surface"] == "85 cm");
  CHECK(diff_text(diff).find("\n* surface       87 cm") != std::string::npos);
}

TEST_CASE("two plans: what is only in one, and which identities changed") {
  const plan::Plan& before = test::small_plan();
  const plan::Plan after = test::compile_small(
      "\nvariant new_one of base { horizon 70 steps }\nsuite more { tasks { new_one }; seeds 1 }\n",
      "longer  { horizon 90 steps }", "longer  { horizon 91 steps }");
  const auto diff = diff_plans(before, after);
  CHECK(plan_diff_text(diff) ==
        "+ new_one\n"
        "* longer: judge; 24 of 24 episodes are others\n"
        "0 only in the first, 1 only in the second, 1 changed, 7 equal\n");
  CHECK(
      diff["changed"][0].dump() ==
      R"({"task":"longer","prompt":true,"judge":false,"starts":24,"episodes":0,"of_a":24,"of_b":24})");
  CHECK(plan_diff_text(diff_plans(after, before)).substr(0, 10) == "- new_one\n");
}

TEST_CASE("a plan equals itself") {
  const auto diff = diff_plans(test::small_plan(), test::small_plan());
  CHECK(diff["a"] == diff["b"]);
  CHECK(diff["equal"] == 8);
  CHECK(diff["changed"].empty());
}

TEST_CASE("what a task changes of a scene in place is told, though the scene's name stays") {
  const plan::Plan plan = test::compile_small(
      "\nvariant aside of base { scene { robot at (20cm, 5cm, 87cm) yaw 180deg; "
      "physics 400Hz friction 1 } }\n"
      "suite more { tasks { base, aside }; seeds 1 }\n");
  const auto index = [&](std::string_view name) { return plan.find_task(name).value(); };
  const auto diff = diff_tasks(plan, index("base"), index("aside"));
  CHECK(diff["left"]["scene"] == diff["right"]["scene"]);
  CHECK(diff["right"]["base"] == "at (20, 5, 87) cm, yaw 180 deg");
  CHECK(diff["right"]["physics"] == "400 Hz, friction 1");
  CHECK_FALSE(diff["right"].contains("backdrop"));
  CHECK(diff_text(diff).find("\n* base  ") != std::string::npos);
  const Json shown = describe(plan, index("aside"));
  CHECK(shown["scene_here"]["base"] == "at (20, 5, 87) cm, yaw 180 deg");
  CHECK(describe_text(shown).find("base at (20, 5, 87) cm, yaw 180 deg") != std::string::npos);
}

TEST_CASE("a turn that is written otherwise is the same turn") {
  const plan::Plan plan = test::compile_small(
      "\nvariant round of base { scene { robot at (14.7cm, 2.8cm, 87cm) yaw -180deg; "
      "surface 87cm area (-40cm, -30cm) .. (5cm, 30cm) } }\n"
      "suite more { tasks { base, round }; seeds 1 }\n");
  const auto index = [&](std::string_view name) { return plan.find_task(name).value(); };
  const auto diff = diff_tasks(plan, index("base"), index("round"));
  CHECK(diff["right"]["area"] == "(-40, -30) cm .. (5, 30) cm");
  CHECK_FALSE(diff["right"].contains("base"));
  CHECK_FALSE(diff["right"].contains("stands"));
}
