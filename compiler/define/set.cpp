// `set`: tasks by name, by what they are compared with, by conditions.
#include "compiler/define/set.h"

#include <algorithm>

#include "compiler/define/axes.h"
#include "compiler/define/define.h"
#include "compiler/define/role.h"
#include "compiler/define/template.h"
#include "compiler/names/uses.h"
#include "runtime/base/sha256.h"

namespace probe::sema {
namespace {

// Which tasks are in a set.
class Mask {
 public:
  explicit Mask(std::size_t tasks, const std::vector<TaskId>& members = {}) : bits_(tasks, false) {
    for (const TaskId id : members) add(id);
  }
  void add(TaskId id) { bits_[static_cast<std::size_t>(id)] = true; }
  bool has(TaskId id) const { return bits_[static_cast<std::size_t>(id)]; }

 private:
  std::vector<bool> bits_;
};

std::string path_text(const syntax::Path& path) {
  std::string text;
  for (const syntax::Name& part : path.parts)
    text += (text.empty() ? "" : ".") + std::string(part.text);
  return text;
}

}  // namespace

// What a member is compared with, and what that is compared with, stands before it.
void SetReader::add_baselines(Members& members) const {
  Mask known(context_.model.tasks.size());
  Members all;
  const auto add = [&](TaskId id) {
    if (known.has(id)) return;
    known.add(id);
    all.push_back(id);
  };
  for (const TaskId id : members) {
    Members chain;
    for (TaskId at = id; at != TaskId::kNone && chain.size() <= context_.model.tasks.size();
         at = context_.model.tasks[at].baseline)
      chain.push_back(at);
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) add(*at);
  }
  members = std::move(all);
}

SetReader::SetReader(Context& context, Mode mode)
    : context_(context),
      preview_(mode == Mode::kPreview),
      diagnostics_(&context.diagnostics),
      states_(context.symbols.set_decls.size(), mode == Mode::kDefined ? kDone : kNew) {}

void SetReader::define(SetId id) {
  State& state = states_[static_cast<std::size_t>(id)];
  if (state == kDone) return;
  const auto& declared = context_.symbols.set_decls[static_cast<std::size_t>(id)];
  if (state == kOpen) {
    diagnostics_->report(Code::P0207, declared.node->name.span,
                         "set `" + std::string(declared.node->name.text) + "` is part of itself");
    return;
  }
  state = kOpen;
  Diagnostics* const heard = diagnostics_;
  if (preview_) diagnostics_ = &unheard_;
  std::vector<CutComparison> outer = take_cuts();
  std::vector<TaskId> members = read(*declared.file, declared.node->tasks);
  diagnostics_ = heard;
  context_.model.sets[id] = {std::string(declared.node->name.text), declared.node->name.span,
                             std::move(members), std::exchange(cuts_, std::move(outer)),
                             !declared.decl->complete};
  state = kDone;
}

std::vector<TaskId> SetReader::read(const syntax::File& file, syntax::TaskSetId id) {
  if (id.value == syntax::TaskSetId::kNone) return {};  // a syntax error, reported
  const Level level(context_);
  return std::visit([&](const auto& node) { return read_node(file, file[id].span, node); },
                    file[id].node);
}

