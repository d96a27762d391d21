// Sets of tasks, computed from conditions, and suites that list them. Sets may name one another in
// any order.
#include <algorithm>
#include <filesystem>
#include <set>

#include "compiler/sema/axes.h"
#include "compiler/sema/language.h"
#include "compiler/sema/passes.h"

namespace probe::sema {
namespace {

// Files by what they use, so that `tasks` can mean the tasks of a file and of what it uses.
std::set<std::uint32_t> visible_files(const Context& context, const syntax::File& file) {
  std::set<std::uint32_t> visible;
  std::vector<const syntax::File*> open = {&file};
  while (!open.empty()) {
    const syntax::File* at = open.back();
    open.pop_back();
    if (!visible.insert(at->id.value).second) continue;
    const std::filesystem::path folder =
        std::filesystem::path(context.sources.file(at->id).name()).parent_path();
    for (const syntax::Decl& decl : at->decls) {
      const auto* use = std::get_if<syntax::UseDecl>(&decl.node);
      if (use == nullptr) continue;
      const std::string used = (folder / use->path.value).lexically_normal().string();
      for (const syntax::File* other : context.files) {
        const std::filesystem::path name(context.sources.file(other->id).name());
        if (name.lexically_normal().string() == used) open.push_back(other);
      }
    }
  }
  return visible;
}

class SetReader {
 public:
  explicit SetReader(Context& context)
      : context_(context), states_(context.symbols.set_decls.size(), kNew) {}

  void define(SetId id) {
    State& state = states_[static_cast<std::size_t>(id)];
    if (state == kDone) return;
    const auto& declared = context_.symbols.set_decls[static_cast<std::size_t>(id)];
    if (state == kOpen) {
      context_.report(Code::P0207, declared.node->name.span,
                      "set `" + std::string(declared.node->name.text) + "` is part of itself");
      return;
    }
    state = kOpen;
    std::vector<TaskId> members = read(*declared.file, declared.node->tasks);
    context_.model.sets[id] = {std::string(declared.node->name.text), declared.node->name.span,
                               std::move(members)};
    state = kDone;
  }

  std::vector<TaskId> read(const syntax::File& file, syntax::TaskSetId id) {
    if (id.value == syntax::TaskSetId::kNone) return {};  // a syntax error, reported
    return std::visit([&](const auto& node) { return read_node(file, file[id].span, node); },
                      file[id].node);
  }

 private:
  enum State : std::uint8_t { kNew, kOpen, kDone };
  using Members = std::vector<TaskId>;

  static bool contains(const Members& members, TaskId id) {
    return std::find(members.begin(), members.end(), id) != members.end();
  }

