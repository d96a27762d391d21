// P05xx: enumerates every task's starts and tests them: overlap of footprints, the surface's edge,
// the camera's image, the arm's reach. Looks at boxes only; collision hulls are not known here.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <span>

#include "compiler/define/axes.h"
#include "compiler/define/layout.h"
#include "compiler/define/passes.h"
#include "compiler/define/task.h"
#include "compiler/geometry/in_frame.h"
#include "compiler/geometry/reachable.h"
#include "compiler/names/allow.h"

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

// The factor by which the vector between two cells must grow until their footprints only touch;
// nothing when they stand on the same cell.
std::optional<double> growth(const Footprint& a, const Footprint& b, const Vec2& cells) {
  std::optional<double> least;
  for (const Footprint* shape : {&a, &b}) {
    for (const Vec2& axis : shape->axes) {
      const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y);
      if (length < 1e-9) continue;
      Vec2 n = {-axis.y / length, axis.x / length};
      double step = cells.x * n.x + cells.y * n.y;
      if (step < 0) n = {-n.x, -n.y}, step = -step;
      if (step < 1e-6) continue;
      const double apart = (b.centre.x - a.centre.x) * n.x + (b.centre.y - a.centre.y) * n.y;
      const double missing = a.reach_along(n) + b.reach_along(n) - apart;
      least = std::min(least.value_or(1e9), 1 + missing / step);
    }
  }
  return least;
}

// The height of a turned box (m).
double height(const Object& object, const Turn& turn) {
  const auto& [w, x, y, z] = turn.rotation;
  const double row[3] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += std::abs(row[i]) * (object.box_max[i] - object.box_min[i]);
  return sum;
}

std::string centimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4gcm", metres * 100);
  return text;
}

std::string at(const Object& object, const Start::Placed& placed) {
  return object.name + " at (" + centimetres(placed.x) + ", " + centimetres(placed.y) + ")";
}

// Rounded up to a whole millimetre: what is advised has to fit.
std::string millimetre_up(double metres) {
  return centimetres(std::ceil(metres * 1000 - 1e-6) / 1000);
}

struct StartCheck {
  Context& context;
  const Task& task;
  const Layout& layout;
  std::map<SceneId, std::optional<Arm>>& arms;
  bool like_is_fine = false;  // the task that this one copies starts well

