// P1514: a source that is wider than the hand opens, whichever way it is taken. What is felt of it
// must be one convex part: what has several may have a rim, a wall or a handle to be held by.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "compiler/check/check.h"
#include "compiler/check/starts.h"
#include "compiler/geometry/felt_shape.h"
#include "runtime/robot/hands.h"

namespace probe::sema {
namespace {

struct Opening {
  double width = 0;          // m
  bool is_measured = false;  // of the fingers' shapes; else it is how far they move
};

// Whether `grip` opens both fingers as far as their joints go, as they were measured.
bool opens_whole(const Robot& robot) {
  constexpr double kRounding = 1e-6;  // m
  return std::ranges::all_of(robot.fingers, [&](const Finger& finger) {
    const int link = robot.model->find_link(finger.link.text);
    if (link < 0) return false;
    const int above = robot.model->links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) return false;
    const robot::Joint& joint = robot.model->joints[static_cast<std::size_t>(above)];
    return joint.kind == robot::JointKind::kPrismatic && robot.grip_open >= joint.upper - kRounding;
  });
}

std::optional<Opening> opening_of(const Robot& robot) {
  if (!robot.model || robot.fingers.size() != 2) return std::nullopt;
  const auto hand = robot::known_hand(robot.model->name);
  if (hand && opens_whole(robot)) return Opening{2 * hand->shape.opening_half, true};
  if (robot.grip_turns) return std::nullopt;
  return Opening{2 * std::abs(robot.grip_open - robot.grip_closed), false};
}

double narrowest(const Object& object) {
  double least = object.box_max[0] - object.box_min[0];
  for (std::size_t i = 1; i < 3; ++i)
    least = std::min(least, object.box_max[i] - object.box_min[i]);
  return least;
}

// Whether the hand takes it: a solution may only push it.
bool is_taken(const Task& task) {
  const auto takes = [](const SkillUse& use) {
    return use.skill == plan::Skill::kPick || use.skill == plan::Skill::kPut;
  };
  return task.solution.empty() || std::ranges::any_of(task.solution, takes);
}

bool is_convex(const Object& object, const AssetRoot& asset_root) {
  const auto shape = felt_shape(object, asset_root);
  return shape.ok() && shape->parts.size() == 1;
}

}  // namespace

void check_wide(const Model& model, const AssetRoot& asset_root, Reporter& reporter) {
  std::map<ObjectId, bool> convex;     // reads each mesh once
  constexpr double kClosedGap = 0.02;  // m: closed fingers may stay that far apart
  for (const Task& task : model.tasks) {
    if (!task.complete || task.abstract || task.source == ObjectId::kNone ||
        !task.is_object(task.source) || !is_taken(task))
      continue;
    const RobotId id = model.scenes[task.scene].robot;
    if (id == RobotId::kNone) continue;
    const auto opening = opening_of(model.robots[id]);
    const Object& object = model.objects[task.source];
    if (!opening || !object.has_box) continue;
    const double width = narrowest(object);
    if (width <= opening->width + (opening->is_measured ? 0 : kClosedGap)) continue;
    const auto [known, is_new] = convex.try_emplace(task.source, false);
    if (is_new) known->second = is_convex(object, asset_root);
    if (!known->second) continue;
    const About about(reporter, task.decl_span);
    const double fits = std::floor(opening->width / width * object.scale * 20) / 20;
    Diagnostic& said = reporter.report(
        Code::P1514, task.place(task.role_span[0]),
        fmt::format("`{}` is {} across where it is narrowest, and the fingers of `{}` {} {}",
                    object.name, centimetres(width), model.robots[id].name,
                    opening->is_measured ? "open to" : "move apart by",
                    centimetres(opening->width)));
    said.label(object.box_span, "its box");
    said.help("it can be pushed alone" +
              (fits > 0 ? fmt::format("; `scale {:g}` would fit between the fingers", fits)
                        : std::string()));
    said.cause = cause_of(object.span, {object.name, model.robots[id].name});
  }
}

}  // namespace probe::sema