  Members read_node(const syntax::File&, const Span&, const syntax::TaskSetNames& names) {
    Members members;
    for (const syntax::Name& name : names.names) {
      const auto found = context_.symbols.tasks.find(name, context_.diagnostics);
      if (found && !contains(members, static_cast<TaskId>(*found)))
        members.push_back(static_cast<TaskId>(*found));
    }
    return members;
  }
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetName& set) {
    if (set.name.text == "tasks") {
      const std::set<std::uint32_t> visible = visible_files(context_, file);
      Members members;
      for (std::size_t i = 0; i < context_.model.tasks.size(); ++i) {
        const Task& task = context_.model.tasks[static_cast<TaskId>(i)];
        if (!task.abstract && visible.contains(task.file.value))
          members.push_back(static_cast<TaskId>(i));
      }
      return members;
    }
    const auto found = context_.symbols.sets.find(set.name, context_.diagnostics);
    if (!found) return {};
    define(static_cast<SetId>(*found));
    return context_.model.sets[static_cast<SetId>(*found)].members;
  }
  Members read_node(const syntax::File& file, const Span&,
                    const syntax::TaskSetVariants& variants) {
    const Members of = read(file, variants.of);
    Members members;
    for (std::size_t i = 0; i < context_.model.tasks.size(); ++i) {
      const Task& task = context_.model.tasks[static_cast<TaskId>(i)];
      if (!task.abstract && contains(of, task.baseline)) members.push_back(static_cast<TaskId>(i));
    }
    return members;
  }
  Members read_node(const syntax::File& file, const Span& span,
                    const syntax::TaskSetSample& sample) {
    (void)read(file, sample.of);
    context_.report(Code::P0101, span, "`sample` is not available yet");
    return {};
  }
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetBinary& binary) {
    Members left = read(file, binary.left);
    const Members right = read(file, binary.right);
    if (binary.op == syntax::SetOp::kUnion) {
      for (const TaskId id : right) {
        if (!contains(left, id)) left.push_back(id);
      }
      return left;
    }
    const bool keep = binary.op == syntax::SetOp::kIntersection;
    std::erase_if(left, [&](TaskId id) { return contains(right, id) != keep; });
    return left;
  }
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetWhere& where) {
    Members members = read(file, where.set);
    if (!check_condition(file, where.condition)) return {};
    std::erase_if(members, [&](TaskId id) {
      return !holds(file, where.condition, context_.model.tasks[id]);
    });
    return members;
  }

  // The words a condition may use; each is checked once, before any task is asked.
  bool check_condition(const syntax::File& file, syntax::CondId id) {
    if (id.value == syntax::CondId::kNone) return false;  // a syntax error, reported
    const auto& node = file[id].node;
    if (const auto* negation = std::get_if<syntax::CondNot>(&node))
      return check_condition(file, negation->operand);
    if (const auto* both = std::get_if<syntax::CondAnd>(&node)) {
      const bool left = check_condition(file, both->left);
      return check_condition(file, both->right) && left;
    }
    if (const auto* either = std::get_if<syntax::CondOr>(&node)) {
      const bool left = check_condition(file, either->left);
      return check_condition(file, either->right) && left;
    }
    const auto& test = std::get<syntax::CondTest>(node);
    std::vector<std::string_view> words;
    const char* kind = "";
    switch (test.kind) {
      case syntax::CondKind::kAxis:
        kind = "axis";
        for (const plan::Axis axis : axes_in(0xffffffffu)) words.push_back(axis_name(axis));
        break;
      case syntax::CondKind::kUses:
        kind = "use of language";
        words = {"action", "negation", "appearance", "commonsense"};
        break;
      case syntax::CondKind::kOod:
        kind = "kind of novelty";
        words = {"source", "target", "relation"};
        break;
      case syntax::CondKind::kHas:
        kind = "part of a task";
        words = {"distractors", "baseline"};
        break;
      case syntax::CondKind::kScene:
        if (test.path.parts.size() == 1) {
          return context_.symbols.scenes.find(test.path.parts[0], context_.diagnostics).has_value();
        }
        kind = "scene";
        break;
    }
    const std::string text = path_text(test.path);
    if (std::find(words.begin(), words.end(), text) != words.end()) return true;
    report_unknown(context_.diagnostics, kind, {test.path.span, text}, words);
    return false;
  }

  static std::string path_text(const syntax::Path& path) {
    std::string text;
    for (const syntax::Name& part : path.parts)
      text += (text.empty() ? "" : ".") + std::string(part.text);
    return text;
  }

  bool holds(const syntax::File& file, syntax::CondId id, const Task& task) const {
    const auto& node = file[id].node;
    if (const auto* negation = std::get_if<syntax::CondNot>(&node))
      return !holds(file, negation->operand, task);
    if (const auto* both = std::get_if<syntax::CondAnd>(&node)) {
      return holds(file, both->left, task) && holds(file, both->right, task);
    }
    if (const auto* either = std::get_if<syntax::CondOr>(&node)) {
      return holds(file, either->left, task) || holds(file, either->right, task);
    }
    return task.complete && holds(std::get<syntax::CondTest>(node), task);
  }

  bool holds(const syntax::CondTest& test, const Task& task) const {
    const Model& model = context_.model;
    const std::string word = path_text(test.path);
    switch (test.kind) {
      case syntax::CondKind::kAxis:
        for (const plan::Axis axis : axes_in(task.axes)) {
          if (axis_name(axis) == word) return true;
        }
        return false;
      case syntax::CondKind::kUses:
        if (word == "action") return uses_action(model, task);
        if (word == "negation") return has_negation(model.templates[task.say]);
        return uses_phrase(
            model, task, word == "appearance" ? PhraseAxis::kAppearance : PhraseAxis::kCommonsense);
      case syntax::CondKind::kOod:
        return (task.ood & (word == "source" ? 1u : word == "target" ? 2u : 4u)) != 0;
      case syntax::CondKind::kHas:
        return word == "distractors" ? !task.distractors.empty() : task.baseline != TaskId::kNone;
      case syntax::CondKind::kScene:
        return model.scenes[task.scene].name == word;
    }
    return false;
  }

  Context& context_;
  std::vector<State> states_;
};

