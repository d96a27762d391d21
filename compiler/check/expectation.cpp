// P0504 and P0211: the counts that a text expects, and sets and suites that hold nothing.
#include <algorithm>
#include <set>
#include <vector>

#include "compiler/check/check.h"

namespace probe::sema {
namespace {

// " (12 placements x 2 turns)", where that is what they are made of.
std::string factors(std::span<const Start> starts) {
  std::set<std::vector<double>> placements, turns;
  for (const Start& start : starts) {
    std::vector<double> at, turned;
    for (const Start::Placed& placed : start.placed) {
      at.insert(at.end(), {placed.x, placed.y});
      turned.insert(turned.end(), placed.turn.rotation.begin(), placed.turn.rotation.end());
    }
    placements.insert(std::move(at));
    turns.insert(std::move(turned));
  }
  if (placements.size() * turns.size() != starts.size()) return "";
  return " (" + std::to_string(placements.size()) + " placements x " +
         std::to_string(turns.size()) + " turns)";
}

void check_task(const Model& model, const Task& task, Reporter& reporter) {
  const Layout& layout = model.layouts[task.layout];
  // What is chosen of a layout is not all that it has.
  if (!layout.expect || !task.clear.empty() || *layout.expect == task.starts.size()) return;
  const About about(reporter, task.decl_span);
  Diagnostic& said =
      report_of(reporter, Code::P0504, task, layout.expect_span,
                "`" + task.name + "` has " + std::to_string(task.starts.size()) + " episodes" +
                    factors(task.starts) + ", not " + std::to_string(*layout.expect));
  said.label(task.layout_span, "used here");
  if (layout.like == LayoutId::kNone ||
      model.layouts[layout.like].expect_span != layout.expect_span)
    return;
  said.help("`" + layout.name + "` copies what `" + model.layouts[layout.like].name +
            "` expects: write `expect " + std::to_string(task.starts.size()) +
            " episodes` into it");
}

void check_suite(const Model& model, const Suite& suite, Reporter& reporter) {
  // A mistake may be why a set misses a task or more.
  if (reporter.has_errors()) return;
  if (suite.members.empty() && !suite.broken) {
    reporter.report(Code::P0211, suite.span, "no task is in suite `" + suite.name + "`").severity =
        Severity::kError;
  }
  const bool is_whole = std::all_of(model.tasks.begin(), model.tasks.end(), [](const Task& task) {
    return task.complete || task.abstract;
  });
  if (!suite.expect || !is_whole) return;
  std::uint64_t episodes = 0, variants = 0;
  for (const TaskId id : suite.members) {
    const std::size_t of_task = suite.starts_of(id, model.tasks[id]).size();
    episodes += of_task;
    if (model.tasks[id].baseline != TaskId::kNone) variants += of_task;
  }
  if (suite.expect->tasks == suite.members.size() && suite.expect->episodes == episodes) return;
  Diagnostic& said =
      reporter.report(Code::P0504, suite.expect->span,
                      "suite `" + suite.name + "` has " + std::to_string(suite.members.size()) +
                          " tasks and " + std::to_string(episodes) + " episodes");
  if (variants > 0 && variants < episodes)
    said.point(std::to_string(variants) + " of variants, " + std::to_string(episodes - variants) +
               " of what they are compared with");
}

}  // namespace

void check_expectations(const Model& model, Reporter& reporter) {
  for (const Task& task : model.tasks) {
    if (!task.starts.empty()) check_task(model, task, reporter);
  }
  // A mistake anywhere may be why nothing is in a set.
  for (const TaskSet& set : model.sets) {
    if (reporter.has_errors()) break;
    if (set.members.empty() && !set.broken && !set.name.empty())
      reporter.report(Code::P0211, set.span, "no task is in set `" + set.name + "`");
  }
  for (const Suite& suite : model.suites) check_suite(model, suite, reporter);
}

}  // namespace probe::sema
