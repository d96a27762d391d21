#include "runtime/libero/suite_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "runtime/libero/goal.h"
#include "runtime/libero/rooms.h"
#include "runtime/libero/scene_kinds.h"

namespace probe::libero {
namespace {

constexpr double kHalfSite = 0.007;  // m, half the height of a region's site on a table
// A fixture's model stands this far below the workspace's offset (FIXTURE z_offset of the
// samplers).
constexpr double kBelowOffset = -0.04;

// A metre as centimetres, rounded to a hundredth of a nanometre so that 0.06 m is
// no 6.000000000001.
std::string cm(double metres) {
  return fmt::format("{:.12g}cm", std::round(metres * 1e11) / 1e9 + 0.0);
}
std::string degrees(double radians) {
  return fmt::format("{:.12g}deg", std::round(radians * 180 / std::numbers::pi * 1e9) / 1e9 + 0.0);
}

struct Placed {
  std::string category;
  std::string position, turn;  // as written
  bool operator<(const Placed& other) const {
    return std::tie(category, position, turn) <
           std::tie(other.category, other.position, other.turn);
  }
};

class SuiteWriter {
 public:
  SuiteWriter(const Suite& suite, const Things& things, const std::set<std::string>& rooms,
              const std::vector<FixturePose>& poses, std::set<std::string>& taken)
      : suite_(suite), things_(things), rooms_(rooms), poses_(poses), taken_(taken) {}

  Result<SuiteText> write(const std::vector<TaskSource>& tasks) {
    std::string body;
    std::size_t starts = 0;
    for (const TaskSource& task : tasks) {
      PROBE_TRY(add_task(task, body));
      starts += task.states.starts.size();
    }
    out_.text = fmt::format(
        "# {}: {} tasks, {} starts, as the benchmark's own files have them. `vlaprobe audit` says "
        "what its rules let pass.\n"
        "use \"suite/libero/stage.probe\"\n"
        "use \"suite/libero/predicates.probe\"\n"
        "use \"things.probe\"\n\n",
        suite_.folder, tasks.size(), starts);
    out_.text += body;
    out_.text += fmt::format("suite {} {{\n  tasks {{ {} }}\n  seeds 0\n", suite_.folder,
                             fmt::join(names_, ", "));
    out_.text += fmt::format("  expect {} tasks, {} episodes\n}}\n", tasks.size(), starts);
    return std::move(out_);
  }

 private:
  // What stands in one task's scene.
  struct Stage {
    const SceneKind* row = nullptr;
    std::map<std::string, std::string, std::less<>>
        fixtures;  // names in the text, by the problem's
    std::string scene;
    // What stands for a thing or a place of the problem where a role is filled by it: "source".
    std::map<std::string, std::string, std::less<>> roles;
  };

  Failure wrong(const TaskSource& task, std::string what) const {
    return {Fault::kUsage, std::move(what), task.problem.path};
  }

  const Thing* thing_of(std::string_view category) const {
    const auto at = things_.find(category);
    return at == things_.end() ? nullptr : &at->second;
  }

  Status add_task(const TaskSource& task, std::string& body) {
    Stage stage;
    PROBE_TRY(stand_up(task, stage, body));
    const GoalRoles roles = roles_of(task.problem);
    // Before roles stand for things: a role is filled by a thing's own name.
    PROBE_ASSIGN(const std::string filled, fill_roles(task, roles, stage));
    PROBE_ASSIGN(const std::string goal, goal_of(task, stage));
    PROBE_ASSIGN(const std::string solution, solution_of(task, stage));
    const std::string id = fmt::format("{}_{:02}", suite_.folder, task.number);
    out_.tables.push_back({"starts/" + id + ".csv", table_of(task, stage)});
    std::string name = task.stem;
    for (char& c : name) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    names_.push_back(name);
    out_.tasks.push_back(
        {id, name, std::string(stage.row->scene), stage.scene, out_.tables.back().text, goal});
    const std::string instruction = instruction_of(task.stem);
    std::string other = task.problem.language;
    for (char& c : other) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    body += fmt::format("layout {} {{ starts \"starts/{}.csv\"; drop none }}\n", id, id);
    body += fmt::format("metrics {}{} {{ success = at end ({}); ends when {} }}\n", id,
                        metrics_like(roles), goal, goal);
    add_depth(task, *stage.row, id, body);
    if (other != instruction)
      body += fmt::format("# Its BDDL calls it: {}\n", task.problem.language);
    body += fmt::format(
        "task {} like {}_task {{\n  scene {}; layout {}; metrics {}\n{}  say \"{}\"\n{}}}\n\n",
        name, suite_.folder, stage.scene, id, id, filled, instruction, solution);
    return {};
  }

