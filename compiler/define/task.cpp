// Tasks and variants: fields copied along `like`, statements over them, then everything that
// follows from the fields.
#include "compiler/define/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "compiler/define/axes.h"
#include "compiler/define/define.h"
#include "compiler/define/fixture.h"
#include "compiler/define/metrics.h"
#include "compiler/define/motion.h"
#include "compiler/define/role.h"
#include "compiler/define/solution.h"
#include "compiler/define/template.h"
#include "compiler/define/thing.h"
#include "compiler/define/views.h"
#include "compiler/define/wording.h"
#include "compiler/names/like.h"
#include "compiler/names/quantities.h"
#include "compiler/syntax/words.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

// `poisoned` tasks have a statement that was reported; what follows from them is not said again.
struct TaskReader {
  Context& context;
  const DeclaredTask& declared;
  Task& task;
  bool& poisoned;

  template <typename Id>
  void field(Id& to, const NameTable& names, const syntax::Name& name) {
    if (const auto found = names.find(name, context.diagnostics)) {
      to = static_cast<Id>(*found);
    } else {
      poisoned = true;
    }
  }
  // An object, or a part or region of a fixture.
  void thing(ObjectId& to, const syntax::Name& name) {
    const auto mistakes = context.mistakes();
    const auto found = find_thing(context, name);
    if (found) to = *found;
    // Of a broken fixture nothing more is said.
    poisoned = poisoned || !found || context.mistakes() != mistakes;
  }
  // A name that a `derive` binds stands for what it is bound to.
  syntax::Name bound(const syntax::Name& name) const {
    for (const Binding& binding : declared.bindings) {
      if (binding.name == name.text) return {name.span, binding.value};
    }
    return name;
  }
  // A number that a `derive` binds; nothing, and P0201, where the name is none.
  std::optional<syntax::Quantity> bound_number(const Span& span, std::string_view binder) {
    std::vector<std::string_view> known;
    for (const Binding& binding : declared.bindings) {
      if (!binding.number) continue;
      known.push_back(binding.name);
      if (binding.name != binder) continue;
      syntax::Quantity number = *binding.number;
      number.span = span;
      return number;
    }
    report_unknown(context.diagnostics, "binder of numbers", {span, binder}, known)
        .help("a number, or a name that a `derive` binds to some: `for t in core, k in 1 .. 4`");
    poisoned = true;
    return std::nullopt;
  }
  std::optional<syntax::Quantity> bound(const syntax::Quantity& written) {
    if (written.binder.empty()) return written;
    return bound_number(written.span, written.binder);
  }
  std::optional<syntax::Int> bound(const syntax::Int& written) {
    if (written.binder.empty()) return written;
    const auto number = bound_number(written.span, written.binder);
    if (!number) return std::nullopt;
    syntax::Int whole{written.span, 0, {}};
    const char* const end = number->digits.data() + number->digits.size();
    const auto read = std::from_chars(number->digits.data(), end, whole.value);
    if (number->unit == syntax::Unit::kNone && !number->negative && read.ec == std::errc() &&
        read.ptr == end)
      return whole;
    context.report(Code::P0302, written.span,
                   "`" + std::string(written.binder) + "` is not bound to whole numbers");
    poisoned = true;
    return std::nullopt;
  }
  // `none` takes what was copied away again.
  void role(RoleId role, const syntax::Name& name) {
    ObjectId& object = role == RoleId::kSource ? task.source : task.target;
    if (name.text == "none" && !context.symbols.objects.peek(name.text)) {
      object = ObjectId::kNone;
    } else {
      thing(object, bound(name));
    }
    task.refer.erase(role);
    task.role_span[static_cast<std::size_t>(role)] = name.span;
  }
  void operator()(const syntax::RoleStmt& stmt) {
    const auto role = find_role(context, stmt.role.text);
    if (!role) {
      std::vector<std::string_view> known = role_names(context);
      for (const syntax::StatementWord& word : syntax::statement_words()) {
        if (word.block == syntax::Block::kTask) known.push_back(word.word);
      }
      report_unknown(context.diagnostics, "role", stmt.role, known)
          .help("a statement that begins with another word fills a role: `role " +
                std::string(stmt.role.text) + "` declares one");
      poisoned = true;
      return;
    }
    task.refer.erase(*role);
    std::erase_if(task.others, [&](const Task::Filled& old) { return old.role == *role; });
    Task::Filled filled{*role, {}, {}, stmt.span};
    for (const syntax::Name& name : stmt.objects) {
      ObjectId object = ObjectId::kNone;
      thing(object, bound(name));
      if (object == ObjectId::kNone) continue;
      if (context.model.roles[*role].is_set && !task.is_object(object)) {
        context
            .report(Code::P1105, name.span,
                    "`" + std::string(name.text) + "` is " +
                        kind_of(context.model.objects[object]) +
                        " of a fixture, and a set is "
                        "filled with objects")
            .label(context.model.roles[*role].span, "declared as a set")
            .help("declare a role for each: `role NAME`");
        poisoned = true;
        continue;
      }
      if (std::find(filled.objects.begin(), filled.objects.end(), object) != filled.objects.end()) {
        context.report(Code::P0203, name.span, "`" + std::string(name.text) + "` is listed twice");
        poisoned = true;
        continue;
      }
      filled.objects.push_back(object);
      filled.spans.push_back(name.span);
    }
    const Role& record = context.model.roles[*role];
    if (!record.is_set && filled.objects.size() > 1) {
      context
          .report(
              Code::P1105, stmt.span,
              "`" + record.name + "` is one object, found " + std::to_string(filled.objects.size()))
          .label(record.span, "write `role " + record.name + ": set` for several");
      poisoned = true;
    }
    if (filled.objects.empty()) return;
    const auto behind = std::find_if(task.others.begin(), task.others.end(),
                                     [&](const Task::Filled& old) { return old.role > *role; });
    task.others.insert(behind, std::move(filled));
  }

