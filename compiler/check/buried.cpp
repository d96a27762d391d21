// P0507: what a task handles begins where a hand does not get at it: under what a layout puts on
// it, or in a part of a fixture that is closed and that neither words, success nor solution open.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/check/called.h"
#include "compiler/check/check.h"
#include "compiler/check/clauses.h"
#include "compiler/check/goal.h"
#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/define/role.h"
#include "compiler/define/support.h"
#include "compiler/define/telling.h"
#include "compiler/geometry/footprint.h"

namespace probe::sema {
namespace {

constexpr double kShut = 0.1;  // of a joint's way: less is no way in

class BuriedChecker {
 public:
  BuriedChecker(const Model& model, const AssetRoot& asset_root, Reporter& reporter)
      : model_(model), reporter_(reporter), callings_(model), travels_(model, asset_root) {}

  void check(const Task& task) {
    const Layout& layout = model_.layouts[task.layout];
    if (std::none_of(layout.places.begin(), layout.places.end(),
                     [](const Place& place) { return place.is_put(); }))
      return;
    for (const Put& put : puts_of(model_, task)) {
      const auto where = where_of(model_, task, *put.place);
      if (!where) continue;
      if (put.place->how == Place::kOn && task.is_object(*where)) check_under(task, put, *where);
      if (model_.objects[*where].of) check_shut(task, put, *model_.objects[*where].of);
    }
  }

 private:
  std::string name(ObjectId id) const { return "`" + model_.objects[id].name + "`"; }
  bool is_source(const Task& task, ObjectId id) const {
    return task.role_of(id) == RoleId::kSource;
  }
  // Of many tasks of one layout the first that no @allow silences is told.
  std::string cause(const Put& put, ObjectId thing) const {
    const std::string known = thing == ObjectId::kNone ? "" : model_.objects[thing].name;
    return cause_of(put.place->span, {model_.objects[put.object].name, known});
  }

  // The source under its target, or under a distractor.
  void check_under(const Task& task, const Put& put, ObjectId below) {
    const RoleId above = task.role_of(put.object);
    const bool is_target = above == RoleId::kTarget;
    if (!is_source(task, below) || (!is_target && above != RoleId::kNone)) return;
    if (!covers(task, put.object, below) || handles(task, put.object)) return;
    const About about(reporter_, task.decl_span);
    report_of(reporter_, Code::P0507, task, put.place->span,
              name(below) + " of `" + task.name + "` begins under " + name(put.object) +
                  (is_target ? ", its target" : ""))
        .label(task.span, "the source of this")
        .help("place the one somewhere else, or say what is done before: `solution { put " +
              model_.objects[put.object].name + " on .. }`")
        .cause = cause(put, below);
  }

  // Whether most of the lower one is under the other: a nut on a plate is carried with it.
  bool covers(const Task& task, ObjectId above, ObjectId below) const {
    constexpr double kMost = 0.75;
    constexpr int kSteps = 20;  // of a side of the area that is asked
    const auto shadow_of = [&](ObjectId id) -> std::optional<Footprint> {
      const auto& placed = task.starts.front().placed;
      const auto at = std::ranges::find(placed, id, &Start::Placed::object);
      if (at == placed.end() || !model_.objects[id].has_box) return std::nullopt;
      return footprint(model_.objects[id], *at);
    };
    const auto upper = shadow_of(above), lower = shadow_of(below);
    if (!upper || !lower) return false;
    const double wide = lower->reach_along({1, 0}), deep = lower->reach_along({0, 1});
    int all = 0, covered = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const double across = (i % kSteps + 0.5) / kSteps * 2 - 1;
      const double along = (static_cast<double>(i / kSteps) + 0.5) / kSteps * 2 - 1;
      const Vec2 point = {lower->centre.x + across * wide, lower->centre.y + along * deep};
      if (!is_in(*lower, point)) continue;
      ++all;
      covered += is_in(*upper, point);
    }
    return covered >= kMost * all;
  }

  static bool is_in(const Footprint& shadow, const Vec2& point) {
    return std::ranges::all_of(shadow.axes, [&](const Vec2& axis) {
      const double length = std::hypot(axis.x, axis.y);
      if (length < 1e-9) return true;
      const Vec2 n = {-axis.y / length, axis.x / length};
      const double apart = (point.x - shadow.centre.x) * n.x + (point.y - shadow.centre.y) * n.y;
      return std::abs(apart) <= shadow.reach_along(n) + 1e-9;
    });
  }

  // Whether the solution takes the upper thing, the words speak of it as what is moved, or success
  // wants it elsewhere. Words that are not understood may say so.
  bool handles(const Task& task, ObjectId thing) {
    const bool is_solved =
        std::any_of(task.solution.begin(), task.solution.end(), [&](const SkillUse& skill) {
          const auto& what = skill.what.owner.text;
          const RoleId role = task.role_of(thing);
          return what == model_.objects[thing].name ||
                 (role != RoleId::kNone && what == model_.roles[role].name);
        });
    if (is_solved) return true;
    const auto goal = goal_of(model_, task);
    if (goal.shifted.contains(thing) || goal.raised.contains(thing)) return true;
    bool is_said = false;
    for_each_telling(task, [&](const Task& told) {
      const Clauses clauses = clauses_of(model_, told, callings_);
      is_said = is_said || !clauses.is_whole ||
                std::ranges::any_of(clauses.all, [&](const Clause& clause) {
                  return !clause.certain || (!clause.denied && is_moved(clause, thing));
                });
    });
    return is_said;
  }
  static bool is_moved(const Clause& clause, ObjectId thing) {
    return std::ranges::any_of(clause.what,
                               [&](const Clause::What& what) { return what.of.contains(thing); });
  }

