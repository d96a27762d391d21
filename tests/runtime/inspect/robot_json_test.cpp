// What `show`, `diff` and `dis` say of a robot whose law has numbers of its own.
#include "runtime/inspect/robot_json.h"

#include <doctest/doctest.h>

#include "runtime/inspect/task_diff.h"
#include "runtime/inspect/task_json.h"
#include "runtime/plan/dis.h"
#include "tests/parity/published.h"
#include "tests/runtime/inspect/small_plan.h"
#include "tests/runtime/run/plan_of_text.h"

using namespace probe;
using namespace probe::inspect;

namespace {

const plan::Plan& pandas() {
  static const plan::Plan plan = test::compile_suite("panda.probe");
  return plan;
}

}  // namespace

TEST_CASE("a robot is shown with its law's numbers, gears and air") {
  const std::uint32_t task = *pandas().find_task("panda_carrot_on_plate");
  const Json robot = describe(pandas(), task)["robot"];
  CHECK(robot["control"] == "osc_pose");
  CHECK(robot["hz"].get<double>() == 20);
  CHECK(robot["drives"].size() == 9);
  CHECK(robot["fingers"].dump() == R"(["left_finger","right_finger"])");
  CHECK(robot["law"]["kp"].dump() == "[150.0,150.0,150.0,150.0,150.0,150.0]");
  CHECK(robot["law"]["home"].size() == 7);
  CHECK(robot["gears"]["joint2"]["armature"].get<double>() == 2.5);
  CHECK(robot["air"]["density"].get<double>() == 1.2);
  const std::string text = describe_text(describe(pandas(), task));
  CHECK(text.find("robot        panda, osc_pose at 20 Hz, in air of 1.2 kg/m3 and 2e-05 Pa s\n") !=
        std::string::npos);
  CHECK(text.find("law          kp 150, damping 1, output (0.05, 0.5) m and rad, null 10, "
                  "uncoupled, ramp 0, home (") != std::string::npos);
}

TEST_CASE("a robot that is told its joints says from where its steps go") {
  const plan::Plan plan =
      run::plan_of_file(VLAPROBE_SOURCE_DIR "/examples/joint_arm.probe", "joint_arm");
  const auto robot = [&](const char* task) {
    return describe(plan, *plan.find_task(task))["robot"];
  };
  const Json told = robot("told_carrot_on_plate"), stepped = robot("stepped_carrot_on_plate");
  CHECK(robot_text(told) == "told_panda, joint_position at 5 Hz");
  CHECK_FALSE(told.contains("law"));
  CHECK(robot_text(stepped) == "stepped_panda, joint_delta at 5 Hz");
  CHECK(law_text(stepped) == "steps from the last target, at most 0.3 rad or m");
  const std::string text = plan::disassemble(plan);
  CHECK(text.find(" told_panda: control 4 at 5 Hz\n") != std::string::npos);
  CHECK(text.find(" stepped_panda: control 3 at 5 Hz\n  steps from the last target, most 0.3\n") !=
        std::string::npos);
}

TEST_CASE("a robot without numbers of its own has its name, law and rate") {
  const Json task = describe(test::small_plan(), test::task("base"));
  CHECK(robot_text(task["robot"]) == "widowx, ee_delta_pose at 5 Hz");
  CHECK(law_text(task["robot"]).empty());
  CHECK_FALSE(task["robot"].contains("gears"));
  CHECK(describe_text(task).find("robot        widowx, ee_delta_pose at 5 Hz\n") !=
        std::string::npos);
  const std::string diff = diff_text(diff_tasks(test::small_plan(), 0, 1));
  CHECK(diff.find("  robot         widowx, ee_delta_pose at 5 Hz") != std::string::npos);
}

TEST_CASE("a plan as text has the robots that say more than others") {
  const std::string text = plan::disassemble(pandas());
  CHECK(text.find("\nrobot 0 panda: control 2 at 20 Hz\n  kp 150 150") != std::string::npos);
  CHECK(text.find("  joint2: friction 0.1, armature 2.5\n") != std::string::npos);
  CHECK(plan::disassemble(test::small_plan()).find("\nrobot") == std::string::npos);
}
