#include "compiler/check/shared.h"

#include "compiler/define/template.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

// The relations that a metric measures, through the predicates that it calls.
void collect_relations(const Model& model, ExprRef ref, std::set<ExprRef>& seen,
                       std::set<PredicateId>& out) {
  if (ref == kNoExpr || !seen.insert(ref).second) return;
  const ExprNode& node = model.exprs.nodes[ref];
  for (const ExprRef arg : node.args) collect_relations(model, arg, seen, out);
  if (node.op != ExprOp::kCall) return;
  if (model.predicates[node.predicate].is_relation) {
    out.insert(node.predicate);
  } else {
    collect_relations(model, model.predicates[node.predicate].body, seen, out);
  }
}

// What an instruction says beside its slots, which say themselves how many they mean.
std::string literal_text(const Template& say) {
  std::string text;
  for (const Template::Part& part : say.parts) {
    text += part.literal + " ";
    if (!part.slot || part.slot->avoid) continue;
    if (part.slot->count == syntax::SlotCount::kBoth) text += "both ";
    if (part.slot->count == syntax::SlotCount::kAll) text += "all ";
  }
  return text;
}

// The parts that success measures: by themselves, by their joint or by a region of theirs.
void collect_parts(const Model& model, ExprRef ref, std::set<ExprRef>& seen,
                   std::set<PartOf>& out) {
  if (ref == kNoExpr || !seen.insert(ref).second) return;
  const ExprNode& node = model.exprs.nodes[ref];
  const auto fixture = static_cast<FixtureId>(node.a);
  if (node.op == ExprOp::kPart) out.insert({fixture, node.b});
  if (node.op == ExprOp::kRegion)
    out.insert({fixture, model.fixtures[fixture].regions[node.b].part});
  if (node.op == ExprOp::kJoint) {
    const auto& parts = model.fixtures[fixture].parts;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      if (parts[i].joint == node.b) out.insert({fixture, i});
    }
  }
  if (node.op == ExprOp::kAny || node.op == ExprOp::kAll || node.op == ExprOp::kNo) {
    for (const ExprRef body : model.exprs.sets[node.set].bodies)
      collect_parts(model, body, seen, out);
  }
  for (const ExprRef arg : node.args) collect_parts(model, arg, seen, out);
  if (node.op == ExprOp::kCall)
    collect_parts(model, model.predicates[node.predicate].body, seen, out);
}

bool all(ObjectId) { return true; }

}  // namespace

template <typename IsTold>
Shared::Filled Shared::filled(const Task& task, IsTold is_told) const {
  Filled by_role = {static_cast<std::uint32_t>(task.scene)};
  for (std::size_t i = 0; i < model_.roles.size(); ++i) {
    const auto objects = task.objects_in(model_.roles.id(i));
    by_role.push_back(static_cast<std::uint32_t>(objects.size()));
    for (const ObjectId id : objects) {
      if (is_told(id)) by_role.push_back(static_cast<std::uint32_t>(id));
    }
  }
  return by_role;
}

const Shared::Text& Shared::text(TemplateId say) {
  const auto [at, is_new] = texts_.try_emplace(say);
  if (!is_new) return at->second;
  at->second.folded = fold_case(literal_text(model_.templates[say]));
  for (const GoalWords& one : kGoalWords) {
    if (has_words(at->second.folded, one.words)) at->second.words.push_back(one);
  }
  return at->second;
}

std::vector<ExprRef> Shared::success_of(const Task& task) {
  std::vector<ExprRef> found;
  for (const Metric& metric : task.judged) {
    if (metric.name == "success") found.push_back(metric.expr);
  }
  return found;
}

const std::set<PredicateId>& Shared::relations(const std::vector<ExprRef>& success) {
  const auto [at, is_new] = relations_.try_emplace(success);
  std::set<ExprRef> seen;
  if (is_new) {
    for (const ExprRef expr : success) collect_relations(model_, expr, seen, at->second);
  }
  return at->second;
}

const std::set<PartOf>& Shared::parts(const std::vector<ExprRef>& success) {
  const auto [at, is_new] = parts_.try_emplace(success);
  std::set<ExprRef> seen;
  if (is_new) {
    for (const ExprRef expr : success) collect_parts(model_, expr, seen, at->second);
  }
  return at->second;
}

const Goal& Shared::goal(const Task& task) {
  std::pair<std::vector<Judged>, Filled> key;
  for (const Metric& metric : task.judged)
    key.first.emplace_back(metric.name == "success", metric.expr, metric.readout);
  key.second = filled(task, all);
  const auto [at, is_new] = goals_.try_emplace(std::move(key));
  if (is_new) at->second = goal_of(model_, task);
  return at->second;
}

const Said& Shared::said(const Task& task) {
  const auto [at, is_new] = said_.try_emplace(heard_key(task));
  if (is_new) at->second = said_by(model_, task);
  return at->second;
}

const Clauses& Shared::clauses(const Task& task) {
  const auto [at, is_new] = clauses_.try_emplace(heard_key(task));
  if (is_new) at->second = clauses_of(model_, task, callings_);
  return at->second;
}

Shared::ClauseKey Shared::clause_key(const Task& task) const {
  Filled by_role =
      filled(task, [&](ObjectId id) { return model_.exprs.names_objects || !task.is_object(id); });
  // The layout says what lies on what.
  by_role.push_back(static_cast<std::uint32_t>(task.layout));
  return {task.say, success_of(task), std::move(by_role)};
}

Shared::HeardKey Shared::heard_key(const Task& task) const {
  return {task.say, filled(task, all), task.objects()};
}

}  // namespace probe::sema