  void check_shut(const Task& task, const Put& put, const OfFixture& of) {
    if (!is_source(task, put.object)) return;
    const Fixture& fixture = model_.fixtures[of.fixture];
    const std::uint32_t part = of.region ? fixture.regions[*of.region].part : of.part;
    const auto joint = fixture.parts[part].joint;
    if (!joint || !begins_shut(task, of.fixture, *joint) || opens(task, of.fixture, part) ||
        !lies_within(task, put.object, of.fixture, part))
      return;
    const ObjectId shown = fixture.parts[part].thing;
    const std::string drawer = shown == ObjectId::kNone
                                   ? "`" + fixture.name + "." + fixture.joints[*joint].name + "`"
                                   : name(shown);
    const About about(reporter_, task.decl_span);
    report_of(reporter_, Code::P0507, task, put.place->span,
              name(put.object) + " of `" + task.name + "` begins in " + drawer +
                  ", which is closed, and neither its words, its success nor its solution speak of "
                  "that")
        .label(task.span, "the source of this")
        .note("nothing shows where it is; the expert, which sees everything, opens it by itself")
        .help("say it in the words, or let it begin open: `start " + fixture.name + "." +
              fixture.joints[*joint].name + " ..`")
        .cause = cause(put, shown);
  }

  // In some start.
  bool begins_shut(const Task& task, FixtureId id, std::uint32_t joint) const {
    const Fixture::Joint& own = model_.fixtures[id].joints[joint];
    const double way = own.upper - own.lower;
    if (own.is_endless || way <= 0) return false;
    std::size_t at = 0, all = 0;
    bool is_found = false;
    for (const FixtureId other : model_.scenes[task.scene].fixtures) {
      if (other == id) at = all + joint, is_found = true;
      all += model_.fixtures[other].joints.size();
    }
    if (!is_found) return false;
    const std::vector<double> starts = joint_starts_in_all(model_, task);
    for (; at < starts.size(); at += all) {
      const double closed = own.closes_at_upper() ? own.upper : own.lower;
      if (std::abs(starts[at] - closed) < kShut * way) return true;
    }
    return false;
  }

  // Whether it lies lower than the part's upper edge, not on top of it.
  bool lies_within(const Task& task, ObjectId object, FixtureId id, std::uint32_t part) {
    const Scene& scene = model_.scenes[task.scene];
    const auto& travel = travels_.of(scene, id);
    const auto& placed = task.starts.front().placed;
    const auto at = std::find_if(placed.begin(), placed.end(),
                                 [&](const Start::Placed& one) { return one.object == object; });
    if (!travel || at == placed.end() || !at->z) return false;
    const std::vector<double> starts = joint_starts_of(model_, task, task.starts.front());
    std::size_t first = 0;
    for (const FixtureId other : scene.fixtures) {
      if (other == id) break;
      first += model_.fixtures[other].joints.size();
    }
    const std::span<const double> joints(starts.data() + first, model_.fixtures[id].joints.size());
    const std::vector<PartBox> boxes = travel->at(joints);
    return std::any_of(boxes.begin(), boxes.end(), [&](const PartBox& box) {
      return box.part == part && *at->z < box.solid.centre.z() + box.half.z();
    });
  }

  // Whether anything of the task speaks of the fixture's part, or of the fixture.
  bool opens(const Task& task, FixtureId id, std::uint32_t part) {
    const Fixture& fixture = model_.fixtures[id];
    const auto is_of_it = [&](ObjectId thing) {
      const auto& of = model_.objects[thing].of;
      return of && of->fixture == id;
    };
    const bool is_solved =
        std::any_of(task.solution.begin(), task.solution.end(), [&](const SkillUse& skill) {
          if (skill.skill != plan::Skill::kOpen) return false;
          if (skill.what.owner.text == fixture.name) return true;
          const auto role = find_role(model_, skill.what.owner.text);
          return role && std::ranges::any_of(task.objects_in(*role), is_of_it);
        });
    if (is_solved) return true;
    const ObjectId shown = fixture.parts[part].thing;
    if (shown != ObjectId::kNone && goal_of(model_, task).ways.contains(shown)) return true;
    bool is_said = false;
    for_each_telling(task, [&](const Task& told) {
      const Clauses clauses = clauses_of(model_, told, callings_);
      is_said = is_said || std::any_of(clauses.said.begin(), clauses.said.end(), is_of_it);
    });
    return is_said;
  }

  const Model& model_;
  Reporter& reporter_;
  Callings callings_;
  Travels travels_;
};

}  // namespace

void check_buried(const Model& model, const AssetRoot& asset_root, Reporter& reporter) {
  BuriedChecker checker(model, asset_root, reporter);
  for (const Task& task : model.tasks) {
    if (!task.abstract && task.complete && !task.starts.empty()) checker.check(task);
  }
}

}  // namespace probe::sema
