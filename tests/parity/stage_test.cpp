// Robot, drives, cameras and scenes against the numbers of the published setup.
#include <doctest/doctest.h>

#include "tests/parity/published.h"

using namespace probe;

namespace {

const plan::SceneRecord& scene(const plan::Plan& plan, std::string_view name) {
  for (const plan::SceneRecord& record : plan.scenes()) {
    if (plan.text(record.name) == name) return record;
  }
  FAIL("no such scene");
  return plan.scenes()[0];
}

const plan::CameraRecord& camera(const plan::Plan& plan, std::string_view name) {
  for (const plan::CameraRecord& record : plan.cameras()) {
    if (plan.text(record.name) == name) return record;
  }
  FAIL("no such camera");
  return plan.cameras()[0];
}

std::vector<double> joints(const plan::Plan& plan, const plan::SceneRecord& scene) {
  const auto values = plan::slice_of(plan.tables().reals, scene.joints);
  return {values.begin(), values.end()};
}

}  // namespace

TEST_CASE("the table scene has the numbers of the published setup") {
  const plan::Plan& plan = test::suite_plan();
  const plan::SceneRecord& table = scene(plan, "table");
  CHECK(table.base_position == std::array<double, 3>{0.147, 0.028, 0.87});
  CHECK(table.base_rotation == std::array<double, 4>{0, 0, 0, 1});
  CHECK(table.surface_z == 0.87);
  CHECK(table.physics_hz == 500);
  CHECK(table.friction == 1);
  CHECK(joints(plan, table) == std::vector<double>{-0.01840777, 0.0398835, 0.22242722, -0.00460194,
                                                   1.36524296, 0.00153398, 0.037, 0.037});
  const plan::RobotRecord& robot = plan.robots()[0];
  CHECK(robot.control_hz == 5);
  CHECK(robot.grip_closed == 0.014);
  CHECK(robot.grip_open == 0.038);
  CHECK(robot.finger_friction == 2);
  CHECK(robot.link_friction == 1);
  CHECK(robot.finger_patch == 0.01);
  const auto drives = plan::slice_of(plan.tables().drives, robot.drives);
  REQUIRE(drives.size() == 8);
  CHECK(drives[0].stiffness == 1169.789);
  CHECK(drives[2].damping == 152.12);
  CHECK(drives[7].limit == 60);
  const plan::CameraRecord& view = camera(plan, "third_view");
  CHECK(view.position == std::array<double, 3>{0, -0.16, 0.36});
  CHECK(view.aim_values == std::array<double, 4>{1, 0.553, -1.085, 0});
  CHECK(view.fx == 623.588);
  CHECK(view.cy == 239.545);
  CHECK(plan.objects()[0].friction == 0.5);
}

TEST_CASE("the sink scene has the numbers of the published setup") {
  const plan::Plan& plan = test::suite_plan();
  const plan::SceneRecord& sink = scene(plan, "sink");
  CHECK(sink.base_position == std::array<double, 3>{0.127, 0.06, 0.85});
  CHECK(sink.base_rotation == std::array<double, 4>{0, 0, 0, 1});
  CHECK(sink.fixture_position == std::array<double, 3>{-0.16, 0.13, 0.88});
  CHECK(joints(plan, sink) == std::vector<double>{-0.2600599, -0.12875618, 0.04461369, -0.00652761,
                                                  1.7033415, -0.26983038, 0.037, 0.037});
  const plan::CameraRecord& view = camera(plan, "sink_view");
  CHECK(view.position == std::array<double, 3>{-0.003, -0.21, 0.39});
  const double published[] = {-0.907313, 0.0782, -0.36434,
                              -0.194741};  // six digits: not quite unit
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(view.aim_values[i] - published[i]) < 1e-6);
}
