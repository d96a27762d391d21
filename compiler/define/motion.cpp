#include "compiler/define/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/define/record.h"
#include "compiler/define/role.h"
#include "compiler/define/support.h"
#include "compiler/names/quantities.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

// What a name stands for in a task: all that fill a role, or an object of that name.
std::vector<ObjectId> objects_named(const Model& model, const Task& task, const std::string& name) {
  if (const auto role = find_role(model, name)) return task.objects_in(*role);
  if (name == "distractors") return task.distractors;
  for (const ObjectId id : task.objects()) {
    if (model.objects[id].name == name) return {id};
  }
  return {};
}

bool is_short(const Motion& motion) {
  std::array<double, 2> at{};
  for (const std::array<double, 2>& to : motion.points) {
    if (std::hypot(to[0] - at[0], to[1] - at[1]) < plan::kMinLeg) return true;
    at = to;
  }
  return false;
}

}  // namespace

std::optional<Motion> read_motion(Context& context, const syntax::MovesStmt& stmt,
                                  const syntax::Quantity& speed) {
  Motion motion;
  motion.span = stmt.span;
  motion.way = stmt.way;
  if (stmt.points.empty()) return motion;
  for (const syntax::Point& point : stmt.points) {
    const auto at = read_point(context, point, 2, 2, dim::kLength,
                               Takes::places("`along` and `around` take lengths"));
    if (!at) return std::nullopt;
    motion.points.push_back({(*at)[0].si(), (*at)[1].si()});
  }
  const auto pace = read_quantity(context, speed, dim::kVelocity, "`at` takes a speed");
  if (!pace) return std::nullopt;
  motion.speed = pace->si();
  const auto report = [&](const Span& span, const std::string& message) {
    return &context.report(Situation::kMoveCannot, span, message);
  };
  if (!(motion.speed >= plan::kMinMoveSpeed && motion.speed <= plan::kMaxMoveSpeed)) {
    report(speed.span, fmt::format("expected a speed from {:g}mm/s to {:g}m/s",
                                   1000 * plan::kMinMoveSpeed, plan::kMaxMoveSpeed));
    return std::nullopt;
  }
  if (motion.points.size() > plan::kMaxLegs) {
    report(stmt.span,
           fmt::format("expected at most {} legs, found {}", plan::kMaxLegs, motion.points.size()));
    return std::nullopt;
  }
  if (is_short(motion)) {
    report(stmt.points.front().span, "a leg leads nowhere")
        ->help(
            "places are said from where the object lies when the episode begins: `along (10cm, "
            "0cm)`");
    return std::nullopt;
  }
  return motion;
}

bool check_motions(Context& context, const Task& task) {
  const Model& model = context.model;
  const std::vector<Put> puts = puts_of(model, task);
  std::vector<ObjectId> seen;
  for (const Motion& motion : task.motions) {
    const auto report = [&](const std::string& what) {
      context.report(Situation::kMoveCannot, motion.span, what + " in `" + task.name + "`");
      return false;
    };
    const std::vector<ObjectId> objects = objects_named(model, task, motion.what.text);
    if (objects.empty() && context.symbols.objects.peek(motion.what.text)) {
      context
          .report(Situation::kNotInScene, motion.what.span,
                  "object `" + motion.what.text + "` is not in the scene of `" + task.name + "`")
          .help("place it there: `place " + motion.what.text +
                " at (..)` in the layout, or `distractors " + motion.what.text + "`");
      return false;
    }
    if (objects.empty()) {
      std::vector<std::string_view> known = role_names(context);
      for (const ObjectId id : task.objects()) known.push_back(model.objects[id].name);
      report_unknown(context.diagnostics, "object or role of `" + task.name + "`",
                     {motion.what.span, motion.what.text}, known);
      return false;
    }
    for (const ObjectId object : objects) {
      const std::string& name = model.objects[object].name;
      if (!task.is_object(object))
        return report("`" + name + "` belongs to a fixture and moves on its joints alone");
      if (std::ranges::find(puts, object, &Put::object) != puts.end())
        return report("`" + name + "` lies in or on something and cannot move by itself");
      if (std::ranges::find(seen, object) != seen.end())
        return report("`" + name + "` moves in two ways");
      seen.push_back(object);
    }
  }
  return true;
}

std::vector<Mover> movers_of(const Model& model, const Task& task) {
  std::vector<Mover> movers;
  if (task.motions.empty()) return movers;
  const std::vector<ObjectId> objects = task.objects();
  for (const Motion& motion : task.motions) {
    for (const ObjectId id : objects_named(model, task, motion.what.text)) {
      const auto at = std::ranges::find(objects, id);
      if (at == objects.end()) continue;
      movers.push_back({static_cast<std::size_t>(at - objects.begin()), id, &motion});
    }
  }
  std::ranges::sort(movers, {}, &Mover::place);
  return movers;
}

std::vector<plan::MoveRecord> legs_of(const Motion& motion, std::size_t body) {
  std::vector<plan::MoveRecord> legs;
  for (const std::array<double, 2>& to : motion.points) {
    legs.push_back({static_cast<std::uint32_t>(body), static_cast<std::uint32_t>(motion.way), to,
                    motion.speed});
  }
  return legs;
}

bool same_motions(const Model& model, const Task& a, const Task& b) {
  const std::vector<Mover> here = movers_of(model, a), there = movers_of(model, b);
  return std::equal(
      here.begin(), here.end(), there.begin(), there.end(), [](const Mover& p, const Mover& q) {
        return p.place == q.place && p.motion->way == q.motion->way &&
               p.motion->points == q.motion->points && p.motion->speed == q.motion->speed;
      });
}

}  // namespace probe::sema