  void operator()(const syntax::FieldStmt& stmt) {
    Symbols& symbols = context.symbols;
    switch (stmt.field) {
      case syntax::TaskField::kScene:
        return field(task.scene, symbols.scenes, bound(stmt.value));
      case syntax::TaskField::kSource:
        return role(RoleId::kSource, stmt.value);
      case syntax::TaskField::kTarget:
        return role(RoleId::kTarget, stmt.value);
      case syntax::TaskField::kMetrics:
        return field(task.metrics, symbols.metrics, stmt.value);
      case syntax::TaskField::kLight:
        return field(task.light, symbols.lights, bound(stmt.value));
    }
  }
  void operator()(const syntax::TaskLayoutStmt& stmt) {
    task.layout_span = stmt.layout.span;
    task.clear.clear();
    for (const syntax::ClearPhrase& clear : stmt.clear) {
      const auto role = find_single_role(context, clear.role);
      if (role) task.clear.push_back({*role, spelled(bound(clear.phrase))});
      poisoned = poisoned || !role;
    }
    field(task.layout, context.symbols.layouts, stmt.layout);
  }
  void operator()(const syntax::TaskCameraStmt& stmt) {
    Task::OtherCamera other;
    field(other.camera, context.symbols.cameras, bound(stmt.camera));
    if (other.camera == CameraId::kNone) return;
    if (stmt.as) other.as = spelled(*stmt.as);
    task.cameras.push_back(std::move(other));
  }
  void operator()(const syntax::DistractorsStmt& stmt) {
    task.distractors.clear();
    task.distractor_spans.clear();
    task.distractors_span = stmt.span;
    if (stmt.count) return;  // drawn when the roles are known
    for (const syntax::Name& name : stmt.objects) {
      ObjectId object = ObjectId::kNone;
      field(object, context.symbols.objects, bound(name));
      if (object == ObjectId::kNone) continue;
      if (std::find(task.distractors.begin(), task.distractors.end(), object) !=
          task.distractors.end()) {
        context.report(Code::P0203, name.span, "`" + std::string(name.text) + "` is listed twice");
        poisoned = true;
        continue;
      }
      task.distractors.push_back(object);
      task.distractor_spans.push_back(name.span);
    }
  }
  // So many of these that have no role: every object draws its own number from the seed, its name
  // and the task that this one copies, of variants of variants the first, so that more of them are
  // those and others.
  void draw_distractors(const syntax::DistractorsStmt& stmt) {
    const auto count = bound(*stmt.count), seed = bound(*stmt.seed);
    if (!count || !seed) return;
    std::vector<std::pair<Sha256, ObjectId>> draws;
    const std::vector<ObjectId> taken = task.objects();
    TaskId first = task.like;
    while (first != TaskId::kNone &&
           context.symbols.task_decls[static_cast<std::size_t>(first)].against &&
           context.model.tasks[first].like != TaskId::kNone)
      first = context.model.tasks[first].like;
    const std::string& of = first == TaskId::kNone ? task.name : context.model.tasks[first].name;
    for (const syntax::Name& name : stmt.objects) {
      ObjectId object = ObjectId::kNone;
      field(object, context.symbols.objects, name);
      const auto is_it = [&](const auto& drawn) { return drawn.second == object; };
      if (object == ObjectId::kNone || std::ranges::find(taken, object) != taken.end() ||
          std::ranges::any_of(draws, is_it))
        continue;
      Hasher hasher;
      hasher.text("distractors").u64(seed->value).text(of).text(name.text);
      draws.emplace_back(hasher.finish(), object);
    }
    if (poisoned) return;
    if (count->value > draws.size()) {
      context.report(Situation::kSampleTooLarge, stmt.count->span,
                     std::to_string(count->value) + " of " + std::to_string(draws.size()) +
                         " objects that have no role in `" + task.name + "`");
      poisoned = true;
      return;
    }
    std::ranges::sort(draws);
    draws.resize(count->value);
    for (const auto& [draw, object] : draws) {
      task.distractors.push_back(object);
      task.distractor_spans.push_back(stmt.span);
    }
  }
  void operator()(const syntax::SayStmt& stmt) {
    task.say_span = stmt.span;
    if (const auto* name = std::get_if<syntax::Name>(&stmt.what)) {
      return field(task.say, context.symbols.templates, bound(*name));
    }
    syntax::TemplateText text = std::get<syntax::TemplateText>(stmt.what);
    for (syntax::TemplatePart& part : text.parts) {
      if (auto* slot = std::get_if<syntax::Slot>(&part)) slot->name = bound(slot->name);
    }
    const TemplateId copied = task.say;
    task.say = add_template(context, text, {}, text.text.span, std::nullopt);
    if (copied == TemplateId::kNone) return;
    // The same first word is the same verb, whatever its frame is called.
    const Template& before = context.model.templates[copied];
    Template& now = context.model.templates[task.say];
    if (now.frame == first_word(before.parts)) now.frame = before.frame;
  }
  // After the roles: a new source or target drops what was said of the old one.
  void operator()(const syntax::ReferStmt& stmt) {
    const auto role = find_role(context, stmt.role.text);
    if (!role) {
      report_unknown(context.diagnostics, "role", stmt.role, role_names(context));
      poisoned = true;
      return;
    }
    task.refer[*role] = spelled(bound(stmt.phrase));
  }
  void operator()(const syntax::PoseStmt& stmt) {
    PoseOverride pose;
    field(pose.object, context.symbols.objects, stmt.object);
    pose.span = stmt.object.span;
    const auto turns = read_turns(context, stmt.poses);
    if (!turns || pose.object == ObjectId::kNone) {
      poisoned = true;
      return;
    }
    pose.turns = *turns;
    std::erase_if(task.poses, [&](const PoseOverride& old) { return old.object == pose.object; });
    task.poses.push_back(std::move(pose));
  }
  void operator()(const syntax::StartStmt& stmt) {
    syntax::StartStmt said = stmt;
    if (!stmt.none) {
      const auto value = bound(stmt.value);
      if (!value) return;
      said.value = *value;
    }
    poisoned = !read_start(context, said, task.decl_span, task.joint_starts) || poisoned;
  }
  void operator()(const syntax::HorizonStmt& stmt) {
    task.horizon_span = stmt.span;
    const auto steps = bound(stmt.steps);
    if (!steps) return;
    task.horizon = steps->value;
    if (task.horizon >= 1 && task.horizon <= plan::kMaxHorizon) return;
    context.report(
        Situation::kHorizon, stmt.steps.span,
        "expected a horizon between 1 and " + std::to_string(plan::kMaxHorizon) + " steps");
    poisoned = true;
  }
  void operator()(const syntax::IdleStmt& stmt) {
    const auto steps = bound(stmt.steps);
    if (!steps) return;
    task.idle = static_cast<std::uint32_t>(std::min<std::uint64_t>(steps->value, plan::kMaxIdle));
    if (steps->value <= plan::kMaxIdle) return;
    context.report(
        Situation::kIdleTooLong, stmt.steps.span,
        "expected at most " + std::to_string(plan::kMaxIdle) + " steps of standing still");
    poisoned = true;
  }
  void operator()(const syntax::DelayStmt& stmt) {
    task.delay = 0;
    task.delay_time.reset();
    task.delay_span = stmt.span;
    if (const auto* written = std::get_if<syntax::Int>(&stmt.how_long)) {
      const auto steps = bound(*written);
      if (!steps) return;
      task.delay =
          static_cast<std::uint32_t>(std::min<std::uint64_t>(steps->value, plan::kMaxDelay));
      if (steps->value <= plan::kMaxDelay) return;
      context.report(Situation::kDelay, steps->span,
                     "expected at most " + std::to_string(plan::kMaxDelay) + " steps");
      poisoned = true;
      return;
    }
    // How many steps that are depends on the robot.
    const auto time = bound(std::get<syntax::Quantity>(stmt.how_long));
    if (!time) return;
    task.delay_time =
        read_quantity(context, *time, dim::kTime, "`delay` takes a number of steps, or a time");
    poisoned = poisoned || !task.delay_time;
  }
  void operator()(const syntax::MovesStmt& stmt) {
    std::optional<syntax::Quantity> speed = stmt.speed;
    if (!stmt.points.empty()) speed = bound(stmt.speed);
    if (!speed) return;
    auto motion = read_motion(context, stmt, *speed);
    poisoned = poisoned || !motion;
    if (!motion) return;
    motion->what = spelled(bound(stmt.what));
    std::erase_if(task.motions,
                  [&](const Motion& old) { return old.what.text == motion->what.text; });
    if (!motion->points.empty()) task.motions.push_back(std::move(*motion));
  }
  void operator()(const syntax::SolutionStmt& stmt) {
    const auto solution =
        read_solution(context, stmt, [this](const syntax::Name& name) { return bound(name); });
    poisoned = poisoned || !solution;
    if (solution) task.solution = *solution;
  }
  void operator()(const syntax::MetricStmt& stmt) {
    Metric metric = read_metric(context, *declared.file, stmt);
    poisoned = poisoned || metric.type.kind == TypeKind::kPoison;
    std::erase_if(task.overrides, [&](const Metric& old) { return old.name == metric.name; });
    task.overrides.push_back(std::move(metric));
  }
};