  // Things that begin inside the table or the floor are said above their task.
  void add_depth(const TaskSource& task, const SceneKind& row, const std::string& id,
                 std::string& body) {
    constexpr double kShown = 1e-3;  // m
    std::size_t deep = 0;
    double deepest = 0;
    const BddlThing* what = nullptr;
    for (const StartState& start : task.states.starts) {
      double here = 0;
      for (std::size_t k = 0; k < start.objects.size(); ++k) {
        const BddlThing& object = task.problem.objects[k];
        const Thing* thing = thing_of(object.category);
        if (thing == nullptr) continue;
        const double depth = row.surface - lowest(*thing, start.objects[k]);
        here = std::max(here, depth);
        if (depth <= deepest) continue;
        deepest = depth;
        what = &object;
      }
      deep += here > kShown ? 1 : 0;
    }
    if (deep == 0) return;
    const std::string said = fmt::format(
        "in {} of {} starts something begins inside the surface, the box around {} by {:.1f} mm",
        deep, task.states.starts.size(), what->name, 1000 * deepest);
    body += "# As stored " + said + ".\n";
    out_.notes.push_back(id + ": " + said);
  }

  // The lowest corner of the box around what is felt of it, in the world.
  static double lowest(const Thing& thing, const StatePose& pose) {
    const auto& q = pose.rotation;
    const Mat3 turn = Quat(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    double z = pose.position[2];
    for (Eigen::Index i = 0; i < 3; ++i)
      z += std::min(turn(2, i) * thing.low[i], turn(2, i) * thing.high[i]);
    return z;
  }

  // ---- what stands

  Status stand_up(const TaskSource& task, Stage& stage, std::string& body) {
    const BddlProblem& problem = task.problem;
    const SceneKind* const row = scene_kind(problem);
    if (row == nullptr)
      return wrong(task, "problem class `" + problem.problem_class + "` is not known");
    stage.row = row;
    std::vector<std::string> fixtures;
    for (const BddlThing& thing : problem.fixtures) {
      const Thing* known = thing_of(thing.category);
      if (known == nullptr) continue;  // the workspace
      PROBE_ASSIGN(const Placed placed, place_of(task, thing, *known, *row));
      PROBE_ASSIGN(const std::string name, fixture_named(thing, placed, body));
      stage.fixtures.emplace(thing.name, name);
      fixtures.push_back(name);
    }
    std::string lines;
    if (!fixtures.empty()) lines += fmt::format("  fixture {}\n", fmt::join(fixtures, ", "));
    for (const BddlFact& fact : problem.goal) {
      if (fact.predicate != "on") continue;
      const BddlRegion* region = problem.find_region(fact.arguments[1]);
      if (region == nullptr || region->ranges.empty()) continue;
      const auto& [x0, y0, x1, y1] = region->ranges.front();
      lines += fmt::format("  region {} of surface box ({}, {}, {}) .. ({}, {}, {})\n", region->own,
                           cm(x0 + row->x), cm(y0 + row->y), cm(row->regions - kHalfSite),
                           cm(x1 + row->x), cm(y1 + row->y), cm(row->regions + kHalfSite));
    }
    const std::string bare(row->scene);
    const std::string base = rooms_.contains(bare) ? with_room(bare) : bare;
    if (lines.empty()) {
      stage.scene = base;
      return {};
    }
    const std::string key = std::string(row->scene) + " " + scene_of(task.stem) + "\n" + lines;
    const auto [at, is_new] = scenes_.try_emplace(key);
    if (is_new) {
      const std::string said = scene_of(task.stem);
      const std::string_view plain = row->scene.substr(row->scene.find('_') + 1);
      at->second = free_name(said.empty() ? fmt::format("{}_{}", suite_.folder, plain) : said);
      body += fmt::format("scene {} like {} {{\n{}}}\n\n", at->second, base, lines);
    }
    stage.scene = at->second;
    return {};
  }

  std::string free_name(const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}_{}", wanted, i);
    return name;
  }

