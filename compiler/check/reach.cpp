// P0502: a place outside the annulus that the arm reaches, or at which it cannot grasp or set down.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "compiler/check/starts.h"
#include "compiler/geometry/footprint.h"

namespace probe::sema {
namespace {

// What misses the middle by less than the thing is thick may still take it by another place: only
// what cannot be done is a mistake.
bool may_do(const Shortfall& miss, const Object& object) {
  constexpr double kTilt = 0.05;  // rad, that a hand may lean
  double thinnest = object.box_max[0] - object.box_min[0];
  for (std::size_t i = 1; i < 3; ++i)
    thinnest = std::min(thinnest, object.box_max[i] - object.box_min[i]);
  return miss.position < thinnest / 2 && miss.rotation < kTilt;
}

// Where a table of starts has it well above the surface, something else may carry it: at which
// height it is taken is not known before it has come to rest.
bool is_given_above(const Scene& scene, const Start::Placed& placed, double half) {
  constexpr double kAbove = 0.05;  // m
  return placed.z && *placed.z - (scene.surface_z + half) > kAbove;
}

// Unless its solution says that nothing is put there: beside the target, say.
bool is_put_onto_target(const Task& task) {
  const auto goes_there = [](const SkillUse& use) {
    return use.relation == plan::SkillRelation::kOn || use.relation == plan::SkillRelation::kIn;
  };
  return task.solution.empty() || std::ranges::any_of(task.solution, goes_there);
}

// A pose over the middle of the source, and one over the target with the source in hand.
bool check_grasps(const TaskStarts& starts, Arms& arms, const Scene& scene, const Robot& robot) {
  auto found = arms.find(starts.task.scene);
  if (found == arms.end())
    found = arms.emplace(starts.task.scene, Arm::of(starts.model, scene)).first;
  if (!found->second || starts.task.source == ObjectId::kNone) return true;
  const bool is_onto = is_put_onto_target(starts.task);
  constexpr double kAboveTarget = 0.02;            // m
  constexpr double kThere = 0.001, kAskew = 0.05;  // m, rad
  for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
    const auto& placed = starts.task.starts[e].placed;
    // Source and target are the first two, as far as there are any.
    const bool has_both = starts.task.has_both();
    const double half = height(starts.object(placed[0]), placed[0].turn) / 2;
    const double on_target =
        has_both ? height(starts.object(placed[1]), placed[1].turn) + half + kAboveTarget : 0;
    if (is_given_above(scene, placed[0], half)) continue;
    for (std::size_t i = 0; i < (has_both && is_onto ? 2u : 1u); ++i) {
      const double z = scene.surface_z + (i == 0 ? half : on_target);
      const auto miss = found->second->misses(placed[i].x, placed[i].y, z);
      if (!miss || may_do(*miss, starts.object(placed[i]))) continue;
      char degrees[32];
      const double off = miss->rotation * 180 / std::numbers::pi;
      std::snprintf(degrees, sizeof degrees, off < 10 ? "%.2g" : "%.0f", off);
      // A lift that ends too high, which no other place mends.
      const bool is_too_high = miss->above > 0.9 * miss->position && miss->rotation < kAskew;
      Diagnostic& said = starts.reporter.report(
          Situation::kNoGrasp, starts.place({placed[i].object, placed[0].object}),
          "`" + robot.name + "` cannot " +
              (i == 0 ? "grasp `" + starts.object(placed[0]).name + "` from above"
                      : "place `" + starts.object(placed[0]).name + "` on `" +
                            starts.object(placed[1]).name + "`") +
              " in `" + starts.task.name + "`: the tool " +
              (is_too_high
                   ? "comes no lower than " + centimetres(z + miss->above - scene.surface_z) +
                         " above the surface there, and has to come to " +
                         centimetres(z - scene.surface_z)
               : miss->position < kThere
                   ? std::string("points ") + degrees + "deg away from straight down"
                   : "stays " + centimetres(miss->position) + " and " + degrees + "deg away"));
      said.point("episode " + std::to_string(e) + ": " + at(starts.object(placed[i]), placed[i]))
          .label(starts.layout.span, "the layout");
      said.cause = cause_of(starts.layout.span, {scene.name, starts.object(placed[0]).name,
                                                 starts.object(placed[i]).name});
      if (miss->position < kThere && miss->rotation > kAskew && robot.points_span.is_none()) {
        said.help("the tool is taken to point along +x of `" + robot.tcp.text + "`; `tcp " +
                  robot.tcp.text + " points +z` says otherwise");
      }
      return false;
    }
  }
  return true;
}
}  // namespace

bool check_reach(const TaskStarts& starts, Arms& arms) {
  const Scene& scene = starts.model.scenes[starts.task.scene];
  if (scene.robot == RobotId::kNone) return true;
  const Robot& robot = starts.model.robots[scene.robot];
  const Start::Placed* first = nullptr;
  double first_away = 0;
  CountedStarts counted{0, starts.task.starts.size()};
  for (std::size_t e = 0; robot.reach_max != 0 && e < starts.task.starts.size(); ++e) {
    for (const Start::Placed& placed : starts.task.starts[e].placed) {
      const double away = distance_to_base(scene, placed);
      if (is_in_annulus(robot, away)) continue;
      if (first == nullptr) {
        first = &placed;
        first_away = away;
      }
      if (placed.object == first->object) counted.add(e);
    }
  }
  if (first != nullptr) {
    const Object& object = starts.object(*first);
    starts.reporter
        .report(Situation::kOutOfAnnulus, starts.place({first->object}),
                "`" + object.name + "` is " + centimetres(first_away) + " from the base of `" +
                    robot.name + "`, which reaches " + centimetres(robot.reach_min) + " to " +
                    centimetres(robot.reach_max) + "; too near or too far " + counted.text() +
                    " `" + starts.task.name + "`")
        .point(counted.first_words(at(object, *first)))
        .label(starts.layout.span, "the layout")
        .cause = cause_of(starts.layout.span, {scene.name, object.name});
    return false;
  }
  return starts.reporter.depth.is_immediate || check_grasps(starts, arms, scene, robot);
}

}  // namespace probe::sema
