#include "compiler/emit/early_end.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "compiler/model/same.h"
#include "compiler/names/allow.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/skills.h"
#include "runtime/vm/derived_solution.h"
#include "runtime/vm/made_up.h"

namespace probe::emit {
namespace {

using sema::Metric;
using sema::Task;

const Metric* metric_of(const Task& task, std::string_view name) {
  const auto found = std::ranges::find(task.judged, name, &Metric::name);
  return found == task.judged.end() ? nullptr : &*found;
}

std::vector<sema::ExprRef> conditions_of(const sema::Model& model, sema::ExprRef expr) {
  const sema::ExprNode& node = model.exprs.nodes[expr];
  if (node.op != sema::ExprOp::kAnd) return {expr};
  std::vector<sema::ExprRef> all;
  for (const sema::ExprRef arg : node.args) {
    const auto more = conditions_of(model, arg);
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

// Whether success may be false where the episode ends: it asks for something that `ends` does not.
bool may_end_early(const sema::Model& model, const Task& task) {
  const Metric* const success = metric_of(task, "success");
  const Metric* const ends = metric_of(task, plan::kEndsMetric);
  if (task.abstract || !task.complete || success == nullptr || ends == nullptr) return false;
  if (success->readout != plan::Readout::kAtEnd && success->readout != plan::Readout::kOnce)
    return true;
  const std::vector<sema::ExprRef> held = conditions_of(model, ends->expr);
  return !std::ranges::all_of(conditions_of(model, success->expr), [&](sema::ExprRef asked) {
    return std::ranges::any_of(
        held, [&](sema::ExprRef one) { return sema::same_expression(model, one, asked); });
  });
}

std::string in_words(const plan::Plan& plan, const std::vector<plan::SkillRecord>& skills) {
  std::string text;
  for (const plan::SkillRecord& skill : skills)
    text += (text.empty() ? "`" : "; ") + plan::skill_text(plan.tables(), skill);
  return text + "`";
}

// All that the answer depends on.
using Asked =
    std::tuple<std::uint32_t, std::uint32_t, std::string, std::vector<std::vector<double>>>;

Asked asked_of(const plan::Plan& plan, std::uint32_t task) {
  const plan::TaskRecord& record = plan.tasks()[task];
  std::string said;
  for (const plan::SkillRecord& skill : plan::skills_of(plan.tables(), task))
    said += plan::skill_text(plan.tables(), skill) + ";";
  std::vector<std::vector<double>> kinds;
  for (const std::uint32_t start : vm::kinds_of_starts(plan, task))
    kinds.push_back(vm::begins_as(plan, task, start));
  return {record.program, record.scene, std::move(said), std::move(kinds)};
}

Diagnostic& report(const plan::Plan& plan, const Task& task, const vm::EarlyEnd& early,
                   Diagnostics& diagnostics) {
  const Metric& success = *metric_of(task, "success");
  const Metric& ends = *metric_of(task, plan::kEndsMetric);
  std::string where;
  if (early.start != 0) where = ", in start " + std::to_string(early.start);
  Diagnostic& said =
      diagnostics.report(Code::P0608, task.place(success.span),
                         "`ends when` of `" + task.name +
                             "` ends the episode before `success` can be true: it holds after " +
                             in_words(plan, early.done) + ", with " + in_words(plan, early.left) +
                             " still to be done" + where);
  said.label(ends.span, "this ends the episode");
  if (!(success.span == task.place(success.span))) said.label(success.span, "judged by this");
  return said.help(
      "replacing a copied `success` keeps the `ends when` that was copied with it: write "
      "`ends when ..` anew, with what `success` asks for");
}

}  // namespace

bool may_end_early(const sema::Model& model) {
  return std::ranges::any_of(model.tasks,
                             [&](const Task& task) { return may_end_early(model, task); });
}

Status note_early_ends(const sema::Model& model, const std::vector<std::byte>& bytes,
                       Diagnostics& diagnostics) {
  std::map<std::string_view, const Task*> written;
  for (const Task& task : model.tasks) {
    if (may_end_early(model, task)) written.emplace(task.name, &task);
  }
  if (written.empty()) return {};
  PROBE_ASSIGN(const plan::Plan plan, plan::Plan::from_bytes(bytes, {.identity = false}));
  std::map<Asked, std::optional<vm::EarlyEnd>> known;
  struct Said {
    Diagnostic* of_first = nullptr;
    std::size_t more = 0;  // tasks
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Said> places;
  for (std::uint32_t index = 0; index < plan.tasks().size(); ++index) {
    const auto task = written.find(plan.text(plan.tasks()[index].name));
    if (task == written.end()) continue;
    const auto [at, is_new] = known.try_emplace(asked_of(plan, index));
    if (is_new) {
      PROBE_ASSIGN(at->second, vm::early_end(plan, index));
    }
    if (!at->second) continue;
    const Span& place = task->second->place(metric_of(*task->second, "success")->span);
    Said& said = places[{place.file.value, place.begin}];
    if (said.of_first == nullptr) {
      said.of_first = &report(plan, *task->second, *at->second, diagnostics);
    } else {
      ++said.more;
    }
  }
  for (const auto& [place, said] : places) {
    if (said.more > 0) sema::note_more(*said.of_first, said.more);
  }
  return {};
}

}  // namespace probe::emit