// Every object that fills the role has the phrase.
void check_refer(Context& context, const Task& task, RoleId role, const Spelled& refer,
                 bool& poisoned) {
  for (const ObjectId id : task.objects_in(role)) {
    const Object& object = context.model.objects[id];
    if (object.find_phrase(refer.text) != nullptr) continue;
    std::vector<std::string_view> candidates;
    for (const Phrase& phrase : object.phrases) candidates.push_back(phrase.name);
    report_unknown(context.diagnostics, "phrase of `" + object.name + "`", {refer.span, refer.text},
                   candidates)
        .label(object.span, "the object");
    poisoned = true;
    return;
  }
}

// A record with a mistake of its own: what it does to the task is not said.
bool has_broken_part(const Model& model, const Task& task) {
  const auto is_broken = [](const auto& table, auto id) {
    return id != decltype(id)::kNone && table[id].broken;
  };
  if (is_broken(model.layouts, task.layout) || is_broken(model.metrics, task.metrics) ||
      is_broken(model.templates, task.say))
    return true;
  for (const Task::OtherCamera& other : task.cameras) {
    if (is_broken(model.cameras, other.camera)) return true;
  }
  if (task.scene != SceneId::kNone) {
    for (const View& view : model.scenes[task.scene].views) {
      if (is_broken(model.cameras, view.camera)) return true;
    }
  }
  const std::vector<ObjectId> objects = task.objects();
  return std::any_of(objects.begin(), objects.end(),
                     [&](ObjectId id) { return is_broken(model.objects, id); });
}

