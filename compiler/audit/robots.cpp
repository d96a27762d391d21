#include "compiler/audit/robots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "runtime/base/counted.h"
#include "runtime/plan/axes.h"
#include "runtime/robot/laws.h"

namespace probe::audit {
namespace {

constexpr std::array kItsAxes = {plan::Axis::kRobot, plan::Axis::kSensor, plan::Axis::kLatency};

// The bits of plan::Control count from 1, the table of kinds from 0.
std::string_view law_of(const plan::RobotRecord& robot) {
  const auto kinds = robot::control_kinds();
  return robot.control >= 1 && robot.control <= kinds.size() ? kinds[robot.control - 1].word
                                                             : std::string_view("?");
}

RobotFacts facts_of(const plan::Plan& plan, const plan::RobotRecord& robot) {
  RobotFacts facts;
  facts.name = std::string(plan.text(robot.name));
  facts.law = std::string(law_of(robot));
  facts.control_hz = robot.control_hz;
  facts.fingers = plan::finger_count(robot);
  facts.grip_closed = robot.grip_closed;
  facts.grip_open = robot.grip_open;
  if (robot.reach_max > 0) facts.reach = RobotFacts::Reach{robot.reach_min, robot.reach_max};
  return facts;
}

void count(const plan::Plan& plan, const plan::TaskRecord& task, RobotFacts& facts) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  ++facts.tasks;
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    for (const plan::PlacementRecord& object : plan.placements(episode)) {
      const double dx = object.position[0] - scene.base_position[0];
      const double dy = object.position[1] - scene.base_position[1];
      const double away = std::sqrt(dx * dx + dy * dy);
      facts.nearest = facts.farthest == 0 ? away : std::min(facts.nearest, away);
      facts.farthest = std::max(facts.farthest, away);
    }
    ++facts.starts;
  }
  if (task.baseline == plan::kNone) return;
  for (const plan::Axis axis : kItsAxes) {
    if (plan::moves(task.axes, axis)) ++facts.axes[std::string(plan::axis_name(axis))];
  }
}

std::string from_to(double low, double high) {
  return fmt::format("{:.3g}cm to {:.3g}cm", 100 * low, 100 * high);
}

std::string reach_text(const RobotFacts& robot) {
  std::string text = counted(robot.starts, "start") + " of " + counted(robot.tasks, "task");
  if (robot.farthest > 0)
    text += ", objects " + from_to(robot.nearest, robot.farthest) + " from its base";
  return robot.reach
             ? text + ", all within its reach of " + from_to(robot.reach->near, robot.reach->far)
             : text + ", and no `reach` says how far it gets";
}

std::string axes_text(const RobotFacts& robot) {
  std::string text;
  for (const auto& [axis, count] : robot.axes)
    text += fmt::format("{}{} in {}", text.empty() ? "comparisons move " : ", ", axis, count);
  return text.empty() ? "no comparison moves robot, sensor or latency" : text;
}

}  // namespace

std::vector<RobotFacts> robots_of(const plan::Plan& plan, std::span<const std::uint32_t> tasks) {
  std::vector<std::optional<RobotFacts>> all(plan.robots().size());
  for (const std::uint32_t index : tasks) {
    const plan::TaskRecord& task = plan.tasks()[index];
    const std::uint32_t robot = plan.scenes()[task.scene].robot;
    if (!all[robot]) all[robot] = facts_of(plan, plan.robots()[robot]);
    count(plan, task, *all[robot]);
  }
  std::vector<RobotFacts> used;
  for (std::optional<RobotFacts>& facts : all) {
    if (facts) used.push_back(std::move(*facts));
  }
  return used;
}

std::string to_text(const RobotFacts& robot) {
  std::string hand = "no fingers";
  if (robot.fingers > 0) {
    hand = fmt::format("{} finger{} (joint at {:.4g} closed, {:.4g} open)", robot.fingers,
                       robot.fingers == 1 ? "" : "s", robot.grip_closed, robot.grip_open);
  }
  return fmt::format("robot `{}`: {} at {:g} Hz, {}; {}; {}", robot.name, robot.law,
                     robot.control_hz, hand, reach_text(robot), axes_text(robot));
}

}  // namespace probe::audit
