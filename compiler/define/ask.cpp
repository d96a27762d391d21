// Which sets of questions each task is asked, and what comes of them.
#include <algorithm>
#include <set>

#include "compiler/define/ask_family.h"
#include "compiler/define/define.h"
#include "runtime/plan/questions.h"

namespace probe::sema {
namespace {

using plan::OmissionReason;

// Which sets each task is asked: those of the suites that it is in, or all of a root file that has
// no suite.
std::vector<std::set<QuestionSetId>> sets_of_tasks(const Context& context) {
  const Model& model = context.model;
  std::vector<std::set<QuestionSetId>> sets(model.tasks.size());
  for (const Suite& suite : model.suites) {
    for (const TaskId task : suite.members)
      sets[static_cast<std::size_t>(task)].insert(suite.questions.begin(), suite.questions.end());
  }
  for (std::size_t i = 0; i < model.question_sets.size(); ++i) {
    const FileId file = model.question_sets[model.question_sets.id(i)].span.file;
    const bool is_root =
        std::find(context.roots.begin(), context.roots.end(), file) != context.roots.end();
    const bool has_suite = std::any_of(model.suites.begin(), model.suites.end(),
                                       [&](const Suite& s) { return s.span.file == file; });
    if (!is_root || has_suite) continue;
    for (auto& of_task : sets) of_task.insert(model.question_sets.id(i));
  }
  return sets;
}

// Says once of a family that nothing came of it.
void report_unasked(Context& context, const std::vector<std::set<QuestionSetId>>& sets) {
  const Model& model = context.model;
  std::set<std::pair<QuestionSetId, std::uint32_t>> asked;
  for (const AskedQuestion& question : model.asked) asked.emplace(question.set, question.family);
  for (std::size_t i = 0; i < model.question_sets.size(); ++i) {
    const QuestionSetId id = model.question_sets.id(i);
    const QuestionSet& set = model.question_sets[id];
    const bool is_root =
        std::find(context.roots.begin(), context.roots.end(), set.span.file) != context.roots.end();
    std::size_t tasks = 0;
    for (std::size_t t = 0; t < sets.size(); ++t) {
      const Task& task = model.tasks[model.tasks.id(t)];
      tasks += sets[t].contains(id) && !task.abstract && task.complete ? 1 : 0;
    }
    // A library offers what a suite of a few tasks has no use for.
    if (!is_root || tasks == 0) continue;
    const About about(context.reporter, set.decl_span);
    for (std::uint32_t f = 0; f < set.families.size(); ++f) {
      if (set.families[f].broken || asked.contains({id, f})) continue;
      std::set<OmissionReason> reasons;
      for (const LeftOut& left : model.left_out) {
        if (left.set == id && left.family == f) reasons.insert(left.reason);
      }
      // That it has no single right answer has been said.
      if (reasons.size() == 1 && reasons.contains(OmissionReason::kAmbiguous)) continue;
      Diagnostic& said =
          context.report(Code::P0903, set.families[f].span,
                         "question `" + set.families[f].name + "` is asked of none of " +
                             std::to_string(tasks) + (tasks == 1 ? " task" : " tasks"));
      for (const LeftOut& left : model.left_out) {
        if (left.set != id || left.family != f || reasons.erase(left.reason) == 0) continue;
        said.note("in `" + model.tasks[left.task].name + "` " +
                  std::string(plan::find_omission(static_cast<std::uint32_t>(left.reason))->says));
      }
    }
  }
}

// A metric that no task has is a mistake; one that some task lacks is left out there.
void check_metrics_named(Context& context) {
  Model& model = context.model;
  for (QuestionSet& set : model.question_sets) {
    for (Family& family : set.families) {
      if (family.broken || family.answer.kind != QuestionAnswer::kMetric) continue;
      std::vector<std::string_view> known;
      bool is_known = false;
      for (const Task& task : model.tasks) {
        for (const Metric& metric : task.judged) {
          is_known = is_known || metric.name == family.answer.truth.name;
          if (std::find(known.begin(), known.end(), metric.name) == known.end())
            known.push_back(metric.name);
        }
      }
      // That `success` is missing is said of the metrics.
      if (is_known || known.empty() || family.answer.truth.name == "success") continue;
      report_unknown(context.diagnostics, "metric",
                     {family.answer.truth.span, family.answer.truth.name}, known);
      family.broken = true;
    }
  }
}

}  // namespace

void ask_questions(Context& context) {
  Model& model = context.model;
  if (model.question_sets.size() == 0) return;
  check_metrics_named(context);
  const auto sets = sets_of_tasks(context);
  const ObjectNames names(model);
  Ambiguities ambiguities(context);
  // What cannot be measured is said where the phrase is used.
  Diagnostics unsaid;
  Relations relations(model, context.asset_root, unsaid);
  for (std::size_t t = 0; t < model.tasks.size(); ++t) {
    const TaskId task = model.tasks.id(t);
    if (model.tasks[task].abstract || !model.tasks[task].complete) continue;
    if (sets[t].empty()) continue;
    const SceneObjects scene(model, names, task);
    for (const QuestionSetId id : sets[t]) {
      const QuestionSet& set = model.question_sets[id];
      const About about(context.reporter, set.decl_span);
      for (std::uint32_t f = 0; f < set.families.size(); ++f) {
        if (set.families[f].broken) continue;
        const auto why_not = ask_family({context, ambiguities, relations, scene, id, f});
        if (why_not) model.left_out.push_back({id, f, task, *why_not});
      }
    }
  }
  report_unasked(context, sets);
}

}  // namespace probe::sema
