// `suite`: which tasks are run, under which seeds.
#include <algorithm>
#include <set>

#include "compiler/define/define.h"
#include "compiler/define/episode_sample.h"
#include "compiler/define/set.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

struct SuiteReader {
  Context& context;
  SetReader& sets;
  const syntax::File& file;
  Suite& suite;
  bool has_tasks = false, has_seeds = false;
  Span prefix_span = {};
  std::vector<EpisodeSample> samples = {};
  std::vector<CutComparison> cuts = {};

  void operator()(const syntax::SuiteTasksStmt& stmt) {
    has_tasks = true;
    suite.members = sets.read(file, stmt.tasks);
    cuts = sets.take_cuts();
  }
  void operator()(const syntax::SuiteSampleStmt& stmt) {
    has_tasks = true;
    samples.push_back({&stmt, sets.read(file, stmt.of)});
    for (const CutComparison& cut : sets.take_cuts()) cuts.push_back(cut);
  }
  void finish() {
    sample_episodes(context, samples, suite);
    // The suite may have the baseline from elsewhere, or not have the variant after all.
    const std::set<TaskId> has(suite.members.begin(), suite.members.end());
    std::erase_if(cuts, [&](const CutComparison& cut) {
      return !has.contains(cut.task) || suite.drawn.contains(cut.task) ||
             has.contains(context.model.tasks[cut.task].baseline);
    });
    suite.cuts.insert(suite.cuts.begin(), cuts.begin(), cuts.end());
  }
  void operator()(const syntax::PrefixStmt& stmt) {
    prefix_span = stmt.prefix.span;
    const std::string& text = stmt.prefix.value;
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto is_part = [&](char c) { return is_letter(c) || c == '_' || (c >= '0' && c <= '9'); };
    if (text.size() > plan::kMaxNameBytes) {
      context.report(Situation::kTextTooLong, prefix_span,
                     "a prefix has at most " + std::to_string(plan::kMaxNameBytes) +
                         " bytes, found " + std::to_string(text.size()));
    } else if (text.empty() || !is_letter(text[0]) ||
               !std::all_of(text.begin(), text.end(), is_part)) {
      context
          .report(Situation::kTextForm, prefix_span,
                  "a prefix is letters, digits and `_`, a letter first")
          .help("a task is also called by its name with the prefix before it");
    } else {
      suite.prefix = text;
    }
  }
  // Asked for by either name, a task must be the only one that is meant.
  void check_prefix() const {
    if (suite.prefix.empty()) return;
    for (const TaskId id : suite.members) {
      const std::string& name = context.model.tasks[id].name;
      const auto other = context.symbols.tasks.peek(suite.prefix + name);
      if (!other) continue;
      const std::string full = suite.prefix + name;
      context
          .report(Code::P0203, prefix_span,
                  "with it, `" + name + "` is called `" + full + "` as another task is")
          .label(context.symbols.task_decls[*other].name.span, "this one");
      return;
    }
  }
  void operator()(const syntax::SeedsStmt& stmt) {
    has_seeds = true;
    for (const syntax::Int& seed : stmt.seeds) {
      const auto value = static_cast<std::uint32_t>(seed.value);
      const auto& known = suite.seeds;
      if (seed.value > 0xfffffffeu) {
        context.report(Situation::kSeedTooLarge, seed.span, "a seed is below 4294967295");
      } else if (std::find(known.begin(), known.end(), value) != known.end()) {
        context
            .report(Code::P0203, seed.span, "seed `" + std::to_string(value) + "` is listed twice")
            .help("the same seed repeats the same episodes");
      } else {
        suite.seeds.push_back(value);
      }
    }
  }
  void operator()(const syntax::SuiteQuestionsStmt& stmt) {
    for (const syntax::Name& name : stmt.sets) {
      const auto found = context.symbols.question_sets.find(name, context.diagnostics);
      if (!found) continue;
      const auto id = static_cast<QuestionSetId>(*found);
      if (std::find(suite.questions.begin(), suite.questions.end(), id) != suite.questions.end()) {
        context.report(Code::P0203, name.span, "`" + std::string(name.text) + "` is listed twice");
      } else {
        suite.questions.push_back(id);
      }
    }
  }
  void operator()(const syntax::ExpectTasksStmt& stmt) {
    suite.expect = {stmt.tasks.value, stmt.episodes.value, stmt.span};
  }
};

}  // namespace

void define_suites(Context& context) {
  SetReader sets(context, SetReader::Mode::kDefined);
  for (const auto& declared : context.symbols.suite_decls) {
    const syntax::SuiteDecl& node = *declared.node;
    Suite suite;
    suite.name = std::string(node.name.text);
    suite.span = node.name.span;
    if (node.trained_on) {
      const auto dataset = context.symbols.datasets.find(*node.trained_on, context.diagnostics);
      if (dataset) suite.trained_on = static_cast<DatasetId>(*dataset);
    }
    SuiteReader reader{context, sets, *declared.file, suite};
    for (const syntax::SuiteStmt& stmt : node.body) std::visit(reader, stmt);
    reader.finish();
    reader.check_prefix();
    suite.broken = !declared.decl->complete || !reader.has_tasks;
    if (declared.decl->complete && !reader.has_tasks)
      context.report(Situation::kStatementMissing, suite.span,
                     "suite `" + suite.name + "` has no `tasks`");
    if (declared.decl->complete && !reader.has_seeds) {
      context
          .report(Situation::kStatementMissing, suite.span,
                  "suite `" + suite.name + "` has no `seeds`")
          .help("each seed runs every episode once: `seeds 42`");
    }
    if (suite.seeds.empty()) suite.seeds.push_back(0);
    context.model.suites.add(std::move(suite));
  }
}

}  // namespace probe::sema
