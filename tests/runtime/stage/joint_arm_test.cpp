// Robots that are told their joints, from the example's text: the expert works with them, late
// actions wait in their own number, and what is said in another is refused.
#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "runtime/policy/scripted.h"
#include "runtime/stage/stage.h"
#include "runtime/stage/stage_state.h"
#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/stage/solves.h"

namespace probe::stage {
namespace {

const plan::Plan& example() {
  static const plan::Plan plan =
      run::plan_of_file(VLAPROBE_SOURCE_DIR "/examples/joint_arm.probe", "joint_arm");
  return plan;
}

std::unique_ptr<Stage> open(const plan::Plan& plan, const std::string& name) {
  const std::uint32_t tasks[] = {plan.find_task(name).value()};
  const auto assets = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
  auto stage = Stage::create(plan, tasks[0], *assets, {{}, false});
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  return std::move(*stage);
}

void need(const Status& status) {
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
}

TEST_CASE("the expert puts things where they belong by positions and by steps of joints") {
  for (const char* task : {"told_carrot_on_plate", "stepped_carrot_on_plate"}) {
    CAPTURE(task);
    const auto stage = open(example(), task);
    CHECK(stage->action_space().size() == 8);
    const std::uint32_t starts = example().tasks()[stage->task()].episodes.count;
    REQUIRE(starts == 24);
    int solved = 0;
    for (std::uint32_t start = 0; start < starts; start += 4)
      solved += solves(*stage, example(), start) ? 1 : 0;
    CHECK(solved == 6);
  }
}

TEST_CASE("at twenty steps a second soft drives and steps of joints get time to follow, too") {
  const plan::Plan plan = run::plan_of_text(R"(use "suite/panda.probe"
robot soft like panda { control joint_position 20Hz
  drive joint1, joint2, joint3, joint4 stiffness 800Nm/rad damping 100Nms/rad limit 87Nm
  drive joint5, joint6, joint7 stiffness 400Nm/rad damping 40Nms/rad limit 12Nm
  drive finger_joint1, finger_joint2 stiffness 1000N/m damping 100Ns/m limit 20N
  grip 0cm .. 4cm friction 2 patch 1cm }
robot stepped like soft { control joint_delta 20Hz { from target; most 0.1rad }
  drive joint1, joint2, joint3, joint4, joint5, joint6, joint7 stiffness 4000Nm/rad damping 400Nms/rad limit 200Nm }
robot measured like soft { control joint_delta 20Hz { from measured; most 0.1rad } }
scene a like panda_table { robot soft; physics 500Hz friction 1 }
scene b like panda_table { robot stepped; physics 500Hz friction 1 }
scene c like panda_table { robot measured; physics 500Hz friction 1 }
task told like panda_carrot_on_plate { scene a }
task added like panda_carrot_on_plate { scene b }
task from_it like panda_carrot_on_plate { scene c }
suite mine { tasks { told, added, from_it }; seeds 0 }
)");
  for (const char* task : {"told", "added", "from_it"}) {
    CAPTURE(task);
    const auto stage = open(plan, task);
    for (const std::uint32_t start : {0, 1, 6, 11}) {
      CAPTURE(start);
      CHECK(solves(*stage, plan, start));
    }
  }
}

TEST_CASE("an action of another number than the law's is refused by name") {
  const auto stage = open(example(), "told_carrot_on_plate");
  need(stage->reset(0));
  const Status told = stage->step({0, 0, 0, 0, 0, 0, 1});
  REQUIRE_FALSE(told.ok());
  CHECK(told.failure().code == Fault::kPolicy);
  CHECK(told.failure().message == "an action of 7 numbers, `joint_position` wants 8");
}

TEST_CASE("null stays where it is, and random goes about that place") {
  for (const char* task : {"told_carrot_on_plate", "stepped_carrot_on_plate"}) {
    CAPTURE(task);
    const auto stage = open(example(), task);
    need(stage->reset(0));
    const std::vector<double> before(stage->q().begin(), stage->q().end());
    const auto null = policy::make_null(), random = policy::make_random();
    policy::EpisodeStart start = stage->introduction();
    start.draw_seed = 7;
    need(null->begin(start));
    need(random->begin(start));
    for (int i = 0; i < 5; ++i) {
      const auto seen = stage->observe();
      REQUIRE(seen.ok());
      const auto action = null->act(*seen);
      REQUIRE(action.ok());
      REQUIRE(action->size() == 8);
      CHECK(action->gripper() == 1);
      const bool are_positions = std::string(task).starts_with("told");
      for (std::size_t k = 0; k < 7; ++k) CHECK((*action)[k] == (are_positions ? before[k] : 0));
      const auto drawn = random->act(*seen);
      REQUIRE(drawn.ok());
      REQUIRE(drawn->size() == 8);
      for (std::size_t k = 0; k < 7; ++k) {
        const double from = are_positions ? seen->proprioception.joints[k] : 0;
        CHECK(std::abs((*drawn)[k] - from) <= 0.1);
        CHECK((*drawn)[k] != from);
      }
      need(stage->step(*action));
    }
    for (std::size_t k = 0; k < 7; ++k) CHECK(std::abs(stage->q()[k] - before[k]) < 2e-3);
  }
}

TEST_CASE("late actions of joints wait in their number, also in a saved stage") {
  const plan::Plan plan = run::plan_of_text(
      "use \"examples/joint_arm.probe\"\n"
      "variant late of told_carrot_on_plate { delay 400ms }\n"
      "suite mine { tasks { told_carrot_on_plate, late }; seeds 0 }\n");
  const auto stage = open(plan, "late");
  need(stage->reset(0));
  policy::Action there =
      policy::Action(std::span<const double>(stage->q()).first(8));  // seven joints and a place
  there[0] += 0.2;
  there.gripper() = 1;
  const double before = stage->q()[0];
  need(stage->step(there));
  need(stage->step(there));
  CHECK(std::abs(stage->q()[0] - before) < 2e-3);  // it was told to stay
  const std::vector<std::byte> bytes = stage->save().to_bytes();
  CHECK(bytes[8] == std::byte{3});
  const auto state = StageState::from_bytes(bytes);
  REQUIRE_MESSAGE(state.ok(), to_text(state.failure()));
  const auto other = open(plan, "late");
  need(other->restore(*state));
  for (Stage* one : {stage.get(), other.get()}) {
    for (int i = 0; i < 4; ++i) need(one->step(there));
    CHECK(one->q()[0] > before + 0.15);
  }
  CHECK(stage->state_hash() == other->state_hash());
}

}  // namespace
}  // namespace probe::stage