  // One declaration for all tasks in which it stands there.
  Result<std::string> fixture_named(const BddlThing& thing, const Placed& placed,
                                    std::string& body) {
    const auto [at, is_new] = fixtures_.try_emplace(placed);
    if (!is_new) return at->second;
    at->second = free_name(thing.name);
    body += fmt::format("fixture {} like {} {{ at {}{} }}\n", at->second, thing.category,
                        placed.position, placed.turn);
    return at->second;
  }

  Result<Placed> place_of(const TaskSource& task, const BddlThing& thing, const Thing& known,
                          const SceneKind& row) const {
    Placed placed{thing.category, {}, {}};
    for (const FixturePose& given : poses_) {
      if (given.suite != suite_.folder || given.stem != task.stem || given.fixture != thing.name)
        continue;
      const auto& [x, y, z] = given.pose.position;
      placed.position = fmt::format("({}, {}, {})", cm(x), cm(y), cm(z));
      const auto& q = given.pose.rotation;
      if (std::abs(q[1]) > 1e-6 || std::abs(q[2]) > 1e-6)
        return wrong(task, "`" + thing.name + "` is tilted, and fixtures stand upright");
      placed.turn = turn_text(2 * std::atan2(q[3], q[0]));
      return placed;
    }
    for (const BddlFact& fact : task.problem.init) {
      if (fact.predicate != "on" || fact.arguments[0] != thing.name) continue;
      const BddlRegion* region = task.problem.find_region(fact.arguments[1]);
      if (region == nullptr || region->ranges.empty()) break;
      const auto& [x0, y0, x1, y1] = region->ranges.front();
      placed.position =
          fmt::format("({}, {}, {})", cm((x0 + x1) / 2 + row.x), cm((y0 + y1) / 2 + row.y),
                      cm(row.z + kBelowOffset - known.bottom));
      if (region->yaw) placed.turn = turn_text(((*region->yaw)[0] + (*region->yaw)[1]) / 2);
      return placed;
    }
    return wrong(task, "nothing says where `" + thing.name + "` stands");
  }

  static std::string turn_text(double yaw) {
    const std::string text = degrees(yaw);
    return text == "0deg" ? std::string() : " yaw " + text;
  }

  // ---- what is wanted

  // What is measured beside success, of suite/libero/predicates.probe.
  static const char* metrics_like(const GoalRoles& roles) {
    if (roles.empty()) return "";
    return roles.source.empty()   ? " like handling_part"
           : roles.helper.empty() ? " like handling_one"
                                  : " like handling_two";
  }

  // The roles as statements; from then on they stand for what fills them.
  Result<std::string> fill_roles(const TaskSource& task, const GoalRoles& roles,
                                 Stage& stage) const {
    std::string text;
    std::map<std::string, std::string, std::less<>> stand_for;
    const auto fill = [&](const char* role, const std::string& name) -> Status {
      if (name.empty()) return {};
      const BddlRegion* region = task.problem.find_region(name);
      // Of a region of an object the object: `target.inside`.
      const bool is_objects =
          region != nullptr && task.problem.find_object(region->target) != nullptr;
      std::string thing = is_objects ? region->target : name;
      std::string said = thing;
      if (roles.source.empty()) {
        PROBE_ASSIGN(const std::vector<std::string> parts, parts_of(task, stage, name));
        said = parts.front();
        // A role is one part.
        if (parts.size() > 1) return {};
        thing = said;
      } else if (region != nullptr && !is_objects) {
        PROBE_ASSIGN(said, region_text(task, stage, *region));
        thing = said;
      }
      text += fmt::format("{}{} {}", text.empty() ? "  " : "; ", role, said);
      stand_for.emplace(thing, role);
      return {};
    };
    PROBE_TRY(fill("source", roles.source));
    PROBE_TRY(fill("target", roles.target));
    PROBE_TRY(fill("helper", roles.helper));
    PROBE_TRY(fill("helper_target", roles.helper_target));
    if (!text.empty() && !roles.distractors.empty())
      text += fmt::format("; distractors {}", fmt::join(roles.distractors, ", "));
    stage.roles = std::move(stand_for);
    return text.empty() ? text : text + "\n";
  }

  // The role that something fills, or its own name.
  static std::string said(const Stage& stage, const std::string& name) {
    const auto role = stage.roles.find(name);
    return role == stage.roles.end() ? name : role->second;
  }