void expect_suite(Context& context, const Suite& suite, const syntax::ExpectTasksStmt& expect) {
  std::uint64_t episodes = 0;
  for (const TaskId id : suite.members) {
    if (!context.model.tasks[id].complete) return;  // reported; its episodes are not known
    episodes += context.model.tasks[id].starts.size();
  }
  if (expect.tasks.value == suite.members.size() && expect.episodes.value == episodes) return;
  context.report(Code::P0504, expect.span,
                 "suite `" + suite.name + "` has " + std::to_string(suite.members.size()) +
                     " tasks and " + std::to_string(episodes) + " episodes");
}

}  // namespace

void define_sets(Context& context) {
  const std::size_t count = context.symbols.set_decls.size();
  for (std::size_t i = 0; i < count; ++i) context.model.sets.add({});
  SetReader reader(context);
  for (std::size_t i = 0; i < count; ++i) reader.define(static_cast<SetId>(i));
}

void define_suites(Context& context) {
  SetReader reader(context);
  for (const auto& declared : context.symbols.suite_decls) {
    const syntax::SuiteDecl& node = *declared.node;
    Suite suite;
    suite.name = std::string(node.name.text);
    suite.span = node.name.span;
    if (node.trained_on) {
      const auto dataset = context.symbols.datasets.find(*node.trained_on, context.diagnostics);
      if (dataset) suite.trained_on = static_cast<DatasetId>(*dataset);
    }
    bool has_tasks = false;
    const syntax::ExpectTasksStmt* expect = nullptr;
    for (const syntax::SuiteStmt& stmt : node.body) {
      if (const auto* tasks = std::get_if<syntax::SuiteTasksStmt>(&stmt)) {
        has_tasks = true;
        suite.members = reader.read(*declared.file, tasks->tasks);
      } else if (const auto* prefix = std::get_if<syntax::PrefixStmt>(&stmt)) {
        suite.prefix = prefix->prefix.value;
      } else if (const auto* seeds = std::get_if<syntax::SeedsStmt>(&stmt)) {
        for (const syntax::Int& seed : seeds->seeds) {
          if (seed.value > 0xfffffffeu) {
            context.report(Code::P0304, seed.span, "a seed is below 4294967295");
          } else {
            suite.seeds.push_back(static_cast<std::uint32_t>(seed.value));
          }
        }
      } else {
        expect = &std::get<syntax::ExpectTasksStmt>(stmt);
      }
    }
    if (!has_tasks && declared.decl->complete) {
      context.report(Code::P0206, suite.span, "suite `" + suite.name + "` has no `tasks`");
    }
    if (suite.seeds.empty()) suite.seeds.push_back(0);
    for (const TaskId id : suite.members) {
      if (!context.model.tasks[id].abstract) continue;
      context.report(
          Code::P0703, suite.span,
          "abstract task `" + context.model.tasks[id].name + "` is in suite `" + suite.name + "`");
    }
    if (expect != nullptr) expect_suite(context, suite, *expect);
    context.model.suites.add(std::move(suite));
  }
}

}  // namespace probe::sema
