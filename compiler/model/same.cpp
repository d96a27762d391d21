#include "compiler/model/same.h"

#include <set>
#include <utility>

namespace probe::sema {
namespace {

// Recursion is bounded by the height of expressions, through predicates by kMaxLevels.
struct Comparison {
  const Model& model;
  std::set<std::pair<ExprRef, ExprRef>> same = {};  // predicates are called many times

  bool nodes(ExprRef left, ExprRef right) {
    if (left == right || same.contains({left, right})) return true;
    if (left == kNoExpr || right == kNoExpr) return false;
    const ExprNode& a = model.exprs.nodes[left];
    const ExprNode& b = model.exprs.nodes[right];
    if (a.op != b.op || a.args.size() != b.args.size() || !heads(a, b)) return false;
    for (std::size_t i = 0; i < a.args.size(); ++i) {
      if (!nodes(a.args[i], b.args[i])) return false;
    }
    same.insert({left, right});
    return true;
  }

  // What a node says beside its operands.
  bool heads(const ExprNode& a, const ExprNode& b) {
    switch (a.op) {
      case ExprOp::kConstant: {
        const Quantity& one = model.exprs.quantities[a.a];
        const Quantity& other = model.exprs.quantities[b.a];
        return one.dimension == other.dimension && one.si() == other.si();
      }
      case ExprOp::kMeasure:
        return a.measure == b.measure;
      case ExprOp::kCall:
        return a.predicate == b.predicate ||
               nodes(model.predicates[a.predicate].body, model.predicates[b.predicate].body);
      case ExprOp::kAny:
      case ExprOp::kAll:
      case ExprOp::kNo:
        return a.a == b.a && sets(a.set, b.set);
      case ExprOp::kRegionOf:
        return model.exprs.names[a.a] == model.exprs.names[b.a];
      default:
        return a.a == b.a && a.b == b.b;
    }
  }

  bool sets(SetRef left, SetRef right) {
    if (left == right) return true;
    const SetNode& a = model.exprs.sets[left];
    const SetNode& b = model.exprs.sets[right];
    if (a.op != b.op || a.role != b.role || a.bodies.size() != b.bodies.size()) return false;
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
      if (!nodes(a.bodies[i], b.bodies[i])) return false;
    }
    const bool is_pair =
        a.op == SetOp::kUnion || a.op == SetOp::kIntersection || a.op == SetOp::kDifference;
    return !is_pair || (sets(a.left, b.left) && sets(a.right, b.right));
  }
};

}  // namespace

bool same_expression(const Model& model, ExprRef a, ExprRef b) {
  return Comparison{model}.nodes(a, b);
}

}  // namespace probe::sema
