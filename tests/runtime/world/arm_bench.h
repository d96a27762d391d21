// The WidowX over its table with objects, and the moves that tests make with it.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/trig.h"
#include "runtime/robot/ik.h"
#include "runtime/robot/kinematics.h"
#include "tests/runtime/world/widowx.h"

namespace probe::world {

inline constexpr double kTable = 0.87;
inline constexpr const char* kTool = "ee_gripper_link";

struct Bench {
  std::unique_ptr<WidowX> robot;
  std::unique_ptr<World> world;
  std::unique_ptr<robot::Chain> chain;
  std::array<double, 8> target{};

  void run(int substeps) {
    const Status status = world->step(substeps);
    REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
  }
  // Arm positions that put the tool at a place in the world, pointing down.
  std::array<double, 8> reach(const Vec3& place, double yaw = 0) {
    const Pose base = robot->spec.base;
    Mat3 down;
    down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    const SinCos s = portable_sincos(yaw);
    Mat3 turn;
    turn << s.cos, -s.sin, 0, s.sin, s.cos, 0, 0, 0, 1;
    const Pose goal{base.inverse().apply(place), Quat(Mat3(turn * down))};
    std::array<double, 8> q = target;
    const robot::IkResult found = robot::solve_ik(*chain, goal, std::span(q).first(6));
    REQUIRE(found.converged);
    return q;
  }
  void go(const std::array<double, 8>& q) {
    target = q;
    world->set_targets(target);
  }
  // Straight line of the tool in steps of 0.2 s, then settling.
  void move(const Vec3& from, const Vec3& to, int steps) {
    for (int i = 1; i <= steps; ++i) {
      std::array<double, 8> q = reach(from + (to - from) * i / steps);
      q[6] = target[6];
      q[7] = target[7];
      go(q);
      run(100);
    }
  }
  void grip(double opening) {
    target[6] = target[7] = opening;
    world->set_targets(target);
  }
  Pose in_gripper(std::size_t body) const {
    return world->frame_pose("gripper_link").inverse() * world->body(body).pose;
  }
};

inline WorldSpec table_spec(const ArticulationSpec& arm) {
  WorldSpec spec;
  spec.articulations = {arm};
  spec.surface_z = kTable;
  spec.sleeping = false;
  return spec;
}

inline std::shared_ptr<const scene::CollisionShape> small_cube() {
  return std::make_shared<scene::CollisionShape>(scene::make_box_shape({0.015, 0.015, 0.015}));
}

inline std::shared_ptr<const scene::CollisionShape> object(const std::string& name) {
  auto shape = scene::load_collision_obj(
      std::string(VLAPROBE_SOURCE_DIR) + "/assets/objects/" + name + "/collision.obj",
      Vec3(1, 1, 1));
  REQUIRE_MESSAGE(shape.ok(), (shape.ok() ? "" : to_text(shape.failure())));
  return std::make_shared<scene::CollisionShape>(std::move(shape).value());
}

inline bool make_bench(Bench* bench, const std::vector<BodySpec>& bodies, bool sleeping = false,
                       double dt = 0.002, const std::vector<ArticulationSpec>& others = {}) {
  auto robot = load_widowx();
  if (!robot.ok()) {
    MESSAGE("skipped: ", to_text(robot.failure()));
    return false;
  }
  bench->robot = std::move(robot).value();
  WorldSpec spec = table_spec(bench->robot->spec);
  spec.articulations.insert(spec.articulations.end(), others.begin(), others.end());
  spec.bodies = bodies;
  spec.sleeping = sleeping;
  spec.dt = dt;
  auto world = World::create(spec);
  REQUIRE_MESSAGE(world.ok(), (world.ok() ? "" : to_text(world.failure())));
  bench->world = std::move(world).value();
  std::vector<std::string> names;
  for (int i = 0; i < 6; ++i)
    names.push_back(bench->robot->spec.joints[static_cast<std::size_t>(i)].joint);
  auto chain = robot::Chain::create(bench->robot->model, kTool, names);
  REQUIRE(chain.ok());
  bench->chain = std::make_unique<robot::Chain>(std::move(chain).value());
  std::copy(spec.articulations[0].positions.begin(), spec.articulations[0].positions.end(),
            bench->target.begin());
  return true;
}

inline BodySpec lying(const char* name, std::shared_ptr<const scene::CollisionShape> shape,
                      double mass, const Vec3& center) {
  BodySpec body;
  body.name = name;
  body.density = mass / shape->volume;
  body.pose.position = center - shape->center_of_mass;
  body.shape = std::move(shape);
  return body;
}

inline constexpr double kOpen = 0.037;  // m, the fingers' upper limit

inline const Vec3 kSpot(-0.15, 0.0, kTable + 0.015);

// Puts the open gripper around the spot and closes.
inline void close_on(Bench* bench, const Vec3& spot) {
  std::array<double, 8> q = bench->reach(spot);
  q[6] = q[7] = kOpen;
  const auto all = bench->world->joints();
  std::vector<double> placed(all.begin(), all.end());
  std::copy(q.begin(), q.end(), placed.begin());
  bench->world->set_joints(placed);
  bench->target = q;
  bench->grip(0.014);
  bench->run(200);
}

}  // namespace probe::world
