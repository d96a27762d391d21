// P07xx: is every variant compared with something that it differs from in one way?
#include <algorithm>
#include <bit>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/define/axes.h"
#include "compiler/define/starts.h"
#include "compiler/define/telling.h"
#include "compiler/define/wording.h"

namespace probe::sema {
namespace {

std::string axis_list(std::uint32_t mask) {
  std::string text;
  for (const std::string_view name : plan::axis_names(mask))
    text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

// The statement of a task that says what is compared along an axis; null where several have a say.
const Span* statement_of(const Task& task, plan::Axis axis) {
  switch (axis) {
    case plan::Axis::kObjectSource:
      return &task.role_span[0];
    case plan::Axis::kObjectTarget:
      return &task.role_span[1];
    case plan::Axis::kObjectOther:
      return task.others.empty() ? nullptr : &task.others.front().span;
    case plan::Axis::kDistractors:
      return &task.distractors_span;
    case plan::Axis::kLanguageAction:
    case plan::Axis::kLanguageNegation:
    case plan::Axis::kLanguageParaphrase:
      return &task.say_span;
    case plan::Axis::kLayout:
    case plan::Axis::kRobot:
      return &task.layout_span;
    case plan::Axis::kLatency:
      return &task.delay_span;
    case plan::Axis::kMotion:
      return task.motions.empty() ? nullptr : &task.motions.front().span;
    case plan::Axis::kLanguageAppearance:
    case plan::Axis::kLanguageCommonsense:
    case plan::Axis::kLanguageSpatial:
    case plan::Axis::kScene:
    case plan::Axis::kFixture:
    case plan::Axis::kLight:
    case plan::Axis::kCamera:
    case plan::Axis::kSceneTexture:
    case plan::Axis::kSceneGeometry:
    case plan::Axis::kSensor:
    case plan::Axis::kGoal:
      break;
  }
  return nullptr;
}

// Marks the statements of this declaration that moved an axis; what was copied has no mark.
void label_axes(const Model& model, const Task& task, const Task& baseline,
                Diagnostic& diagnostic) {
  std::string others;
  const auto add = [&](const std::vector<ObjectId>& now, const std::vector<ObjectId>& known) {
    for (const ObjectId id : now) {
      if (std::find(known.begin(), known.end(), id) == known.end())
        others += (others.empty() ? "distractors: + " : ", ") + model.objects[id].name;
    }
  };
  add(task.distractors, baseline.distractors);
  add(task.part_distractors, baseline.part_distractors);
  if (others.empty()) others = plan::axis_name(plan::Axis::kDistractors);
  for (const plan::Axis axis : plan::axes_in(task.axes)) {
    const Span* span = statement_of(task, axis);
    if (span == nullptr || !is_within(*span, task.decl_span)) continue;
    diagnostic.also(*span,
                    axis == plan::Axis::kDistractors ? others : std::string(plan::axis_name(axis)));
  }
}

// Starts are chosen anew in every task: words of place that a variant looks at from elsewhere are
// clear in others than its baseline's.
void note_chosen(const Task& task, const Task& baseline, Diagnostic& diagnostic) {
  if (!plan::moves(task.axes, plan::Axis::kLayout) || task.clear.empty() ||
      baseline.clear.empty() || task.layout != baseline.layout)
    return;
  diagnostic.note("`where clear` chooses other starts here, " + std::to_string(task.starts.size()) +
                  ", than of `" + baseline.name + "`, " + std::to_string(baseline.starts.size()) +
                  ": that is the axis layout");
}

// Whether a mask has nothing but these axes.
bool only(std::uint32_t mask, std::initializer_list<plan::Axis> axes) {
  for (const plan::Axis axis : axes) mask &= ~plan::bit(axis);
  return mask == 0;
}

// "the left can" against "the right can": the same things in the same places, whichever of them has
// which role and by whatever phrase. "to the left of the plate" against "to the right of it": the
// words are the opposites of one another, and success follows them (P1202). Each is one contrast.
bool is_contrast(const Task& task, const Task& baseline) {
  using plan::Axis;
  if (only(task.axes, {Axis::kLanguageAction, Axis::kLanguageSpatial, Axis::kLanguageParaphrase,
                       Axis::kGoal}))
    return plan::moves(task.axes, Axis::kGoal) && task.horizon == baseline.horizon &&
           are_opposites(whole_prompt(task), whole_prompt(baseline));
  if (!only(task.axes, {Axis::kObjectSource, Axis::kObjectTarget, Axis::kObjectOther,
                        Axis::kDistractors, Axis::kLanguageAppearance, Axis::kLanguageCommonsense,
                        Axis::kLanguageSpatial}))
    return false;
  std::vector<ObjectId> here = task.objects(), there = baseline.objects();
  std::ranges::sort(here);
  std::ranges::sort(there);
  return here == there && std::ranges::is_permutation(task.part_distractors,
                                                      baseline.part_distractors) &&
         task.things() == baseline.things() && start_at_same_places(task, baseline);
}

void check_edge(const Model& model, const Task& task, Reporter& reporter) {
  const About about(reporter, task.decl_span);
  const Task& baseline = model.tasks[task.baseline];
  if (baseline.abstract) {
    reporter.report(
        Situation::kAbstractBaseline, task.baseline_span,
        "`" + task.name + "` is compared with the abstract task `" + baseline.name + "`");
    return;
  }
  if (!baseline.complete) return;
  const int axes = std::popcount(task.axes);
  if (axes == 0) {
    reporter.report(
        Code::P0702, task.span,
        "`" + task.name + "` does not differ from its baseline `" + baseline.name + "`");
    return;
  }
  // A reason that is given is kept, needed or not.
  if (axes == 1 || (!task.allow_confounded && is_contrast(task, baseline))) return;
  Diagnostic& diagnostic = reporter.report(
      Code::P0701, task.span,
      "`" + task.name + "` differs from its baseline on " + std::to_string(axes) + " axes");
  label_axes(model, task, baseline, diagnostic);
  diagnostic.label(task.baseline_span, "compared with this");
  // The task it copies is often the honest baseline.
  if (task.like != TaskId::kNone && task.like != task.baseline && model.tasks[task.like].complete &&
      !model.tasks[task.like].abstract) {
    const Task& like = model.tasks[task.like];
    const std::uint32_t closer = axes_between(model, task, like);
    if (std::popcount(closer) == 1) {
      diagnostic.help("compare with `" + like.name + "`, where only " + axis_list(closer) +
                      " moves");
    }
  }
  note_chosen(task, baseline, diagnostic);
  diagnostic.note("axes: " + axis_list(task.axes))
      .note("to keep it, put @allow(confounded, \"why\") above the declaration");
}

// What two variants of a sweep have to share before anything else of them is compared.
auto sweep_of(const Task& task) {
  return std::tuple(task.decl_span.file.value, task.decl_span.begin, task.baseline,
                    task.starts.data(), task.horizon, task.idle, task.delay,
                    std::string_view(task.prompt));
}

std::size_t hash_of_sweep(const Task& task) {
  std::size_t hash = std::hash<std::string_view>()(task.prompt);
  for (const std::size_t part : {std::size_t{task.decl_span.file.value} << 32 | task.decl_span.begin,
                                 static_cast<std::size_t>(task.baseline),
                                 std::hash<const Start*>()(task.starts.data())})
    hash = (hash ^ part) * 0x9e37'79b9'7f4a'7c15u;
  return hash;
}

// Of those that a `derive` makes of one task none is another: an experiment that is counted twice.
void check_twins(const Model& model, Reporter& reporter) {
  std::unordered_map<std::size_t, std::vector<const Task*>> sweeps;  // by hash
  for (const Task& task : model.tasks) {
    if (!task.derived || !task.complete || task.axes == 0 || task.baseline == TaskId::kNone)
      continue;
    auto& alike = sweeps[hash_of_sweep(task)];
    const auto twin = std::find_if(alike.begin(), alike.end(), [&](const Task* other) {
      return sweep_of(task) == sweep_of(*other) && whole_prompt(task) == whole_prompt(*other) &&
             axes_between(model, task, *other) == 0;
    });
    if (twin == alike.end()) {
      alike.push_back(&task);
      continue;
    }
    // Of a binder that is used nowhere this follows.
    const auto& said = reporter.diagnostics.items();
    if (std::any_of(said.begin(), said.end(), [&](const Diagnostic& item) {
          return item.code == Code::P0205 && is_within(item.primary, task.decl_span);
        }))
      continue;
    const About about(reporter, task.decl_span);
    reporter
        .report(Code::P0702, task.span,
                "`" + task.name + "` does not differ from `" + (*twin)->name +
                    "`, which is made of `" + model.tasks[task.baseline].name + "` as well")
        .cause = "twins " + std::to_string(task.decl_span.file.value) + ":" +
                 std::to_string(task.decl_span.begin);
  }
}

}  // namespace

void check_comparisons(const Model& model, Reporter& reporter) {
  for (const Task& task : model.tasks) {
    if (!task.abstract && task.complete && task.baseline != TaskId::kNone)
      check_edge(model, task, reporter);
  }
  check_twins(model, reporter);
}

}  // namespace probe::sema