  const Object& object(const Start::Placed& placed) const {
    return context.model.objects[placed.object];
  }
  // The layout, unless it is fine for the task that this one copies: then what came in here.
  Span place(std::initializer_list<ObjectId> objects) const {
    if (!like_is_fine || is_within(task.layout_span, task.decl_span)) return task.layout_span;
    for (const ObjectId id : objects) {
      if (const auto span = entry_of(task, id)) return *span;
    }
    return task.span;
  }

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
    Diagnostic& said =
        context
            .report(Code::P0501, place({first[0]->object, first[1]->object}),
                    "`" + object(*first[0]).name + "` and `" + object(*first[1]).name +
                        "` overlap by " + centimetres(depth) + " in `" + task.name + "`; " +
                        std::to_string(bad) + " of " + std::to_string(pairs) +
                        " object pairs overlap in this task")
            .point("episode " + std::to_string(first_episode) + ": " +
                   at(object(*first[0]), *first[0]) + ", " + at(object(*first[1]), *first[1]));
    if (!advise_spread(said)) said.label(layout.span, "the layout");
  }

  // At each spread that is too small, the least of the same shape at which nothing overlaps.
  // Nothing is said when something overlaps that a spread does not move apart.
  bool advise_spread(Diagnostic& said) const {
    if (layout.jitter > 0) return false;
    std::map<const Cells::Spread*, double> factors;
    for (const Start& start : task.starts) {
      for (std::size_t i = 0; i < start.placed.size(); ++i) {
        for (std::size_t j = i + 1; j < start.placed.size(); ++j) {
          const Start::Placed &a = start.placed[i], &b = start.placed[j];
          const Footprint one = footprint(object(a), a), two = footprint(object(b), b);
          if (overlap(one, two) <= 1e-6) continue;
          const Cells::Spread* spread = spread_of(a, b);
          if (spread == nullptr) return false;
          const auto factor = growth(one, two, {b.x - a.x, b.y - a.y});
          if (!factor) return false;
          double& most = factors[spread];
          most = std::max(most, *factor);
        }
      }
    }
    for (const Cells& cells : layout.cells) {
      for (const Cells::Spread& spread : cells.spreads) {
        const auto found = factors.find(&spread);
        if (found == factors.end()) continue;
        const std::string x = millimetre_up(spread.x * found->second);
        const std::string y = millimetre_up(spread.y * found->second);
        said.label(spread.span, (x == y ? x : "(" + x + ", " + y + ")") +
                                    " is the least that fits these objects");
      }
    }
    return true;
  }

  // Of the grid on which both stand.
  const Cells::Spread* spread_of(const Start::Placed& a, const Start::Placed& b) const {
    for (const Cells& cells : layout.cells) {
      for (std::size_t g = 0; g < cells.grids.size(); ++g) {
        const auto holds = [&](const Start::Placed& placed) {
          return std::any_of(cells.grids[g].begin(), cells.grids[g].end(), [&](const Cell& cell) {
            return cell.x == placed.x && cell.y == placed.y;
          });
        };
        if (holds(a) && holds(b)) return &cells.spreads[g];
      }
    }
    return nullptr;
  }

  // One warning for the task, of the object that is the farthest out of every camera that does not
  // move.
  void frame() const {
    const Scene& scene = context.model.scenes[task.scene];
    std::vector<Frustum> fixed;
    const Camera* first = nullptr;
    for (const View& view : views_of(context.model, task)) {
      const Camera& camera = context.model.cameras[view.camera];
      const auto frustum = Frustum::of(context.model, scene, camera);
      if (!frustum) continue;
      if (fixed.empty()) first = &camera;
      fixed.push_back(*frustum);
    }
    if (fixed.empty()) return;
    const Camera& camera = *first;
    constexpr double kBehind = 1e9;  // px
    double most = 0;
    std::size_t bad = 0, all = 0, episode = 0;
    const Start::Placed* worst = nullptr;
    for (std::size_t e = 0; e < task.starts.size(); ++e) {
      for (const Start::Placed& placed : task.starts[e].placed) {
        ++all;
        double out = kBehind;
        for (const Frustum& frustum : fixed)
          out = std::min(out, frustum.outside(object(placed), placed).value_or(1e10));
        if (out < 1) continue;  // part of a pixel is no loss
        ++bad;
        if (out <= most) continue;
        most = out;
        episode = e;
        worst = &placed;
      }
    }
    if (worst == nullptr) return;
    const std::string how = most < kBehind
                                ? "lies " + std::to_string(static_cast<long>(std::ceil(most))) +
                                      " pixels outside the image of"
                                : "lies behind";
    Diagnostic& said =
        context.report(Code::P0505, place({worst->object}),
                       "`" + object(*worst).name + "` " + how + " `" + camera.name + "` in `" +
                           task.name + "`; " + std::to_string(bad) + " of " + std::to_string(all) +
                           " objects are mostly out of view in this task");
    said.severity = Severity::kWarning;
    said.point("episode " + std::to_string(episode) + ": " + at(object(*worst), *worst))
        .label(camera.span, "the camera")
        .label(layout.span, "the layout");
  }

  // False when something was reported.
  bool surface() const {
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
            .report(Code::P0505, place({placed.object}),
                    "`" + object(placed).name + "` stands over the edge of `" + scene.name +
                        "` in `" + task.name + "`")
            .point("episode " + std::to_string(e) + ": " + at(object(placed), placed))
            .label(layout.span, "the layout")
            .label(scene.span, "the surface is x " + centimetres(scene.area[0]) + " .. " +
                                   centimetres(scene.area[2]) + ", y " +
                                   centimetres(scene.area[1]) + " .. " +
                                   centimetres(scene.area[3]));
        return false;
      }
    }
    return true;
  }

  // False when something was reported.
  bool reach() const {
    const Scene& scene = context.model.scenes[task.scene];
    if (scene.robot == RobotId::kNone) return true;
    const Robot& robot = context.model.robots[scene.robot];
    for (std::size_t e = 0; robot.reach_max != 0 && e < task.starts.size(); ++e) {
      for (const Start::Placed& placed : task.starts[e].placed) {
        const double dx = placed.x - scene.base_position[0];
        const double dy = placed.y - scene.base_position[1];
        const double away = std::sqrt(dx * dx + dy * dy);
        if (away >= robot.reach_min && away <= robot.reach_max) continue;
        context
            .report(Code::P0502, place({placed.object}),
                    "`" + object(placed).name + "` is " + centimetres(away) +
                        " from the base of `" + robot.name + "` in `" + task.name +
                        "`, which reaches " + centimetres(robot.reach_min) + " to " +
                        centimetres(robot.reach_max))
            .point("episode " + std::to_string(e) + ": " + at(object(placed), placed))
            .label(layout.span, "the layout");
        return false;
      }
    }
    return grasps(scene, robot);
  }

  // A pose over the middle of the source, and one over the target with the source in hand.
  bool grasps(const Scene& scene, const Robot& robot) const {
    auto found = arms.find(task.scene);
    if (found == arms.end()) found = arms.emplace(task.scene, Arm::of(context.model, scene)).first;
    if (!found->second) return true;
    constexpr double kAboveTarget = 0.02;  // m
    for (std::size_t e = 0; e < task.starts.size(); ++e) {
      const auto& placed = task.starts[e].placed;
      const double half = height(object(placed[0]), placed[0].turn) / 2;
      const double on_target = height(object(placed[1]), placed[1].turn) + half + kAboveTarget;
      for (std::size_t i = 0; i < 2; ++i) {
        const double z = scene.surface_z + (i == 0 ? half : on_target);
        const auto miss = found->second->misses(placed[i].x, placed[i].y, z);
        if (!miss) continue;
        char degrees[32];
        std::snprintf(degrees, sizeof degrees, "%.2g", miss->rotation * 180 / 3.14159265358979);
        context
            .report(Code::P0502, place({placed[i].object, placed[0].object}),
                    "`" + robot.name + "` cannot " +
                        (i == 0 ? "grasp `" + object(placed[0]).name + "` from above"
                                : "place `" + object(placed[0]).name + "` on `" +
                                      object(placed[1]).name + "`") +
                        " in `" + task.name + "`: the tool stays " + centimetres(miss->position) +
                        " and " + degrees + "deg away")
            .point("episode " + std::to_string(e) + ": " + at(object(placed[i]), placed[i]))
            .label(layout.span, "the layout");
        return false;
      }
    }
    return true;
  }
};