SetReader::Members SetReader::read_node(const syntax::File&, const Span&,
                                        const syntax::TaskSetNames& names) {
  Members members;
  Mask seen(context_.model.tasks.size());
  for (const syntax::Name& name : names.names) {
    const auto found = context_.symbols.tasks.find(name, *diagnostics_);
    if (!found) continue;
    const auto id = static_cast<TaskId>(*found);
    if (seen.has(id)) {
      diagnostics_
          ->report(Code::P0203, name.span,
                   "`" + std::string(name.text) + "` is listed twice")
          .severity = Severity::kWarning;  // it is one member, as it is in a union
      continue;
    }
    if (context_.symbols.task_decls[*found].abstract) {
      diagnostics_
          ->report(Situation::kAbstractMember, name.span,
                   "`" + std::string(name.text) + "` is abstract: it is copied, never run")
          .label(context_.symbols.task_decls[*found].name.span, "declared here")
          .help("name the tasks that are `like " + std::string(name.text) + "`");
      continue;
    }
    seen.add(id);
    members.push_back(id);
  }
  return members;
}
SetReader::Members SetReader::read_node(const syntax::File& file, const Span&,
                                        const syntax::TaskSetName& set) {
  if (set.name.text.empty()) return {};  // a syntax error, reported
  if (set.name.text == "tasks") {
    const std::set<FileId> visible = visible_files(context_.files, file);
    Members members;
    for (std::size_t i = 0; i < context_.model.tasks.size(); ++i) {
      const Task& task = context_.model.tasks[static_cast<TaskId>(i)];
      if (!task.abstract && !task.name.empty() && visible.contains(task.file))
        members.push_back(static_cast<TaskId>(i));
    }
    return members;
  }
  const std::size_t said = diagnostics_->size();
  const auto found = context_.symbols.sets.find(set.name, *diagnostics_);
  if (!found) {
    const auto is_it = [&](const Task& task) { return task.name == set.name.text; };
    if (diagnostics_->size() > said && std::ranges::any_of(context_.model.tasks, is_it)) {
      const std::string braced = "{ " + std::string(set.name.text) + " }";
      Diagnostic& unknown = (*diagnostics_)[said];
      unknown.point("a task: `" + braced + "` is the set of it")
          .fix_by("write `" + braced + "`", set.name.span, braced);
    }
    return {};
  }
  if (context_.levels > kMaxLevels && states_[*found] == kNew) {
    report_levels(*diagnostics_, set.name.span);
    return {};
  }
  define(static_cast<SetId>(*found));
  const TaskSet& read = context_.model.sets[static_cast<SetId>(*found)];
  cuts_.insert(cuts_.end(), read.cuts.begin(), read.cuts.end());
  return read.members;
}
SetReader::Members SetReader::read_node(const syntax::File& file, const Span&,
                                        const syntax::TaskSetVariants& variants) {
  const Mask of(context_.model.tasks.size(), read(file, variants.of));
  // A file that uses this one may add variants; the set here does not grow by them.
  const std::set<FileId> visible = visible_files(context_.files, file);
  Members members;
  for (std::size_t i = 0; i < context_.model.tasks.size(); ++i) {
    const Task& task = context_.model.tasks[static_cast<TaskId>(i)];
    if (!task.abstract && task.baseline != TaskId::kNone && of.has(task.baseline) &&
        visible.contains(task.file))
      members.push_back(static_cast<TaskId>(i));
  }
  return members;
}
SetReader::Members SetReader::read_node(const syntax::File& file, const Span& span,
                                        const syntax::TaskSetSample& sample) {
  if (sample.of.value == syntax::TaskSetId::kNone) return {};  // a syntax error, reported
  Members members = read(file, sample.of);
  if (sample.count.value > members.size()) {
    diagnostics_
        ->report(Situation::kSampleTooLarge, sample.count.span,
                 "a sample of " + std::to_string(sample.count.value) + " from a set of " +
                     std::to_string(members.size()) + " tasks")
        .label(file[sample.of].span, "this set");
    return members;
  }
  // Every task draws its own number from its name, so that a new task displaces at most one.
  std::vector<std::pair<Sha256, TaskId>> draws;
  for (const TaskId id : members) {
    Hasher hasher;
    hasher.text("sample").u64(sample.seed.value).text(context_.model.tasks[id].name);
    draws.emplace_back(hasher.finish(), id);
  }
  std::sort(draws.begin(), draws.end());
  draws.resize(sample.count.value);
  Mask kept(context_.model.tasks.size());
  for (const auto& [draw, id] : draws) kept.add(id);
  std::erase_if(members, [&](TaskId id) { return !kept.has(id); });
  if (sample.with_baselines) {
    add_baselines(members);
    // All are there; `where` and `-` may still take them out again.
    for (const TaskId id : members) {
      if (context_.model.tasks[id].baseline != TaskId::kNone) cuts_.push_back({id, span});
    }
    return members;
  }
  for (const TaskId id : members) {
    const TaskId baseline = context_.model.tasks[id].baseline;
    if (baseline != TaskId::kNone && !kept.has(baseline)) cuts_.push_back({id, span});
  }
  return members;
}
SetReader::Members SetReader::read_node(const syntax::File& file, const Span&,
                                        const syntax::TaskSetBinary& binary) {
  Members left = read(file, binary.left);
  const Members right = read(file, binary.right);
  if (binary.op == syntax::SetOp::kUnion) {
    const Mask here(context_.model.tasks.size(), left);
    for (const TaskId id : right) {
      if (!here.has(id)) left.push_back(id);
    }
    return left;
  }
  const Mask there(context_.model.tasks.size(), right);
  const bool keep = binary.op == syntax::SetOp::kIntersection;
  std::erase_if(left, [&](TaskId id) { return there.has(id) != keep; });
  return left;
}
SetReader::Members SetReader::read_node(const syntax::File& file, const Span&,
                                        const syntax::TaskSetWhere& where) {
  Members members = read(file, where.set);
  if (!check_condition(file, where.condition)) return {};
  std::erase_if(members,
                [&](TaskId id) { return !holds(file, where.condition, context_.model.tasks[id]); });
  return members;
}