// One object in one place: a scene with two of a kind needs a second declaration with `like`.
void check_roles(Context& context, const Task& task, bool& poisoned) {
  std::vector<ObjectId> seen;
  for (const ObjectId id : task.objects()) {
    if (std::find(seen.begin(), seen.end(), id) != seen.end()) {
      context.report(Code::P0203, task.span,
                     "`" + context.model.objects[id].name + "` stands twice in the scene of `" +
                         task.name + "`");
      poisoned = true;
    }
    seen.push_back(id);
  }
}

// What a part or a region that fills a role belongs to is in the scene, and fills one role.
void check_things(Context& context, const Task& task, bool& poisoned) {
  const Model& model = context.model;
  const Scene& scene = model.scenes[task.scene];
  std::vector<ObjectId> seen;
  for (const auto& [role, id] : task.things()) {
    const Object& object = model.objects[id];
    poisoned = poisoned || object.broken;
    if (std::ranges::find(seen, id) != seen.end()) {
      context.report(Code::P0203, task.span,
                     "`" + object.name + "` fills two roles of `" + task.name + "`");
      poisoned = true;
    }
    seen.push_back(id);
    if (std::ranges::find(scene.fixtures, object.of->fixture) != scene.fixtures.end()) continue;
    const Fixture& fixture = model.fixtures[object.of->fixture];
    const std::size_t of_two = static_cast<std::size_t>(role);
    Span span = of_two < 2 ? task.role_span[of_two] : task.span;
    for (const Task::Filled& filled : task.others) {
      if (filled.role == role) span = filled.spans.front();
    }
    context
        .report(Situation::kNotInScene, span,
                "fixture `" + fixture.name + "` is not in scene `" + scene.name + "` of `" +
                    task.name + "`")
        .label(scene.span, "the scene")
        .help("a scene names its fixtures: `fixture " + fixture.name + "`");
    poisoned = true;
  }
}

// A time in control steps of the task's robot.
void count_delay(Context& context, Task& task, bool& poisoned) {
  if (!task.delay_time) return;
  const double rate = context.model.robots[context.model.scenes[task.scene].robot].control_hz;
  const double steps = task.delay_time->si() * rate, whole = std::nearbyint(steps);
  if (whole >= 0 && whole <= plan::kMaxDelay && std::abs(steps - whole) <= 1e-9 * whole) {
    task.delay = static_cast<std::uint32_t>(whole);
    return;
  }
  poisoned = true;
  Diagnostic& said =
      context.report(Situation::kDelay, task.delay_span,
                     fmt::format("expected a whole number of control steps up to {}, found {:.6g}",
                                 plan::kMaxDelay, steps));
  if (rate > 0) said.help(fmt::format("a control step is {:.6g}ms here", 1000 / rate));
}

