// Tasks and variants: fields copied along `like`, statements over them, then everything that
// follows from the fields.
#include <algorithm>

#include "compiler/sema/axes.h"
#include "compiler/sema/judgement.h"
#include "compiler/sema/language.h"
#include "compiler/sema/layouts.h"
#include "compiler/sema/passes.h"

namespace probe::sema {
namespace {

// `poisoned` tasks have a statement that was reported; what follows from them is not said again.
struct TaskReader {
  Context& context;
  const syntax::File& file;
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
  void role(std::size_t index, const syntax::Name& name) {
    field(index == 0 ? task.source : task.target, context.symbols.objects, name);
    task.refer[index].reset();
    task.role_span[index] = name.span;
  }

  void operator()(const syntax::FieldStmt& stmt) {
    Symbols& symbols = context.symbols;
    switch (stmt.field) {
      case syntax::TaskField::kScene:
        return field(task.scene, symbols.scenes, stmt.value);
      case syntax::TaskField::kLayout:
        task.layout_span = stmt.value.span;
        return field(task.layout, symbols.layouts, stmt.value);
      case syntax::TaskField::kSource:
        return role(0, stmt.value);
      case syntax::TaskField::kTarget:
        return role(1, stmt.value);
      case syntax::TaskField::kMetrics:
        return field(task.metrics, symbols.metrics, stmt.value);
      case syntax::TaskField::kLight:
        return field(task.light, symbols.lights, stmt.value);
      case syntax::TaskField::kCamera:
        return field(task.camera, symbols.cameras, stmt.value);
    }
  }
  void operator()(const syntax::DistractorsStmt& stmt) {
    task.distractors.clear();
    task.distractors_span = stmt.span;
    for (const syntax::Name& name : stmt.objects) {
      ObjectId object = ObjectId::kNone;
      field(object, context.symbols.objects, name);
      if (object == ObjectId::kNone) continue;
      if (std::find(task.distractors.begin(), task.distractors.end(), object) !=
          task.distractors.end()) {
        context.report(Code::P0203, name.span, "`" + std::string(name.text) + "` is listed twice");
        poisoned = true;
        continue;
      }
      task.distractors.push_back(object);
    }
  }
  void operator()(const syntax::SayStmt& stmt) {
    task.say_span = stmt.span;
    if (const auto* name = std::get_if<syntax::Name>(&stmt.what)) {
      return field(task.say, context.symbols.templates, *name);
    }
    const auto& text = std::get<syntax::TemplateText>(stmt.what);
    task.say = add_template(context, text, {}, text.text.span, std::nullopt);
  }
  // After the roles: a new source or target drops what was said of the old one.
  void operator()(const syntax::ReferStmt& stmt) {
    const std::size_t index = stmt.role == syntax::Role::kSource ? 0 : 1;
    task.refer[index] = spelled(stmt.phrase);
  }
  void operator()(const syntax::PoseStmt& stmt) {
    PoseOverride pose;
    field(pose.object, context.symbols.objects, stmt.object);
    const auto turns = read_turns(context, stmt.poses);
    if (!turns || pose.object == ObjectId::kNone) {
      poisoned = true;
      return;
    }
    pose.turns = *turns;
    std::erase_if(task.poses, [&](const PoseOverride& old) { return old.object == pose.object; });
    task.poses.push_back(std::move(pose));
  }
  void operator()(const syntax::HorizonStmt& stmt) {
    task.horizon_span = stmt.span;
    task.horizon = stmt.steps.value;
    if (task.horizon >= 1 && task.horizon <= 100000) return;
    context.report(Code::P0304, stmt.steps.span, "expected a horizon between 1 and 100000 steps");
    poisoned = true;
  }
  void operator()(const syntax::MetricStmt& stmt) {
    Metric metric = analyze_metric(context, file, stmt);
    std::erase_if(task.overrides, [&](const Metric& old) { return old.name == metric.name; });
    task.overrides.push_back(std::move(metric));
  }
};

void check_refer(Context& context, Task& task, std::size_t role, bool& poisoned) {
  const ObjectId id = role == 0 ? task.source : task.target;
  if (!task.refer[role] || id == ObjectId::kNone) return;
  const Object& object = context.model.objects[id];
  if (object.find_phrase(task.refer[role]->text) != nullptr) return;
  std::vector<std::string_view> candidates;
  for (const Phrase& phrase : object.phrases) candidates.push_back(phrase.name);
  report_unknown(context.diagnostics, "phrase of `" + object.name + "`",
                 {task.refer[role]->span, task.refer[role]->text}, candidates)
      .label(object.span, "the object");
  poisoned = true;
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

// The camera moves with a link, so that link must be in the scene.
void check_camera(Context& context, const Task& task, bool& poisoned) {
  const Scene& scene = context.model.scenes[task.scene];
  const Camera& camera = context.model.cameras[camera_of(context.model, task)];
  if (camera.mount_robot == scene.robot) return;
  context
      .report(Code::P0201, task.span,
              "camera `" + camera.name + "` of `" + task.name +
                  "` is mounted on a robot that is not in scene `" + scene.name + "`")
      .label(camera.mount_link.span, "this link");
  poisoned = true;
}

std::string missing_statements(const Task& task) {
  const std::pair<bool, const char*> wanted[] = {
      {task.scene != SceneId::kNone, "scene"},
      {task.layout != LayoutId::kNone, "layout"},
      {task.source != ObjectId::kNone, "source"},
      {task.target != ObjectId::kNone, "target"},
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

void read_allows(Context& context, const syntax::Decl& decl, Task& task) {
  task.allow_confounded.reset();
  for (const syntax::Allow& allow : decl.allows) {
    const auto code = code_from_slug(allow.what.text);
    if (!code) {
      context.report(Code::P0208, allow.what.span,
                     "`" + std::string(allow.what.text) + "` is nothing that can be allowed");
    } else if (*code == Code::P0701) {
      task.allow_confounded = allow.reason.value;
    }
  }
}

}  // namespace

std::vector<ObjectId> Task::objects() const {
  std::vector<ObjectId> all = {source, target};
  all.insert(all.end(), distractors.begin(), distractors.end());
  return all;
}

void define_tasks(Context& context) {
  const auto& decls = context.symbols.task_decls;
  Model& model = context.model;
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  std::vector<bool> poison(decls.size(), false);
  for (std::size_t i = 0; i < decls.size(); ++i) {
    model.tasks.add({});
    if (decls[i].like) parents[i] = context.symbols.tasks.find(*decls[i].like, context.diagnostics);
    poison[i] = decls[i].like && !parents[i];
  }
  for (const std::uint32_t i : parents_first(context, parents, context.symbols.tasks.names())) {
    const DeclaredTask& declared = decls[i];
    Task task;
    bool poisoned = poison[i] || !declared.decl->complete;
    if (parents[i]) {
      task = model.tasks[static_cast<TaskId>(*parents[i])];
      poisoned = poisoned || poison[*parents[i]];
    } else if (declared.like) {
      poisoned = true;
    }
    task.name = std::string(declared.name.text);
    task.span = declared.name.span;
    task.decl_span = declared.decl->span;
    task.file = declared.file->id;
    task.abstract = declared.abstract;
    task.like = parents[i] ? static_cast<TaskId>(*parents[i]) : TaskId::kNone;
    task.baseline = TaskId::kNone;
    task.starts.clear();
    read_allows(context, *declared.decl, task);
    TaskReader reader{context, *declared.file, task, poisoned};
    for (const syntax::TaskStmt& stmt : *declared.body) {
      if (!std::holds_alternative<syntax::ReferStmt>(stmt)) std::visit(reader, stmt);
    }
    for (const syntax::TaskStmt& stmt : *declared.body) {
      if (std::holds_alternative<syntax::ReferStmt>(stmt)) std::visit(reader, stmt);
    }
    check_refer(context, task, 0, poisoned);
    check_refer(context, task, 1, poisoned);
    // A `variant of` names its baseline once; when unknown it has been reported as `like`.
    const bool reported =
        declared.against && poison[i] && declared.against->span == declared.like->span;
    if (declared.against && !reported) {
      const auto baseline = context.symbols.tasks.find(*declared.against, context.diagnostics);
      if (baseline) task.baseline = static_cast<TaskId>(*baseline);
      task.baseline_span = declared.against->span;
    }
    const std::string missing = missing_statements(task);
    if (task.scene != SceneId::kNone) poisoned = poisoned || !model.scenes[task.scene].complete;
    task.complete = missing.empty() && !poisoned;
    if (task.complete) check_roles(context, task, poisoned);
    if (task.complete) check_camera(context, task, poisoned);
    if (!missing.empty() && !poisoned && !task.abstract) {
      context.report(Code::P0206, task.span, "task `" + task.name + "` has no " + missing);
    }
    task.complete = task.complete && !poisoned;
    poison[i] = poisoned;
    if (task.complete) {
      task.prompt = render_prompt(model, task);
      task.judged = judged_metrics(model, task);
      task.ood = out_of_distribution(model, task);
    }
    model.tasks[static_cast<TaskId>(i)] = std::move(task);
  }
  for (Task& task : model.tasks) {
    if (task.complete && task.baseline != TaskId::kNone && model.tasks[task.baseline].complete) {
      task.axes = axes_between(model, task, model.tasks[task.baseline]);
    }
  }
}

}  // namespace probe::sema