bool SetReader::check_condition(const syntax::File& file, syntax::CondId id) {
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
  std::vector<std::string> axes_of_roles;
  const char* kind = "";
  switch (test.kind) {
    case syntax::CondKind::kAxis:
      kind = "axis";
      for (const plan::AxisInfo& axis : plan::kAxisTable) words.push_back(axis.name);
      for (const syntax::Name& role : context_.symbols.roles.names()) {
        axes_of_roles.push_back("object." + std::string(role.text));
      }
      words.insert(words.end(), axes_of_roles.begin(), axes_of_roles.end());
      break;
    case syntax::CondKind::kUses:
      kind = "use of language";
      for (const plan::AxisInfo& axis : plan::kAxisTable) {
        if (axis.is_language()) words.push_back(axis.word());
      }
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
        return context_.symbols.scenes.find(test.path.parts[0], *diagnostics_).has_value();
      }
      kind = "scene";
      break;
    case syntax::CondKind::kMetrics:
      if (test.path.parts.size() == 1) {
        return context_.symbols.metrics.find(test.path.parts[0], *diagnostics_).has_value();
      }
      kind = "metrics";
      break;
  }
  const std::string text = path_text(test.path);
  if (std::find(words.begin(), words.end(), text) != words.end()) return true;
  report_unknown(*diagnostics_, kind, {test.path.span, text}, words);
  return false;
}

bool SetReader::holds(const syntax::File& file, syntax::CondId id, const Task& task) const {
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

bool SetReader::holds(const syntax::CondTest& test, const Task& task) const {
  const Model& model = context_.model;
  const std::string word = path_text(test.path);
  switch (test.kind) {
    case syntax::CondKind::kAxis:
      if (const plan::AxisInfo* axis = plan::find_axis(word))
        return plan::moves(task.axes, axis->axis);
      return plan::moves(task.axes, plan::Axis::kObjectOther) &&
             other_moves(model, task, model.tasks[task.baseline],
                         *find_role(model, word.substr(word.find('.') + 1)));
    case syntax::CondKind::kUses:
      return uses(model, task, plan::find_language_axis(word)->axis);
    case syntax::CondKind::kOod:
      return (task.ood & (word == "source" ? 1u : word == "target" ? 2u : 4u)) != 0;
    case syntax::CondKind::kHas:
      return word == "distractors" ? !task.distractors.empty() || !task.part_distractors.empty() : task.baseline != TaskId::kNone;
    case syntax::CondKind::kScene:
      return model.scenes[task.scene].name == word;
    case syntax::CondKind::kMetrics:
      return model.metrics[task.metrics].name == word;
  }
  return false;
}

void define_sets(Context& context) {
  const std::size_t count = context.symbols.set_decls.size();
  SetReader reader(context, SetReader::Mode::kDefine);
  for (std::size_t i = 0; i < count; ++i) reader.define(static_cast<SetId>(i));
}

}  // namespace probe::sema
