// P07xx: is every variant compared with something that it differs from in one way?
#include <algorithm>
#include <bit>
#include <set>

#include "compiler/define/axes.h"
#include "compiler/define/passes.h"
#include "compiler/names/allow.h"

namespace probe::sema {
namespace {

std::string axis_list(std::uint32_t mask) {
  std::string text;
  for (const std::string_view name : plan::axis_names(mask))
    text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

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
      context.report(Code::P0703, task.baseline_span,
                     "task `" + task.name + "` is compared with itself over its baselines");
      for (auto member = std::find(chain.begin(), chain.end(), at); member != chain.end();
           ++member) {
        model.tasks[*member].baseline = TaskId::kNone;
      }
    }
    for (const TaskId id : chain) safe[static_cast<std::size_t>(id)] = true;
  }
}

// The statement of a task that says what is compared along an axis; null where several have a say.
const Span* statement_of(const Task& task, plan::Axis axis) {
  switch (axis) {
    case plan::Axis::kObjectSource:
      return &task.role_span[0];
    case plan::Axis::kObjectTarget:
      return &task.role_span[1];
    case plan::Axis::kDistractors:
      return &task.distractors_span;
    case plan::Axis::kLanguageAction:
    case plan::Axis::kLanguageNegation:
    case plan::Axis::kLanguageParaphrase:
      return &task.say_span;
    case plan::Axis::kLayout:
      return &task.layout_span;
    case plan::Axis::kLanguageAppearance:
    case plan::Axis::kLanguageCommonsense:
    case plan::Axis::kScene:
    case plan::Axis::kLight:
    case plan::Axis::kCamera:
    case plan::Axis::kGoal:
      break;
  }
  return nullptr;
}

// Marks the statements of this declaration that moved an axis; what was copied has no mark.
void label_axes(const Context& context, const Task& task, const Task& baseline,
                Diagnostic& diagnostic) {
  std::string others;
  for (const ObjectId id : task.distractors) {
    const auto& known = baseline.distractors;
    if (std::find(known.begin(), known.end(), id) == known.end())
      others += (others.empty() ? "distractors: + " : ", ") + context.model.objects[id].name;
  }
  if (others.empty()) others = plan::axis_name(plan::Axis::kDistractors);
  for (const plan::Axis axis : plan::axes_in(task.axes)) {
    const Span* span = statement_of(task, axis);
    if (span == nullptr || !is_within(*span, task.decl_span)) continue;
    diagnostic.also(*span,
                    axis == plan::Axis::kDistractors ? others : std::string(plan::axis_name(axis)));
  }
}

void check_edge(Context& context, const Task& task) {
  const About about(context, task.decl_span);
  const Task& baseline = context.model.tasks[task.baseline];
  if (baseline.abstract) {
    context.report(
        Code::P0703, task.baseline_span,
        "`" + task.name + "` is compared with the abstract task `" + baseline.name + "`");
    return;
  }
  if (!baseline.complete) return;
  const int axes = std::popcount(task.axes);
  if (axes == 0) {
    context.report(Code::P0702, task.span,
                   "`" + task.name + "` does not differ from its baseline `" + baseline.name + "`");
    return;
  }
  if (axes == 1) return;
  Diagnostic& diagnostic = context.report(
      Code::P0701, task.span,
      "`" + task.name + "` differs from its baseline on " + std::to_string(axes) + " axes");
  label_axes(context, task, baseline, diagnostic);
  diagnostic.label(task.baseline_span, "compared with this");
  // The task it copies is often the honest baseline.
  if (task.like != TaskId::kNone && task.like != task.baseline &&
      context.model.tasks[task.like].complete && !context.model.tasks[task.like].abstract) {
    const Task& like = context.model.tasks[task.like];
    const std::uint32_t closer = axes_between(context.model, task, like);
    if (std::popcount(closer) == 1) {
      diagnostic.help("compare with `" + like.name + "`, where only " + axis_list(closer) +
                      " moves");
    }
  }
  diagnostic.note("axes: " + axis_list(task.axes))
      .note("to keep it, put @allow(confounded, \"why\") above the declaration");
}

}  // namespace

void check_tags(Context& context) {
  std::set<ObjectId> reported;
  for (const Suite& suite : context.model.suites) {
    if (suite.trained_on == DatasetId::kNone) continue;
    for (const TaskId id : suite.members) {
      const Task& task = context.model.tasks[id];
      if (!task.complete) continue;
      for (const ObjectId object_id : task.objects()) {
        const Object& object = context.model.objects[object_id];
        // What another data set holds tells nothing of this one.
        const bool is_tagged =
            object.unseen || std::find(object.seen_in.begin(), object.seen_in.end(),
                                       suite.trained_on) != object.seen_in.end();
        if (is_tagged || !reported.insert(object_id).second) continue;
        context
            .report(Code::P0705, object.span,
                    "object `" + object.name + "` does not say whether it was seen in " +
                        (object.seen_in.empty()
                             ? std::string("training")
                             : "`" + context.model.datasets[suite.trained_on].name + "`"))
            .help("write `seen in " + context.model.datasets[suite.trained_on].name +
                  "` or `unseen`");
      }
    }
  }
}

void check_comparisons(Context& context) {
  break_cycles(context);
  for (const Task& task : context.model.tasks) {
    if (!task.abstract && task.complete && task.baseline != TaskId::kNone)
      check_edge(context, task);
  }
}

}  // namespace probe::sema
