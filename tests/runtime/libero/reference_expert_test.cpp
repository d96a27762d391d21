// The expert in the benchmark's own starts, a start or two of tasks that ask for different holds
// and places: what solves them all is measured with `run --policy expert`.
#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runtime/compile/files.h"
#include "runtime/stage/stage.h"
#include "tests/runtime/libero/imported.h"
#include "tests/runtime/stage/solves.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

struct Asked {
  const char *suite, *task;
  const char* why;
};
constexpr Asked kAsked[] = {
    {"libero_spatial",
     "pick_up_the_black_bowl_in_the_top_drawer_of_the_wooden_cabinet_and_place_it_on_the_plate",
     "fingers are set where open ones would meet the drawer"},
    {"libero_spatial", "pick_up_the_black_bowl_next_to_the_cookie_box_and_place_it_on_the_plate",
     "a rim at the end of the arm's reach"},
    {"libero_spatial", "pick_up_the_black_bowl_on_the_stove_and_place_it_on_the_plate",
     "a long way in 220 steps"},
    {"libero_spatial", "pick_up_the_black_bowl_next_to_the_plate_and_place_it_on_the_plate",
     "a short way over a rim"},
    {"libero_object", "pick_up_the_milk_and_place_it_in_the_basket", "the middle of a basket"},
    {"libero_goal", "open_the_middle_drawer_of_the_cabinet", "a handle between two others"},
    {"libero_goal", "put_the_bowl_on_the_stove", "a plate that stands out of its region"},
    {"libero_goal", "push_the_plate_to_the_front_of_the_stove", "a thin rim, along the table"},
    {"libero_goal", "turn_on_the_stove", "a knob"},
    {"libero_10",
     "living_room_scene6_put_the_white_mug_on_the_plate_and_put_the_chocolate_pudding_to_the_right_"
     "of_the_plate",
     "two things, the second onto a part of the table"},
    {"libero_10", "kitchen_scene3_turn_on_the_stove_and_put_the_moka_pot_on_it",
     "a knob, then a pot"},
    {"libero_10", "kitchen_scene6_put_the_yellow_and_white_mug_in_the_microwave_and_close_it",
     "under a roof: by its handle, from the side, then a door that pushes it in"},
};

}  // namespace

TEST_CASE("the expert solves starts of the benchmark by the solutions that the import writes") {
  if (!test::has_reference()) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const fs::path to = test::imported_reference("solved");
  std::map<std::string, plan::Plan> plans;
  for (const Asked& asked : kAsked) {
    CAPTURE(asked.task);
    CAPTURE(asked.why);
    if (!plans.contains(asked.suite)) {
      compile::FilesRequest request;
      request.assets = to.string();
      auto made =
          compile::compile_files({(to / (std::string(asked.suite) + ".probe")).string()}, request);
      REQUIRE(made.ok());
      REQUIRE(made->ok);
      auto opened = plan::Plan::from_bytes(std::move(made->plan));
      REQUIRE(opened.ok());
      plans.emplace(asked.suite, std::move(opened).value());
    }
    const plan::Plan& plan = plans.at(asked.suite);
    const auto task = plan.find_task(asked.task);
    REQUIRE(task.has_value());
    const std::uint32_t tasks[] = {*task};
    const auto assets = stage::SharedAssets::load(plan, to.string(), tasks);
    REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
    const auto stage = stage::Stage::create(plan, *task, *assets, {{}, false});
    REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
    CHECK(stage::solves(**stage, plan, 1));
  }
  fs::remove_all(to);
}

}  // namespace probe::libero
