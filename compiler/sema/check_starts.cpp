// P05xx: enumerates every task's starts and tests them: overlap of footprints, the surface's edge,
// the arm's reach. Looks at boxes only; collision hulls and inverse kinematics are not known here.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "compiler/sema/layouts.h"
#include "compiler/sema/passes.h"
#include "compiler/sema/tasks.h"

namespace probe::sema {
namespace {

struct Vec2 {
  double x = 0, y = 0;
};

// The shadow of an oriented box on the surface: a centre and three half axes, of which the outline
// is the sum.
struct Footprint {
  Vec2 centre;
  std::array<Vec2, 3> axes;

  double reach_along(const Vec2& n) const {
    double sum = 0;
    for (const Vec2& axis : axes) sum += std::abs(axis.x * n.x + axis.y * n.y);
    return sum;
  }
};

Footprint footprint(const Object& object, const Start::Placed& placed) {
  const auto& [w, x, y, z] = placed.turn.rotation;
  const double rows[2][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)}};
  Footprint result;
  result.centre = {placed.x, placed.y};
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = (object.box_min[i] + object.box_max[i]) / 2;
    const double half = (object.box_max[i] - object.box_min[i]) / 2;
    result.centre.x += rows[0][i] * middle;
    result.centre.y += rows[1][i] * middle;
    result.axes[i] = {rows[0][i] * half, rows[1][i] * half};
  }
  return result;
}

// How deep two footprints stand in one another; at most 0 when some line separates them.
double overlap(const Footprint& a, const Footprint& b) {
  double least = 1e9;
  for (const Footprint* shape : {&a, &b}) {
    for (const Vec2& axis : shape->axes) {
      const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y);
      if (length < 1e-9) continue;
      const Vec2 n = {-axis.y / length, axis.x / length};
      const double apart =
          std::abs((b.centre.x - a.centre.x) * n.x + (b.centre.y - a.centre.y) * n.y);
      least = std::min(least, a.reach_along(n) + b.reach_along(n) - apart);
    }
  }
  return least;
}

std::string centimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4gcm", metres * 100);
  return text;
}

std::string at(const Object& object, const Start::Placed& placed) {
  return object.name + " at (" + centimetres(placed.x) + ", " + centimetres(placed.y) + ")";
}

struct StartCheck {
  Context& context;
  const Task& task;
  const Layout& layout;

  const Object& object(const Start::Placed& placed) const {
    return context.model.objects[placed.object];
  }
  const Span& place() const { return task.layout_span; }

  void overlaps() const {
    std::size_t pairs = 0, bad = 0, first_episode = 0;
    double depth = 0;
    const Start::Placed* first[2] = {};
    for (std::size_t e = 0; e < task.starts.size(); ++e) {
      const auto& placed = task.starts[e].placed;
      for (std::size_t i = 0; i < placed.size(); ++i) {
        for (std::size_t j = i + 1; j < placed.size(); ++j) {
          ++pairs;
          // Boxes may touch: less than a micrometre is rounding.
          const double now = overlap(footprint(object(placed[i]), placed[i]),
                                     footprint(object(placed[j]), placed[j]));
          if (now <= 1e-6) continue;
          if (bad++ != 0) continue;
          depth = now;
          first_episode = e;
          first[0] = &placed[i];
          first[1] = &placed[j];
        }
      }
    }
    if (bad == 0) return;
    context
        .report(Code::P0501, place(),
                "`" + object(*first[0]).name + "` and `" + object(*first[1]).name +
                    "` overlap by " + centimetres(depth) + " in `" + task.name + "`; " +
                    std::to_string(bad) + " of " + std::to_string(pairs) +
                    " object pairs overlap in this task")
        .point("episode " + std::to_string(first_episode) + ": " +
               at(object(*first[0]), *first[0]) + ", " + at(object(*first[1]), *first[1]))
        .label(layout.span, "the layout");
  }