// A joint that begins somewhere is in the scene.
void check_joint_starts(Context& context, const Task& task, bool& poisoned) {
  const Scene& scene = context.model.scenes[task.scene];
  const std::vector<JointStart>* said[] = {&context.model.layouts[task.layout].joint_starts,
                                           &task.joint_starts};
  for (const std::vector<JointStart>* starts : said) {
    for (const JointStart& start : *starts) {
      if (std::ranges::find(scene.fixtures, start.fixture) != scene.fixtures.end()) continue;
      context
          .report(Code::P0201, start.span,
                  "fixture `" + context.model.fixtures[start.fixture].name + "` is not in scene `" +
                      scene.name + "` of `" + task.name + "`")
          .label(scene.span, "the scene");
      poisoned = true;
    }
  }
  const Layout& layout = context.model.layouts[task.layout];
  if (layout.given_joints.empty()) return;
  for (const GivenJoint& given : layout.given_joints.front()) {
    const bool is_arm = given.robot != RobotId::kNone;
    if (is_arm ? given.robot == scene.robot
               : std::ranges::find(scene.fixtures, given.fixture) != scene.fixtures.end())
      continue;
    const std::string name = is_arm ? "robot `" + context.model.robots[given.robot].name
                                    : "fixture `" + context.model.fixtures[given.fixture].name;
    context
        .report(Code::P0201, given.what.span,
                name + "` is not in scene `" + scene.name + "` of `" + task.name + "`")
        .label(scene.span, "the scene");
    poisoned = true;
    return;
  }
}

// What a task's camera takes the place of must be there, and a camera moves with a link, so that
// link must be in the scene.
void check_cameras(Context& context, const Task& task, bool& poisoned) {
  const Scene& scene = context.model.scenes[task.scene];
  for (const Task::OtherCamera& other : task.cameras) {
    if (!other.as || view_named(scene, other.as->text) != nullptr) continue;
    std::vector<std::string_view> names;
    for (const View& view : scene.views) names.push_back(view.name);
    report_unknown(context.diagnostics, "view", {other.as->span, other.as->text}, names)
        .label(scene.span, "the scene of `" + task.name + "`");
    poisoned = true;
  }
  for (const View& view : views_of(context.model, task)) {
    const Camera& camera = context.model.cameras[view.camera];
    if (camera.mount_robot == scene.robot) continue;
    context
        .report(Situation::kOtherRobot, task.span,
                "camera `" + camera.name + "` of `" + task.name +
                    "` is mounted on a robot that is not in scene `" + scene.name + "`")
        .label(camera.mount_link.span, "this link");
    poisoned = true;
  }
}

// A task needs the roles that its words, metrics and layout speak of, once it has those.
std::string missing_statements(const Task& task) {
  const bool is_free = !task.abstract && task.layout != LayoutId::kNone &&
                       task.metrics != MetricsId::kNone && task.say != TemplateId::kNone;
  const std::pair<bool, const char*> wanted[] = {
      {task.scene != SceneId::kNone, "scene"},
      {task.layout != LayoutId::kNone, "layout"},
      {task.source != ObjectId::kNone || is_free, "source"},
      {task.target != ObjectId::kNone || is_free, "target"},
      {task.metrics != MetricsId::kNone, "metrics"},
      {task.say != TemplateId::kNone, "say"},
      {task.horizon != 0, "horizon"},
  };
  std::string missing;
  for (const auto& [there, name] : wanted) {
    if (!there) missing += (missing.empty() ? "`" : ", `") + std::string(name) + "`";
  }
  return missing;
}

// Objects that the layout places by name belong to the scene, whether they have a role or not.
void place_by_name(Context& context, Task& task) {
  task.placed.clear();
  if (task.layout == LayoutId::kNone) return;
  const auto add = [&](const Spelled& word) {
    const auto object = context.symbols.objects.peek(word.text);
    if (word.text == "distractors" || find_role(context, word.text) || !object) return;
    const auto id = static_cast<ObjectId>(*object);
    const std::vector<ObjectId> known = task.objects();
    if (std::find(known.begin(), known.end(), id) == known.end()) task.placed.push_back(id);
  };
  const Layout& layout = context.model.layouts[task.layout];
  for (const Place& line : layout.places) std::for_each(line.what.begin(), line.what.end(), add);
  // Every start of a file has the same objects.
  if (layout.given.empty()) return;
  for (const GivenPlace& place : layout.given.front()) add(place.what);
}

std::vector<Metric> judged_metrics(const Model& model, const Task& task) {
  std::vector<Metric> metrics = model.metrics[task.metrics].items;
  for (const Metric& metric : task.overrides) {
    const auto at = std::find_if(metrics.begin(), metrics.end(),
                                 [&](const Metric& old) { return old.name == metric.name; });
    if (at != metrics.end()) {
      *at = metric;
    } else {
      metrics.push_back(metric);
    }
  }
  return metrics;
}

