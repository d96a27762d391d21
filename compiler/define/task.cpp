// Tasks and variants: fields copied along `like`, statements over them, then everything that
// follows from the fields.
#include "compiler/define/task.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/define/axes.h"
#include "compiler/define/define.h"
#include "compiler/define/metrics.h"
#include "compiler/define/motion.h"
#include "compiler/define/remembered.h"
#include "compiler/define/role.h"
#include "compiler/define/solution.h"
#include "compiler/define/task_fit.h"
#include "compiler/define/task_statements.h"
#include "compiler/define/telling.h"
#include "compiler/define/template.h"
#include "compiler/define/thing.h"
#include "compiler/define/views.h"
#include "compiler/define/wording.h"
#include "compiler/names/like.h"

namespace probe::sema {
namespace {

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
      {task.horizon != 0 || task.horizon_time, "horizon"},
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

const std::vector<Turn>& rest_of(const Model& model, const Task& task, ObjectId object) {
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

void TaskTable::drop_last_row() {
  context_.model.tasks.drop_last();
  poison_.pop_back();
  defined_.pop_back();
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
  read_statements(context_, declared, task, poisoned);
  count_horizon(context_, task, poisoned);
  Remembered* const remembered = context_.reporter.depth.remembered;
  if (remembered != nullptr) {
    if (poisoned) remembered->forget(index);
    if (const auto* known = poisoned ? nullptr : remembered->followed(model, index, task)) {
      task.placed = known->placed;
      task.judged = judged_metrics(model, task);
      task.prompt = known->prompt;
      task.ood = known->ood;
      task.complete = true;
      poison_[index] = false;
      defined_[index] = true;
      model.tasks[static_cast<TaskId>(index)] = std::move(task);
      return;
    }
  }
  const std::size_t said = context_.diagnostics.size();
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
  if (task.complete) check_fit(context_, task, poisoned);
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
    for (std::size_t i = 0; i < task.later.size(); ++i)
      task.later[i].text = render_prompt(model, telling(task, i + 1));
    task.ood = out_of_distribution(model, task);
    if (remembered != nullptr && context_.diagnostics.size() == said)
      remembered->keep(index, task);
  }
  model.tasks[static_cast<TaskId>(index)] = std::move(task);
}

// Who is spoken of fills a role, and who fills a declared role is spoken of.
bool TaskTable::check_filled(const Task& task, bool& poisoned) {
  const Model& model = context_.model;
  bool is_complete = true;
  std::string missing;                                    // of source and target
  std::map<RoleId, std::pair<Span, const char*>> spoken;  // with how the task comes to it
  const auto say = [&](TemplateId words) {
    for (const Template::Part& part : model.templates[words].parts) {
      if (part.slot && part.slot->role != RoleId::kNone)
        spoken.try_emplace(part.slot->role, part.slot->span, "its words speak of it");
    }
  };
  say(task.say);
  for (const LaterSentence& later : task.later) say(later.say);
  for (const auto& [role, span] : mentioned_.metrics(measured_in(task)).roles)
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
  for (const auto& [role, refer] : task.refer)
    spoken.try_emplace(role, refer.span, "how it is called is said here");
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
      if (where == spoken.end() || !task.objects_in(role).empty()) continue;
      said->label(where->second.first, where->second.second);
      const std::string& name = model.roles[role].name;
      said->help("write `" + name + " OBJECT`; a task without one has words, metrics and a layout that do not speak of `" + name + "`");
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
    Remembered* const remembered = context_.reporter.depth.remembered;
    const auto baseline = static_cast<std::uint32_t>(task.baseline);
    if (const auto known = remembered ? remembered->axes(index, baseline) : std::nullopt) {
      task.axes = *known;
      return;
    }
    task.axes = axes_between(context_.model, task, context_.model.tasks[task.baseline]);
    if (remembered != nullptr) remembered->keep_axes(index, baseline, task.axes);
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
  if (context.reporter.depth.remembered != nullptr)
    context.reporter.depth.remembered->begin(context);
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