// " (12 placements x 2 turns)", where that is what they are made of.
std::string factors(std::span<const Start> starts) {
  std::set<std::vector<double>> placements, turns;
  for (const Start& start : starts) {
    std::vector<double> at, turned;
    for (const Start::Placed& placed : start.placed) {
      at.insert(at.end(), {placed.x, placed.y});
      turned.insert(turned.end(), placed.turn.rotation.begin(), placed.turn.rotation.end());
    }
    placements.insert(std::move(at));
    turns.insert(std::move(turned));
  }
  if (placements.size() * turns.size() != starts.size()) return "";
  return " (" + std::to_string(placements.size()) + " placements x " +
         std::to_string(turns.size()) + " turns)";
}

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
  std::set<std::pair<SceneId, std::vector<CameraId>>> fine_in;  // where nothing is wrong with them
};

}  // namespace

void check_starts(Context& context) {
  std::map<std::vector<double>, StartCache> known;
  std::map<SceneId, std::optional<Arm>> arms;
  std::set<LayoutId> incomplete_layouts;  // that lack a place: said once
  std::vector<bool> fine(context.model.tasks.size(), false);
  std::size_t at = 0, episodes = 0;
  for (Task& task : context.model.tasks) {
    const std::size_t index = at++;
    if (task.abstract || !task.complete) continue;
    const bool like_is_fine =
        task.like != TaskId::kNone && fine[static_cast<std::size_t>(task.like)];
    const About about(context, task.decl_span);
    const Layout& layout = context.model.layouts[task.layout];
    StartCache& cache = known[starts_key(task)];
    if (cache.starts == nullptr) {
      std::optional<LayoutProblem> problem;
      std::vector<Start> starts =
          enumerate_starts(context.model, layout, task, kMaxEpisodes - episodes, problem);
      if (problem) {
        task.complete = false;
        const bool is_layout = problem->kind == LayoutProblem::kNotPlaced;
        // What a layout lacks, its copies lack.
        const bool is_known = incomplete_layouts.contains(layout.like);
        if (is_layout && (!incomplete_layouts.insert(task.layout).second || is_known)) continue;
        const Code code = problem->kind == LayoutProblem::kTooFewCells ? Code::P0503
                          : problem->kind == LayoutProblem::kNotPlaced ? Code::P0206
                          : problem->kind == LayoutProblem::kTooMany   ? Code::P0210
                                                                       : Code::P0304;
        const bool is_newcomer = like_is_fine && is_within(task.distractors_span, task.decl_span);
        context
            .report(code, is_newcomer ? task.distractors_span : task.layout_span,
                    problem->message + " in `" + task.name + "`")
            .label(problem->span, "the layout");
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
                  "`" + task.name + "` has " + std::to_string(task.starts.size()) + " episodes" +
                      factors(task.starts) + ", not " + std::to_string(*layout.expect))
          .label(task.layout_span, "used here");
    }
    std::pair where{task.scene, std::vector<CameraId>()};
    for (const View& view : views_of(context.model, task)) where.second.push_back(view.camera);
    if (cache.fine_in.contains(where)) {
      fine[index] = true;
      continue;
    }
    const std::size_t before = context.diagnostics.size();
    const StartCheck check{context, task, layout, arms, like_is_fine};
    check.overlaps();
    // What lies beside the table is out of reach and out of view as well.
    if (check.surface() && check.reach()) check.frame();
    fine[index] = context.diagnostics.size() == before;
    if (fine[index]) cache.fine_in.insert(where);
  }
}

}  // namespace probe::sema
