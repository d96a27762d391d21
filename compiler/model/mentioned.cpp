#include "compiler/model/mentioned.h"

namespace probe::sema {

void Mentioned::add(const Mentioned& other) {
  roles.insert(other.roles.begin(), other.roles.end());
  objects.insert(other.objects.begin(), other.objects.end());
  if (!fixture) fixture = other.fixture;
}

const Mentioned& MentionedIn::expression(ExprRef ref) {
  const auto [at, is_new] = known_.try_emplace(ref);
  if (is_new && ref != kNoExpr) {
    Mentioned found;
    look(ref, found);
    known_[ref] = std::move(found);
  }
  return known_[ref];
}

const Mentioned& MentionedIn::metrics(std::span<const Metric* const> metrics) {
  std::vector<ExprRef> key;
  key.reserve(metrics.size());
  for (const Metric* metric : metrics) key.push_back(metric->expr);
  const auto [at, is_new] = together_.try_emplace(std::move(key));
  if (is_new) {
    for (const ExprRef expr : at->first) at->second.add(expression(expr));
  }
  return at->second;
}

// Recursion is bounded by the height of expressions; a predicate's body is looked at once.
void MentionedIn::look(ExprRef ref, Mentioned& out) {
  const ExprNode& node = model_.exprs.nodes[ref];
  switch (node.op) {
    case ExprOp::kRole:
      out.roles.try_emplace(static_cast<RoleId>(node.a), node.span);
      break;
    case ExprOp::kObject:
      out.objects.try_emplace(static_cast<ObjectId>(node.a), node.span);
      break;
    case ExprOp::kFixture:
      if (!out.fixture) out.fixture = node.span;
      break;
    case ExprOp::kCall:
      if (model_.predicates[node.predicate].body != kNoExpr)
        out.add(expression(model_.predicates[node.predicate].body));
      break;
    case ExprOp::kAny:
    case ExprOp::kAll:
    case ExprOp::kNo:
      look_at_set(node.set, out);
      break;
    default:
      break;
  }
  for (const ExprRef arg : node.args) look(arg, out);
}

void MentionedIn::look_at_set(SetRef ref, Mentioned& out) {
  const SetNode& set = model_.exprs.sets[ref];
  if (set.op == SetOp::kRole) out.roles.try_emplace(set.role, set.span);
  for (const ExprRef body : set.bodies) look(body, out);
  const bool is_pair =
      set.op == SetOp::kUnion || set.op == SetOp::kIntersection || set.op == SetOp::kDifference;
  if (!is_pair) return;
  look_at_set(set.left, out);
  look_at_set(set.right, out);
}

}  // namespace probe::sema
