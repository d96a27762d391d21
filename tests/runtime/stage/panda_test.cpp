// A second robot from text alone: robosuite's Panda under osc_pose.
#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

#include "runtime/stage/robot_of.h"
#include "runtime/stage/stage.h"
#include "tests/parity/published.h"
#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/stage/solves.h"
#include "tests/runtime/world/panda.h"

namespace probe::stage {
namespace {

const plan::Plan& panda_plan() {
  static const plan::Plan plan = test::compile_suite("panda.probe");
  return plan;
}

struct Opened {
  std::shared_ptr<const SharedAssets> assets;
  std::unique_ptr<Stage> stage;
};

Opened open(const std::string& name) {
  const std::uint32_t tasks[] = {panda_plan().find_task(name).value()};
  auto assets = SharedAssets::load(panda_plan(), VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
  auto stage = Stage::create(panda_plan(), tasks[0], *assets, {{}, false});
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  return {*assets, std::move(*stage)};
}

TEST_CASE("the text's Panda is the one that the reference's records were compared with") {
  const Opened opened = open("panda_carrot_on_plate");
  const plan::RobotRecord& record = panda_plan().robots()[0];
  const UrdfParts& parts = *opened.assets->robot(record.urdf);
  const auto robot = robot_of(panda_plan(), record, parts);
  REQUIRE_MESSAGE(robot.ok(), (robot.ok() ? "" : to_text(robot.failure())));
  const auto known = world::load_panda("panda_mounted.urdf");
  REQUIRE(known.ok());
  const auto* law = std::get_if<robot::OscPose>(&robot->law);
  REQUIRE(law != nullptr);
  const robot::OscPose& wanted = (*known)->law;
  CHECK(law->kp == wanted.kp);
  CHECK(law->damping == wanted.damping);
  CHECK(law->output == wanted.output);
  CHECK(law->null_kp == wanted.null_kp);
  CHECK(law->uncouple == wanted.uncouple);
  CHECK(law->ramp == wanted.ramp);
  CHECK(law->limits == std::vector<double>{80, 80, 80, 80, 80, 12, 12});
  CHECK(law->grip.pace == wanted.grip.pace);
  CHECK(law->grip.stiffness == wanted.grip.stiffness);
  CHECK(law->grip.limit == wanted.grip.limit);
  REQUIRE(law->home.size() == wanted.home.size());
  for (std::size_t i = 0; i < 7; ++i) CHECK(std::abs(law->home[i] - wanted.home[i]) < 1e-15);
  CHECK(robot->control.arm_joints == (*known)->joints.arm_joints);
  CHECK(robot->control.finger_joints == (*known)->joints.finger_joints);

  const auto drives = drives_of(panda_plan(), record, parts.model);
  REQUIRE(drives.ok());
  const auto& joints = (*known)->spec.joints;
  REQUIRE(drives->size() == joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    CAPTURE(joints[i].joint);
    CHECK((*drives)[i].joint == joints[i].joint);
    CHECK((*drives)[i].stiffness == joints[i].stiffness);
    CHECK((*drives)[i].damping == joints[i].damping);
    CHECK((*drives)[i].limit == joints[i].limit);
    CHECK((*drives)[i].friction == joints[i].friction);
    CHECK((*drives)[i].armature == joints[i].armature);
    CHECK((*drives)[i].friction_fade == joints[i].friction_fade);
    CHECK((*drives)[i].friction_give == joints[i].friction_give);
  }
}

TEST_CASE("a Panda that is told to stay stays, with its gripper open") {
  Opened opened = open("panda_carrot_on_plate");
  Stage& stage = *opened.stage;
  REQUIRE(stage.reset(0).ok());
  const Vec3 before = stage.sample().tcp;
  for (int i = 0; i < 20; ++i) REQUIRE(stage.step({0, 0, 0, 0, 0, 0, 1}).ok());
  CHECK((stage.sample().tcp - before).norm() < 1e-3);
  CHECK(stage.sample().grip < 0.02);
}

TEST_CASE("a Panda that idles, or whose actions are late, keeps its gripper open meanwhile") {
  const plan::Plan plan = run::plan_of_text(
      "use \"suite/panda.probe\"\n"
      "task idles like panda_carrot_on_plate { idle 10 steps }\n"
      "task late like panda_carrot_on_plate { delay 10 steps }\n"
      "suite mine { tasks { idles, late }; seeds 0 }\n");
  for (const char* name : {"idles", "late"}) {
    CAPTURE(name);
    const std::uint32_t tasks[] = {plan.find_task(name).value()};
    const auto assets = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
    REQUIRE(assets.ok());
    const auto stage = Stage::create(plan, tasks[0], *assets, {{}, false});
    REQUIRE(stage.ok());
    REQUIRE((*stage)->reset(0).ok());
    const bool is_late = std::string(name) == "late";
    for (int i = 0; is_late && i < 10; ++i) REQUIRE((*stage)->step({0, 0, 0, 0, 0, 0, -1}).ok());
    CHECK((*stage)->sample().grip < 0.1);  // 0 is open
  }
}

TEST_CASE("the expert puts things where they belong with the Panda, too") {
  for (const char* task : {"panda_carrot_on_plate", "panda_spoon_on_towel", "panda_stack_cube"}) {
    CAPTURE(task);
    Opened opened = open(task);
    int solved = 0;
    const std::uint32_t starts = panda_plan().tasks()[opened.stage->task()].episodes.count;
    for (std::uint32_t start = 0; start < starts; ++start) {
      const bool success = solves(*opened.stage, panda_plan(), start);
      CHECK_MESSAGE(success, task, " start ", start);
      solved += success ? 1 : 0;
    }
    MESSAGE(std::string(task) << ": " << solved << " of " << starts);
  }
}

}  // namespace
}  // namespace probe::stage
