#include "runtime/inspect/task_json.h"

#include "tests/runtime/inspect/small_plan.h"

using namespace probe;
using namespace probe::inspect;

TEST_CASE("the list of a suite has its members with the promised keys") {
  const plan::Plan& plan = test::small_plan();
  const Json tasks = list(plan, members(plan, *plan.find_suite("few")));
  CHECK(
      tasks.dump() ==
      R"([{"task":"base","baseline":null,"axes":[],"categories":[],"prompt":"put carrot on plate","episodes":24},)"
      R"({"task":"worded","baseline":"base","axes":["language.action"],"categories":[],)"
      R"("prompt":"pick up the carrot and drop it off on the plate","episodes":24}])");
  CHECK(count(plan, all_tasks(plan)).dump() == R"({"tasks":8,"episodes":192})");
}

TEST_CASE("a task's categories are the sets it is in") {
  const Json dim = describe(test::small_plan(), test::task("dim"));
  CHECK(dim["categories"].dump() == R"(["looks"])");
}

TEST_CASE("a described task has roles, starts, distances and ids") {
  const Json task = describe(test::small_plan(), test::task("both"));
  CHECK(task["source"] == "carrot");
  CHECK(task["distractors"].dump() == R"(["twig"])");
  CHECK(task["allow"] == "published \"so\"");
  CHECK(task["scene"] == "table");
  CHECK(task["camera"] == "third_view");
  CHECK(task["light"] == "studio");
  REQUIRE(task["starts"].size() == 24);
  REQUIRE(task["starts"][0].size() == 3);
  CHECK(
      task["starts"][1][0].dump() ==
      R"({"object":"carrot","x_m":-0.235,"y_m":-0.075,"roll_deg":0.0,"pitch_deg":0.0,"yaw_deg":-90.0})");
  CHECK(task["distances_m"][0].get<double>() == doctest::Approx(0.15));
  CHECK(task["ids"]["starts"].size() == 24);
  CHECK(task["ids"]["episodes"][23].get<std::string>().size() == 64);
}

TEST_CASE("people read centimetres and short ids") {
  const std::string text = describe_text(describe(test::small_plan(), test::task("both")));
  CHECK(text.find("layout       24 starts, dropped from 50 cm, settled for 0.5 s\n") !=
        std::string::npos);
  CHECK(text.find("allowed      published \"so\"\n") != std::string::npos);
  CHECK(text.find("start  start id  apart  carrot               plate") != std::string::npos);
  CHECK(text.find("-23.5, -7.5 yaw 180  -23.5, 7.5") != std::string::npos);
  CHECK(text.find("unseen       nothing\n") != std::string::npos);
}

TEST_CASE("long instructions go on below themselves") {
  const Json list = {{{"task", "a_task_with_a_long_name_of_forty_letters_xx"},
                      {"episodes", 24},
                      {"prompt",
                       "pick up the object that one needs the most when they are thirsty "
                       "and drop it off on the plate"}}};
  CHECK(list_text(list) ==
        "a_task_with_a_long_name_of_forty_letters_xx    24  pick up the object that one needs the "
        "most when\n"
        "                                                   they are thirsty and drop it off on "
        "the plate\n");
}