  // How it can be done: an open door or a knob that is on is one of several, a closed one all.
  Result<std::string> solution_of(const TaskSource& task, const Stage& stage) const {
    const auto is_closable = [&](const BddlRegion& region) {
      return region.ranges.empty() && parts_of(task, stage, region.name).ok();
    };
    std::vector<std::string> skills;
    for (const BddlFact& step : steps_of(task.problem, is_closable)) {
      if (step.arguments.size() == 2 || step.predicate == "up") {
        std::vector<std::string> names = {said(stage, step.arguments[0])};
        if (step.arguments.size() == 2) {
          PROBE_ASSIGN(names.emplace_back(), place_text(task, stage, step.arguments[1]));
        }
        skills.push_back(skill_text(step, names));
        continue;
      }
      PROBE_ASSIGN(std::vector<std::string> parts, parts_of(task, stage, step.arguments[0]));
      const bool is_any = step.predicate == "open" || step.predicate == "turnon";
      if (is_any) parts.resize(1);
      for (const std::string& part : parts) skills.push_back(skill_text(step, {part}));
    }
    if (skills.empty()) return std::string();
    return fmt::format("  solution {{ {} }}\n", fmt::join(skills, "; "));
  }

  // An object, or a region; of an object's region the object: its middle is the safest place.
  Result<std::string> place_text(const TaskSource& task, const Stage& stage,
                                 const std::string& place) const {
    const BddlRegion* region = task.problem.find_region(place);
    if (region == nullptr) return said(stage, place);
    if (task.problem.find_object(region->target) != nullptr) return said(stage, region->target);
    return region_text(task, stage, *region);
  }

  Result<std::string> goal_of(const TaskSource& task, const Stage& stage) const {
    std::vector<std::string> conditions;
    for (const BddlFact& fact : task.problem.goal) {
      PROBE_ASSIGN(std::string condition, condition_of(task, stage, fact));
      conditions.push_back(std::move(condition));
    }
    const std::string all = fmt::format("{}", fmt::join(conditions, " and "));
    return all;
  }

  // "wooden_cabinet_1.top_region", "surface.plate_region".
  Result<std::string> region_text(const TaskSource& task, const Stage& stage,
                                  const BddlRegion& region) const {
    if (!region.ranges.empty()) return "surface." + region.own;
    const BddlThing* object = task.problem.find_object(region.target);
    const auto fixture = stage.fixtures.find(region.target);
    const BddlThing* thing = object != nullptr ? object : task.problem.find_fixture(region.target);
    const Thing* known = thing == nullptr ? nullptr : thing_of(thing->category);
    if (known == nullptr ||
        std::ranges::find(known->regions, region.own, &ThingRegion::name) == known->regions.end()) {
      return wrong(task, "`" + region.target + "` has no region `" + region.own + "`");
    }
    if (object != nullptr) return said(stage, region.target) + "." + region.own;
    return said(stage, fixture->second + "." + region.own);
  }

  // The parts whose joints are asked: of a region that of its own body, of a fixture all.
  Result<std::vector<std::string>> parts_of(const TaskSource& task, const Stage& stage,
                                            const std::string& name) const {
    const BddlRegion* region = task.problem.find_region(name);
    const std::string& owner = region == nullptr ? name : region->target;
    const BddlThing* fixture = task.problem.find_fixture(owner);
    const Thing* known = fixture == nullptr ? nullptr : thing_of(fixture->category);
    std::vector<std::string> parts;
    if (known != nullptr) {
      const auto of = region == nullptr
                          ? known->regions.end()
                          : std::ranges::find(known->regions, region->own, &ThingRegion::name);
      for (const ThingJoint& joint : known->joints) {
        if (region != nullptr && (of == known->regions.end() || of->part != joint.part)) continue;
        parts.push_back(said(stage, stage.fixtures.find(owner)->second + "." + joint.part));
      }
    }
    if (parts.empty()) return wrong(task, "`" + name + "` has no joint");
    return parts;
  }

