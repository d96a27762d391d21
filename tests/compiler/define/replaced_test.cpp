// Scenes that tasks change, and copies of robots and fixtures that stand in the place of the first.
#include "compiler/define/replaced.h"

#include <doctest/doctest.h>

#include "runtime/plan/axes.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::unique_ptr<test::Analysis> with_chest(const std::string& more) {
  return analyze_with_suite(std::string(test::kChest) + more);
}
bool moves_only(const sema::Task& task, plan::Axis axis) {
  return task.axes == static_cast<std::uint32_t>(axis);
}

}  // namespace

TEST_CASE("a task changes its scene, and the same change of the same scene is one scene") {
  const auto a = analyze_with_suite(
      "scene other like bench { light night }\n"
      "variants of red_on_tray {\n  faster { scene { physics 1000Hz friction 1 } }\n"
      "  there { scene other { robot at (45cm, 0cm) yaw 180deg } }\n}\n"
      "task blue_on_tray like base { source blue; target tray }\n"
      "derive \"{t}_low\" for t in { red_on_tray, blue_on_tray } {\n"
      "  scene { surface 79cm area (-50cm, -50cm) .. (50cm, 50cm) }\n}\n"
      "set low = tasks where axis scene.geometry and scene bench");
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  const auto scene = [&](const char* task) -> const sema::Scene& {
    return a->model.scenes[a->task(task).scene];
  };
  CHECK(scene("red_on_tray").physics_hz == 500);
  CHECK(scene("faster").physics_hz == 1000);
  CHECK(scene("faster").name == "bench");
  CHECK(moves_only(a->task("faster"), plan::Axis::kScene));
  CHECK(scene("there").name == "other");
  CHECK(scene("there").base_position[0] == 0.45);
  CHECK(scene("there").robot == scene("red_on_tray").robot);
  CHECK(a->task("red_on_tray_low").scene == a->task("blue_on_tray_low").scene);
  CHECK(a->task("red_on_tray_low").scene != a->task("red_on_tray").scene);
  CHECK(moves_only(a->task("red_on_tray_low"), plan::Axis::kSceneGeometry));
  CHECK(a->model.sets.begin()->members.size() == 2);
}

TEST_CASE("mistakes in what a task changes are said there, once") {
  const auto said = [](const std::string& body) {
    const auto a = analyze_with_suite("variant v of red_on_tray { " + body + " }");
    return a->codes() + " `" + std::string(a->underlined()) + "`";
  };
  CHECK(said("scene { light nigth }") == "P0201 `nigth`");
  CHECK(said("scene bensh { light night }") == "P0201 `bensh`");
  CHECK(said("scene { physics 7Hz friction 1 }") == "P0304 `7Hz`");
  CHECK(said("scene { light day; light night }") == "P0203 `light night`");
  CHECK(said("scene { robot at (45cm) yaw 180deg }") == "P0302 `(45cm)`");
  CHECK(said("scene { }") == "P0702 `v`");
  CHECK(analyze_with_suite("abstract task t { scene { light night } }")->codes() == "P0206");
  CHECK(analyze_with_suite("scene s { robot arm }")->codes().starts_with("P0206"));
}

TEST_CASE("a camera that is mounted on a robot sees from its copies, and from no other robot") {
  const auto a = analyze_with_suite(
      "robot soft like arm { grip 1cm .. 4cm friction 1 patch 1cm }\n"
      "derive \"{t}_{r}\" for t in { red_on_tray }, r in robots (arm, soft) { scene { robot r } }");
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  CHECK(a->task("red_on_tray_soft").complete);
  CHECK_FALSE(a->task("red_on_tray_arm").complete);  // it has that one already
  const auto other = analyze_with_suite(
      "robot twin {\n  urdf \"arm/arm.urdf\"; tcp tool; fingers left opens +y, right opens -y\n"
      "  control ee_delta_pose 5Hz\n  drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm\n"
      "  drive l, r stiffness 1000N/m damping 200Ns/m limit 60N; grip 1cm .. 4cm friction 2\n}\n"
      "variant v of red_on_tray { scene { robot twin } }");
  CHECK_MESSAGE(other->codes() == "P0201", other->said());
}

TEST_CASE("a copy of a fixture takes over what is said of the first, and the same drawer is no other") {
  const auto a = with_chest(
      "fixture stiff like chest { joint slide friction 4N }\n"
      "metrics opened { success = at end slide(target) > 4cm }\n"
      "layout alone { drop none }\n"
      "task open_it {\n  scene room; layout alone; metrics opened; horizon 60 steps; target chest.drawer\n"
      "  start chest.slide 1cm; say \"open {the target}\"; solution { open chest.drawer }\n}\n"
      "derive \"{t}_{f}\" for t in { open_it }, f in fixtures (chest, stiff) { scene { fixture f } }\n");
  REQUIRE_MESSAGE(a->codes().empty(), a->said());
  const sema::Task& stiff = a->task("open_it_stiff");
  REQUIRE(stiff.complete);
  CHECK(a->model.objects[stiff.target].name == "stiff.drawer");
  CHECK(stiff.solution[0].what.owner.text == "stiff");
  REQUIRE(stiff.joint_starts.size() == 1);
  CHECK(a->model.fixtures[stiff.joint_starts[0].fixture].name == "stiff");
  CHECK(moves_only(stiff, plan::Axis::kScene));
}

TEST_CASE("of two copies none stands for the first, and what is no copy never does") {
  CHECK(with_chest("fixture left like chest { at (0cm, 40cm, 85cm) }\n"
                   "fixture right like chest { at (0cm, -40cm, 85cm) }\n"
                   "task t like red_on_tray { scene room { fixture left, right }; start chest.slide 1cm }")
            ->codes() == "P0201");
  CHECK(with_chest("fixture alien { urdf \"chest/chest.urdf\"; at (0cm, 40cm, 85cm) }\n"
                   "task t like red_on_tray { scene room { fixture alien }; start chest.slide 1cm }")
            ->codes() == "P0201");
}