// A comparison is each task's own; what is allowed of a text holds for the tasks that keep it.
void read_allows(const syntax::Decl& decl, const std::vector<syntax::TaskStmt>& body, Task& task) {
  task.allow_confounded.reset();
  const auto says = [](const syntax::TaskStmt& stmt) {
    return std::holds_alternative<syntax::SayStmt>(stmt);
  };
  task.keeps_absent =
      (task.allow_absent || task.keeps_absent) && std::none_of(body.begin(), body.end(), says);
  task.allow_absent = false;
  for (const syntax::Allow& allow : decl.allows) {
    const auto code = code_from_slug(allow.what.text);
    if (code == Code::P0701) {
      task.allow_confounded = allow.reason.value;
    } else if (code == Code::P0404) {
      task.allow_absent = true;
    }
  }
}

}  // namespace

std::vector<Turn> rest_of(const Model& model, const Task& task, ObjectId object) {
  for (const PoseOverride& pose : task.poses) {
    if (pose.object == object) return pose.turns;
  }
  return model.objects[object].rest;
}

std::string objects_text(const Model& model, const Task& task) {
  std::string text;
  for (const ObjectId id : task.objects())
    text += (text.empty() ? "" : ", ") + model.objects[id].name;
  return text;
}

std::optional<Span> entry_of(const Task& task, ObjectId object) {
  const auto own = [&](const Span& span) {
    return !span.is_none() && is_within(span, task.decl_span);
  };
  if (object == task.source && own(task.role_span[0])) return task.role_span[0];
  if (object == task.target && own(task.role_span[1])) return task.role_span[1];
  for (const Task::Filled& filled : task.others) {
    for (std::size_t i = 0; i < filled.objects.size(); ++i) {
      if (filled.objects[i] == object && own(filled.spans[i])) return filled.spans[i];
    }
  }
  for (std::size_t i = 0; i < task.distractors.size() && i < task.distractor_spans.size(); ++i) {
    if (task.distractors[i] == object && own(task.distractor_spans[i]))
      return task.distractor_spans[i];
  }
  return std::nullopt;
}

TaskTable::TaskTable(Context& context) : context_(context), mentioned_(context.model) {
  for (std::size_t i = 0; i < context.symbols.task_decls.size(); ++i) add_row();
}

void TaskTable::add_row() {
  context_.model.tasks.add({});
  poison_.push_back(false);
  defined_.push_back(false);
}

void TaskTable::define(std::uint32_t index, std::optional<std::uint32_t> parent) {
  const DeclaredTask& declared = context_.symbols.task_decls[index];
  Model& model = context_.model;
  Task task;
  bool poisoned = !declared.decl->complete || (declared.like && !parent);
  if (parent) {
    task = model.tasks[static_cast<TaskId>(*parent)];
    poisoned = poisoned || poison_[*parent];
  }
  task.name = std::string(declared.name.text);
  task.span = declared.name.span;
  task.decl_span = declared.decl->span;
  task.file = declared.file->id;
  task.abstract = declared.abstract;
  task.derived = declared.derived;
  task.like = parent ? static_cast<TaskId>(*parent) : TaskId::kNone;
  task.baseline = TaskId::kNone;
  task.axes = 0;
  task.declared_objects = static_cast<std::uint32_t>(context_.symbols.objects.names().size());
  const About about(context_.reporter, task.decl_span);
  read_allows(*declared.decl, *declared.body, task);
  TaskReader reader{context_, declared, task, poisoned};
  for (const syntax::TaskStmt& stmt : *declared.body) {
    if (!std::holds_alternative<syntax::ReferStmt>(stmt)) std::visit(reader, stmt);
  }
  for (const syntax::TaskStmt& stmt : *declared.body) {
    if (std::holds_alternative<syntax::ReferStmt>(stmt)) std::visit(reader, stmt);
    const auto* drawn = std::get_if<syntax::DistractorsStmt>(&stmt);
    if (drawn != nullptr && drawn->count) reader.draw_distractors(*drawn);
  }
  poisoned = poisoned || has_broken_part(model, task);
  for (const auto& [role, refer] : task.refer) {
    if (!poisoned) check_refer(context_, task, role, refer, poisoned);
  }
  for (const ClearPhrase& clear : task.clear) {
    if (!poisoned) check_refer(context_, task, clear.role, clear.phrase, poisoned);
  }
  place_by_name(context_, task);
  const std::string missing = missing_statements(task);
  if (task.scene != SceneId::kNone) poisoned = poisoned || model.scenes[task.scene].broken;
  task.complete = missing.empty() && !poisoned;
  if (task.complete) {
    task.judged = judged_metrics(model, task);
    task.complete = task.abstract || check_filled(task, poisoned);
  }
  if (task.complete) check_roles(context_, task, poisoned);
  if (task.complete) check_things(context_, task, poisoned);
  if (task.complete) check_cameras(context_, task, poisoned);
  if (task.complete) check_joint_starts(context_, task, poisoned);
  if (task.complete) count_delay(context_, task, poisoned);
  if (task.complete && !task.abstract && task.delay >= task.horizon && task.delay > 0) {
    context_
        .report(Situation::kDelay, task.delay_span,
                fmt::format("an action that is {} steps late never acts in the {} steps of `{}`",
                            task.delay, task.horizon, task.name))
        .label(task.horizon_span, "the horizon");
    poisoned = true;
  }
  if (task.complete && !task.abstract) poisoned = !check_motions(context_, task) || poisoned;
  if (task.complete && !task.abstract) poisoned = !check_solution(context_, task) || poisoned;
  if (!missing.empty() && !poisoned && !task.abstract) report_missing(task, missing);
  task.complete = task.complete && !poisoned;
  poison_[index] = poisoned;
  defined_[index] = true;
  if (task.complete) {
    task.prompt = render_prompt(model, task);
    task.ood = out_of_distribution(model, task);
  }
  model.tasks[static_cast<TaskId>(index)] = std::move(task);
}