  Result<std::string> condition_of(const TaskSource& task, const Stage& stage,
                                   const BddlFact& fact) const {
    if (fact.predicate == "on" || fact.predicate == "in") {
      const std::string &what = fact.arguments[0], &where = fact.arguments[1];
      if (task.problem.find_object(what) == nullptr)
        return wrong(task, "`" + what + "` is no object, and a goal puts objects");
      const BddlRegion* region = task.problem.find_region(where);
      if (region == nullptr) {
        if (fact.predicate == "in" || task.problem.find_object(where) == nullptr)
          return wrong(task, "`" + where + "` is no region, and no object to put things on");
        return fmt::format("on_thing({}, {})", said(stage, what), said(stage, where));
      }
      PROBE_ASSIGN(const std::string place, region_text(task, stage, *region));
      const char* const rule = fact.predicate == "in"   ? "in_site"
                               : region->ranges.empty() ? "on_site"
                                                        : "on_zone";
      return fmt::format("{}({}, {})", rule, said(stage, what), place);
    }
    if (fact.predicate == "up") return fmt::format("z(origin({})) >= 1m", fact.arguments[0]);
    PROBE_ASSIGN(const std::vector<std::string> parts, parts_of(task, stage, fact.arguments[0]));
    const bool is_knob = fact.predicate.starts_with("turn");
    const BddlRegion* region = task.problem.find_region(fact.arguments[0]);
    const std::string rule = is_knob ? (fact.predicate == "turnon" ? "knob_on" : "knob_off")
                                     : fmt::format("{}_{}", region != nullptr ? "drawer" : "door",
                                                   fact.predicate == "open" ? "opened" : "closed");
    // Open and turned on where any is, closed and turned off where all are.
    const bool any = fact.predicate == "open" || fact.predicate == "turnon";
    std::vector<std::string> asked;
    for (const std::string& part : parts) asked.push_back(rule + "(" + part + ")");
    const std::string all = fmt::format("{}", fmt::join(asked, any ? " or " : " and "));
    return asked.size() == 1 ? all : "(" + all + ")";
  }

  // ---- where things begin

  static std::string number(double value) { return fmt::format("{}", value + 0.0); }

  // Who fills a role stands there by that, so that in a variant another thing can take the place.
  std::string table_of(const TaskSource& task, const Stage& stage) const {
    std::string text = "start,object,x_m,y_m,z_m,qw,qx,qy,qz,value\n";
    for (std::size_t i = 0; i < task.states.starts.size(); ++i) {
      const StartState& start = task.states.starts[i];
      const auto add_joint = [&](std::string_view owner, std::string_view joint, double value) {
        text += fmt::format("{},{}.{},,,,,,,,{}\n", i, owner, joint, number(value));
      };
      for (std::size_t k = 0; k < start.objects.size(); ++k) {
        const StatePose& pose = start.objects[k];
        text += fmt::format("{},{}", i, said(stage, task.problem.objects[k].name));
        for (const double value : pose.position) text += "," + number(value);
        for (const double value : pose.rotation) text += "," + number(value);
        text += ",\n";
      }
      for (std::size_t k = 0; k < start.arm.size(); ++k)
        add_joint(stage.row->robot, fmt::format("joint{}", k + 1), start.arm[k]);
      // The second finger counts downwards in the benchmark's model.
      add_joint(stage.row->robot, "finger_joint1", start.fingers[0]);
      add_joint(stage.row->robot, "finger_joint2", -start.fingers[1]);
      for (std::size_t k = 0; k < start.joints.size(); ++k) {
        const auto& [fixture, joint] = task.states.joint_names[k];
        add_joint(stage.fixtures.find(fixture)->second, joint, start.joints[k]);
      }
    }
    return text;
  }

  const Suite& suite_;
  const Things& things_;
  const std::set<std::string>& rooms_;
  const std::vector<FixturePose>& poses_;
  SuiteText out_;
  std::vector<std::string> names_;
  std::map<Placed, std::string> fixtures_;
  std::map<std::string, std::string> scenes_;
  std::set<std::string>& taken_;
};

}  // namespace

Result<SuiteText> write_suite(const Suite& suite, const std::vector<TaskSource>& tasks,
                              const Things& things, const std::set<std::string>& rooms,
                              const std::vector<FixturePose>& poses, std::set<std::string>& taken) {
  return SuiteWriter(suite, things, rooms, poses, taken).write(tasks);
}

std::string_view scene_of_class(const BddlProblem& problem) {
  const SceneKind* const kind = scene_kind(problem);
  return kind == nullptr ? std::string_view() : kind->scene;
}

}  // namespace probe::libero
