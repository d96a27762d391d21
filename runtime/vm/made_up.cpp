#include "runtime/vm/made_up.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/roles.h"
#include "runtime/vm/judge.h"

namespace probe::vm {
namespace {

constexpr int kSteps = 8;
constexpr double kFar = 0.5;  // m: where objects stand that do not matter

// Half extents with z the axis that is nearest the vertical in the pose, as a world gives them.
Vec3 half_extents(const plan::ObjectRecord& object, const std::array<double, 4>& rotation) {
  std::array<double, 3> half{};
  for (std::size_t i = 0; i < 3; ++i) half[i] = (object.box_max[i] - object.box_min[i]) / 2;
  const auto& [w, x, y, z] = rotation;
  const std::array<double, 3> upright = {std::abs(2 * (x * z - w * y)),
                                         std::abs(2 * (y * z + w * x)),
                                         std::abs(1 - 2 * (x * x + y * y))};
  const auto up =
      static_cast<std::size_t>(std::max_element(upright.begin(), upright.end()) - upright.begin());
  return {half[up == 0 ? 2 : 0], half[up == 1 ? 2 : 1], half[up]};
}

}  // namespace

MadeUpWorld make_up_world(const plan::Plan& plan, std::uint32_t task) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const double table = plan.scenes()[record.scene].surface_z;
  const plan::RobotRecord& robot = plan.robots()[plan.scenes()[record.scene].robot];
  const std::size_t fingers = plan::finger_count(robot);  // the first of the links
  const auto bodies = plan.bodies(record);
  const auto episodes = plan.episodes(record);
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), record);
  MadeUpWorld world;
  if (roles.has_source()) world.source = static_cast<std::uint16_t>(roles.source);
  if (roles.has_target()) world.target = static_cast<std::uint16_t>(roles.target);
  world.starts.resize(bodies.size());
  world.sample.bodies.resize(bodies.size());
  world.sample.tcp = {0, 0, table + kFar};
  world.sample.joints.resize(robot.drives.count);
  if (!episodes.empty()) {
    for (const double position :
         plan::joint_starts_of(plan.tables(), plan.scenes()[record.scene], episodes[0]))
      world.sample.joints.push_back({position, 0});
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto kind = static_cast<plan::BodyKind>(bodies[i].kind);
    Vec3 at = {0, 0, table + kFar};
    if (kind == plan::BodyKind::kSurface) {
      world.surface = static_cast<std::uint16_t>(i);
      at = {0, 0, table};
    } else if (kind == plan::BodyKind::kObject) {
      std::array<double, 4> rotation = {1, 0, 0, 0};
      if (!episodes.empty()) rotation = plan.placements(episodes[0])[i].rotation;
      world.starts[i].half = half_extents(plan.objects()[bodies[i].index], rotation);
      at = {kFar * static_cast<double>(i), 0, table + world.starts[i].half.z()};
    } else if (kind == plan::BodyKind::kLink) {
      world.starts[i].opening = {0, 1, 0};
      if (bodies[i].index < fingers) world.fingers.push_back(static_cast<std::uint16_t>(i));
    } else if (kind == plan::BodyKind::kFixture) {
      world.fixture = static_cast<std::uint16_t>(i);
    }
    world.starts[i].position = at;
    world.put(i, at);
  }
  return world;
}

Result<bool> judge_world(const plan::Plan& plan, std::uint32_t task, std::uint32_t metric,
                         MadeUpWorld world) {
  Judge judge(plan, task);
  PROBE_TRY(judge.begin(world.starts));
  for (int step = 1; step <= kSteps; ++step) {
    world.sample.step = step;
    world.sample.time = step / 5.0;
    PROBE_TRY(judge.step(world.sample));
  }
  return judge.truth(metric);
}

}  // namespace probe::vm