  void surface() const {
    const Scene& scene = context.model.scenes[task.scene];
    for (std::size_t e = 0; e < task.starts.size(); ++e) {
      for (const Start::Placed& placed : task.starts[e].placed) {
        const Footprint shape = footprint(object(placed), placed);
        const double rx = shape.reach_along({1, 0});
        const double ry = shape.reach_along({0, 1});
        const bool inside =
            shape.centre.x - rx >= scene.area[0] && shape.centre.x + rx <= scene.area[2] &&
            shape.centre.y - ry >= scene.area[1] && shape.centre.y + ry <= scene.area[3];
        if (inside) continue;
        context
            .report(Code::P0505, place(),
                    "`" + object(placed).name + "` stands over the edge of `" + scene.name +
                        "` in `" + task.name + "`")
            .point("episode " + std::to_string(e) + ": " + at(object(placed), placed))
            .label(layout.span, "the layout");
        return;
      }
    }
  }

  void reach() const {
    const Scene& scene = context.model.scenes[task.scene];
    if (scene.robot == RobotId::kNone) return;
    const Robot& robot = context.model.robots[scene.robot];
    if (robot.reach_max == 0) return;
    for (std::size_t e = 0; e < task.starts.size(); ++e) {
      for (const Start::Placed& placed : task.starts[e].placed) {
        const double dx = placed.x - scene.base_position[0];
        const double dy = placed.y - scene.base_position[1];
        const double away = std::sqrt(dx * dx + dy * dy);
        if (away >= robot.reach_min && away <= robot.reach_max) continue;
        context
            .report(Code::P0502, place(),
                    "`" + object(placed).name + "` is " + centimetres(away) +
                        " from the base of `" + robot.name + "` in `" + task.name +
                        "`, which reaches " + centimetres(robot.reach_min) + " to " +
                        centimetres(robot.reach_max))
            .point("episode " + std::to_string(e) + ": " + at(object(placed), placed))
            .label(layout.span, "the layout");
        return;
      }
    }
  }
};

// What the starts of a task depend on.
std::vector<double> starts_key(const Task& task) {
  std::vector<double> key = {static_cast<double>(task.layout)};
  for (const ObjectId id : task.objects()) key.push_back(static_cast<double>(id));
  for (const PoseOverride& pose : task.poses) {
    key.push_back(-1);
    key.push_back(static_cast<double>(pose.object));
    for (const Turn& turn : pose.turns)
      key.insert(key.end(), turn.rotation.begin(), turn.rotation.end());
  }
  return key;
}

struct StartCache {
  const std::vector<Start>* starts = nullptr;
  std::set<SceneId> fine_in;  // scenes in which nothing is wrong with them
};

}  // namespace

void check_starts(Context& context) {
  std::map<std::vector<double>, StartCache> known;
  std::size_t episodes = 0;
  for (Task& task : context.model.tasks) {
    if (task.abstract || !task.complete) continue;
    const About about(context, task.decl_span);
    const Layout& layout = context.model.layouts[task.layout];
    StartCache& cache = known[starts_key(task)];
    if (cache.starts == nullptr) {
      std::optional<LayoutProblem> problem;
      std::vector<Start> starts =
          enumerate_starts(context.model, layout, task, kMaxEpisodes - episodes, problem);
      if (problem) {
        const Code code = problem->kind == LayoutProblem::kTooFewCells ? Code::P0503
                          : problem->kind == LayoutProblem::kNotPlaced ? Code::P0206
                          : problem->kind == LayoutProblem::kTooMany   ? Code::P0210
                                                                       : Code::P0304;
        context.report(code, task.layout_span, problem->message + " in `" + task.name + "`")
            .label(problem->span, "the layout");
        task.complete = false;
        continue;
      }
      cache.starts = &context.model.start_lists.emplace_back(std::move(starts));
    }
    task.starts = *cache.starts;
    episodes += task.starts.size();
    if (episodes > kMaxEpisodes) {
      context.report(Code::P0210, task.span,
                     "the suite grows beyond " + std::to_string(kMaxEpisodes) + " episodes with `" +
                         task.name + "`");
      return;
    }
    if (layout.expect && *layout.expect != task.starts.size()) {
      context
          .report(Code::P0504, layout.expect_span,
                  "`" + task.name + "` has " + std::to_string(task.starts.size()) +
                      " episodes, not " + std::to_string(*layout.expect))
          .label(task.layout_span, "used here");
    }
    if (cache.fine_in.contains(task.scene)) continue;
    const std::size_t before = context.diagnostics.size();
    const StartCheck check{context, task, layout};
    check.overlaps();
    check.surface();
    check.reach();
    if (context.diagnostics.size() == before) cache.fine_in.insert(task.scene);
  }
}

}  // namespace probe::sema