// Who is spoken of fills a role, and who fills a declared role is spoken of.
bool TaskTable::check_filled(const Task& task, bool& poisoned) {
  const Model& model = context_.model;
  bool is_complete = true;
  std::string missing;                                    // of source and target
  std::map<RoleId, std::pair<Span, const char*>> spoken;  // with how the task comes to it
  for (const Template::Part& part : model.templates[task.say].parts) {
    if (part.slot && part.slot->role != RoleId::kNone)
      spoken.try_emplace(part.slot->role, part.slot->span, "its words speak of it");
  }
  for (const auto& [role, span] : mentioned_.metrics(task.judged).roles)
    spoken.try_emplace(role, span, "its metrics measure it");
  const auto in_words = spoken;
  const auto place = [&](const Spelled& word) {
    if (const auto role = find_role(model, word.text))
      spoken.try_emplace(*role, word.span, "its layout places it");
  };
  const Layout& layout = model.layouts[task.layout];
  for (const Place& line : layout.places) {
    std::for_each(line.what.begin(), line.what.end(), place);
    if (line.is_put()) place(line.where);
  }
  for (const Orient& line : layout.orients) place(line.what);
  for (const ClearPhrase& clear : task.clear)
    spoken.try_emplace(clear.role, clear.phrase.span, "its starts are chosen by it");
  for (const auto& [role, where] : spoken) {
    if (!task.objects_in(role).empty()) continue;
    is_complete = false;
    const std::string& name = model.roles[role].name;
    if (role == RoleId::kSource || role == RoleId::kTarget) {
      missing += (missing.empty() ? "`" : ", `") + name + "`";
      continue;
    }
    poisoned = true;
    context_
        .report(Code::P1102, task.span,
                "nothing fills role `" + name + "` in task `" + task.name + "`")
        .label(where.first, where.second)
        .help("write `" + name + " OBJECT`");
  }
  if (Diagnostic* said = missing.empty() ? nullptr : report_missing(task, missing)) {
    for (const RoleId role : {RoleId::kSource, RoleId::kTarget}) {
      const auto where = spoken.find(role);
      if (where != spoken.end() && task.objects_in(role).empty())
        said->label(where->second.first, where->second.second);
    }
  }
  // A layout puts objects somewhere; a part is where its fixture is.
  const auto moves = [&](const Spelled& word) {
    const auto role = find_role(model, word.text);
    for (const ObjectId id : role ? task.objects_in(*role) : std::vector<ObjectId>()) {
      if (task.is_object(id)) continue;
      poisoned = true;
      context_
          .report(Code::P1106,
                  *role < RoleId{2} ? task.role_span[static_cast<std::size_t>(*role)] : task.span,
                  "layout `" + layout.name + "` places `" + word.text + "`, which is `" +
                      model.objects[id].name + "` in `" + task.name + "`")
          .label(word.span, std::string("placed here; ") + kind_of(model.objects[id]) +
                                " of a fixture stands where that does")
          .help("write a layout that places the others alone");
    }
  };
  for (const Place& line : layout.places) std::for_each(line.what.begin(), line.what.end(), moves);
  for (const Orient& line : layout.orients) moves(line.what);
  if (!layout.given.empty()) {
    for (const GivenPlace& given : layout.given.front()) moves(given.what);
  }
  for (const Task::Filled& filled : task.others) {
    if (in_words.contains(filled.role) || !is_within(filled.span, task.decl_span)) continue;
    poisoned = true;
    context_
        .report(Code::P1103, filled.span,
                "neither the words nor the metrics of task `" + task.name + "` speak of `" +
                    model.roles[filled.role].name + "`")
        .help(task.is_object(filled.objects.front())
                  ? "what only lies there is a distractor: `distractors " +
                        model.objects[filled.objects.front()].name + "`"
                  : std::string("leave it out: a fixture's parts are there without a role"));
  }
  return is_complete && !poisoned;
}

