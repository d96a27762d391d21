#include "compiler/define/task_statements.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "compiler/define/fixture.h"
#include "compiler/define/metrics.h"
#include "compiler/define/motion.h"
#include "compiler/define/replaced.h"
#include "compiler/define/role.h"
#include "compiler/define/scene.h"
#include "compiler/define/solution.h"
#include "compiler/define/telling.h"
#include "compiler/define/template.h"
#include "compiler/define/thing.h"
#include "compiler/define/wording.h"
#include "compiler/names/quantities.h"
#include "compiler/syntax/words.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

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
      if (context.model.roles[*role].is_set && !fits_set(name, object, filled.objects, *role))
        continue;
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

  // A set is filled with objects, or with parts.
  bool fits_set(const syntax::Name& name, ObjectId id, const std::vector<ObjectId>& others,
                RoleId role) {
    const Object& object = context.model.objects[id];
    const bool is_region = object.of && !object.of->is_part();
    const bool is_mixed = !others.empty() && task.is_object(others.front()) != task.is_object(id);
    if (!is_region && !is_mixed) return true;
    const std::string what = "`" + std::string(name.text) + "` is " + kind_of(object) +
                             (object.of ? " of a fixture" : "");
    context
        .report(Code::P1105, name.span,
                what + (is_region ? ", and a set is filled with objects or with parts"
                                  : ", and what stands before it is " +
                                        std::string(kind_of(context.model.objects[others.front()]))))
        .label(context.model.roles[role].span, "declared as a set")
        .help("declare a role for each: `role NAME`");
    poisoned = true;
    return false;
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
  void operator()(const syntax::TaskSceneStmt& stmt) {
    if (stmt.scene) field(task.scene, context.symbols.scenes, bound(*stmt.scene));
    if (poisoned) return;
    if (task.scene == SceneId::kNone) {
      context
          .report(Situation::kStatementMissing, stmt.span,
                  "task `" + task.name + "` has no scene that this changes")
          .help("name it: `scene NAME { .. }`");
      poisoned = true;
      return;
    }
    // What the block does not speak of makes no other scene.
    std::string bindings;
    const std::string_view said = context.sources.text(stmt.span);
    for (const Binding& binding : declared.bindings) {
      if (says_word(said, binding.name))
        bindings += std::string(binding.name) + "=" + std::string(binding.value) + ";";
    }
    task.scene = change_scene(
        context, task.scene, stmt, [this](const syntax::Name& name) { return bound(name); },
        bindings);
    poisoned = poisoned || context.model.scenes[task.scene].broken;
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
    task.part_distractors.clear();
    task.part_distractor_spans.clear();
    task.distractors_span = stmt.span;
    if (stmt.count) return;  // drawn when the roles are known
    for (const syntax::Name& name : stmt.objects) {
      ObjectId object = ObjectId::kNone;
      thing(object, bound(name));
      if (object == ObjectId::kNone) continue;
      const bool is_object = task.is_object(object);
      auto& listed = is_object ? task.distractors : task.part_distractors;
      if (std::ranges::find(listed, object) != listed.end()) {
        context.report(Code::P0203, name.span, "`" + std::string(name.text) + "` is listed twice");
        poisoned = true;
        continue;
      }
      if (!is_object && !context.model.objects[object].of->is_part()) {
        context
            .report(Code::P1105, name.span,
                    "`" + std::string(name.text) +
                        "` is a region of a fixture, and distractors are objects and parts")
            .help("name the part that it belongs to");
        poisoned = true;
        continue;
      }
      listed.push_back(object);
      (is_object ? task.distractor_spans : task.part_distractor_spans).push_back(name.span);
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
    say(task.say, stmt.what);
  }
  // `to` has what was copied.
  void say(TemplateId& to, const std::variant<syntax::Name, syntax::TemplateText>& what) {
    if (const auto* name = std::get_if<syntax::Name>(&what)) {
      return field(to, context.symbols.templates, bound(*name));
    }
    syntax::TemplateText text = std::get<syntax::TemplateText>(what);
    for (syntax::TemplatePart& part : text.parts) {
      if (auto* slot = std::get_if<syntax::Slot>(&part)) slot->name = bound(slot->name);
    }
    const TemplateId copied = to;
    to = add_template(context, text, {}, text.text.span, std::nullopt);
    if (copied == TemplateId::kNone) return;
    // The same first word is the same verb, whatever its frame is called.
    const Template& before = context.model.templates[copied];
    Template& now = context.model.templates[to];
    if (now.frame == first_word(before.parts)) now.frame = before.frame;
  }
  // Those of one task are all that it says later: what was copied goes with the first.
  std::optional<std::vector<LaterSentence>> copied_later = std::nullopt;
  void operator()(const syntax::ThenStmt& stmt) {
    if (!copied_later) copied_later = std::exchange(task.later, {});
    if (!stmt.what) return;
    LaterSentence later;
    const std::size_t at = task.later.size();
    if (at < copied_later->size()) later.say = (*copied_later)[at].say;
    later.say_span = stmt.span;
    say(later.say, *stmt.what);
    syntax::MetricStmt when;
    when.span = stmt.span;
    when.name = {stmt.when_span, kWhenMetric};
    when.readout = {stmt.when_span, plan::Readout::kAtEnd, stmt.when_span, stmt.when};
    later.when = read_metric(context, *declared.file, when);
    poisoned = poisoned || later.when.type.kind == TypeKind::kPoison;
    task.later.push_back(std::move(later));
  }
  // After the roles: a new source or target drops what was said of the old one.
  void operator()(const syntax::ReferStmt& stmt) {
    const auto role = find_role(context, stmt.role.text);
    if (!role) {
      report_unknown(context.diagnostics, "role", stmt.role, role_names(context));
      poisoned = true;
      return;
    }
    // `none` takes what was copied away again.
    const Spelled phrase = spelled(bound(stmt.phrase));
    const auto has_it = [&](const Object& object) {
      return object.find_phrase(phrase.text) != nullptr;
    };
    if (phrase.text == "none" && std::ranges::none_of(context.model.objects, has_it)) {
      task.refer.erase(*role);
      return;
    }
    task.refer[*role] = phrase;
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
    task.horizon_time.reset();
    if (const auto* written = std::get_if<syntax::Int>(&stmt.how_long)) {
      const auto steps = bound(*written);
      if (!steps) return;
      task.horizon = steps->value;
      if (task.horizon >= 1 && task.horizon <= plan::kMaxHorizon) return;
      context.report(
          Situation::kHorizon, written->span,
          "expected a horizon between 1 and " + std::to_string(plan::kMaxHorizon) + " steps");
      poisoned = true;
      return;
    }
    // How many steps that are depends on the robot.
    task.horizon = 0;
    const auto time = bound(std::get<syntax::Quantity>(stmt.how_long));
    if (!time) return;
    if (time->unit == syntax::Unit::kNone) {
      const std::string number(context.sources.text(time->span));
      context.report(Code::P0302, time->span, "expected a time or `steps`, found a number")
          .help("write `" + number + " steps`, or a time with its unit: `12s`");
      poisoned = true;
      return;
    }
    task.horizon_time = read_quantity(context, *time, dim::kTime,
                                      "`horizon` takes a time, or a number of `steps`");
    poisoned = poisoned || !task.horizon_time;
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

}  // namespace

void read_statements(Context& context, const DeclaredTask& declared, Task& task, bool& poisoned) {
  TaskReader reader{context, declared, task, poisoned};
  const auto is_scene = [](const syntax::TaskStmt& stmt) {
    const auto* field = std::get_if<syntax::FieldStmt>(&stmt);
    return std::holds_alternative<syntax::TaskSceneStmt>(stmt) ||
           (field != nullptr && field->field == syntax::TaskField::kScene);
  };
  // What was copied follows its fixtures; what the task says itself is of what stands there.
  for (const syntax::TaskStmt& stmt : *declared.body) {
    if (is_scene(stmt)) std::visit(reader, stmt);
  }
  if (!poisoned) follow_fixtures(context.model, task);
  for (const syntax::TaskStmt& stmt : *declared.body) {
    if (!is_scene(stmt) && !std::holds_alternative<syntax::ReferStmt>(stmt))
      std::visit(reader, stmt);
  }
  for (const syntax::TaskStmt& stmt : *declared.body) {
    if (std::holds_alternative<syntax::ReferStmt>(stmt)) std::visit(reader, stmt);
    const auto* drawn = std::get_if<syntax::DistractorsStmt>(&stmt);
    if (drawn != nullptr && drawn->count) reader.draw_distractors(*drawn);
  }
}

}  // namespace probe::sema