// What a task lacks, its copies lack: said of the first, and once for the copies of an abstract
// one.
Diagnostic* TaskTable::report_missing(const Task& task, const std::string& missing) {
  const bool is_copy = task.like != TaskId::kNone;
  if (is_copy && !context_.model.tasks[task.like].abstract &&
      !context_.model.tasks[task.like].complete)
    return nullptr;
  const auto [first, is_new] = missing_.try_emplace({task.like, missing}, nullptr);
  if (is_new || !is_copy) {
    first->second = &context_.report(Situation::kStatementMissing, task.span,
                                     "task `" + task.name + "` has no " + missing);
    return first->second;
  }
  if (first->second->notes.empty()) {
    first->second->note("nor has any other task that lacks it and is `like " +
                        context_.model.tasks[task.like].name + "`");
  }
  return nullptr;
}

void TaskTable::compare(std::uint32_t index, bool last_chance) {
  const DeclaredTask& declared = context_.symbols.task_decls[index];
  Task& task = context_.model.tasks[static_cast<TaskId>(index)];
  if (!declared.against) return;
  if (task.baseline == TaskId::kNone) {
    auto baseline = context_.symbols.tasks.peek(declared.against->text);
    // A `variant of` names its baseline once; when unknown it has been reported as `like`.
    const bool reported = declared.like && task.like == TaskId::kNone &&
                          declared.against->span == declared.like->span;
    if (!baseline && last_chance && !reported)
      baseline = context_.symbols.tasks.find(*declared.against, context_.diagnostics);
    if (baseline) task.baseline = static_cast<TaskId>(*baseline);
    task.baseline_span = declared.against->span;
  }
  if (task.complete && task.baseline != TaskId::kNone &&
      context_.model.tasks[task.baseline].complete) {
    task.axes = axes_between(context_.model, task, context_.model.tasks[task.baseline]);
  }
}

namespace {

// Every member of a circle loses its baseline, so that later passes can walk to a root.
void break_cycles(Context& context) {
  Model& model = context.model;
  std::vector<bool> safe(model.tasks.size(), false);
  for (std::size_t start = 0; start < model.tasks.size(); ++start) {
    std::vector<TaskId> chain;
    TaskId at = static_cast<TaskId>(start);
    while (at != TaskId::kNone && !safe[static_cast<std::size_t>(at)] &&
           std::find(chain.begin(), chain.end(), at) == chain.end()) {
      chain.push_back(at);
      at = model.tasks[at].baseline;
    }
    if (at != TaskId::kNone && !safe[static_cast<std::size_t>(at)]) {
      const Task& task = model.tasks[at];
      context.report(Situation::kBaselineCircle, task.baseline_span,
                     "task `" + task.name + "` is compared with itself over its baselines");
      for (auto member = std::find(chain.begin(), chain.end(), at); member != chain.end();
           ++member) {
        model.tasks[*member].baseline = TaskId::kNone;
      }
    }
    for (const TaskId id : chain) safe[static_cast<std::size_t>(id)] = true;
  }
}

}  // namespace

void define_tasks(Context& context) {
  for (std::size_t i = 0; i < context.symbols.set_decls.size(); ++i) context.model.sets.add({});
  TaskTable table(context);
  const std::size_t written = context.symbols.task_decls.size();
  const bool derives = !context.symbols.derive_decls.empty();
  std::vector<std::optional<std::uint32_t>> parents(written);
  std::vector<bool> later(written, false);  // copies a task that a `derive` may still make
  for (std::size_t i = 0; i < written; ++i) {
    const DeclaredTask& declared = context.symbols.task_decls[i];
    if (!declared.like) continue;
    parents[i] = context.symbols.tasks.peek(declared.like->text);
    later[i] = derives && !parents[i];
    if (!parents[i] && !derives) context.symbols.tasks.find(*declared.like, context.diagnostics);
  }
  const auto order = parents_first(context, parents, context.symbols.tasks.names());
  for (const std::uint32_t i : order) {
    if (parents[i] && later[*parents[i]]) later[i] = true;
    if (!later[i]) table.define(i, parents[i]);
  }
  for (std::uint32_t i = 0; i < written; ++i) {
    if (!later[i]) table.compare(i, !derives);
  }
  if (derives) {
    expand_derives(context, table);
    for (const std::uint32_t i : order) {
      if (!later[i]) continue;
      const DeclaredTask& declared = context.symbols.task_decls[i];
      if (!parents[i]) parents[i] = context.symbols.tasks.find(*declared.like, context.diagnostics);
      table.define(i, parents[i]);
    }
    for (std::uint32_t i = 0; i < written; ++i) table.compare(i, true);
  }
  break_cycles(context);
}

}  // namespace probe::sema
