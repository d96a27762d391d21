// "open" and "close", held to which way success wants a joint to have moved.
#include <algorithm>
#include <set>

#include "compiler/check/word_lacks.h"

namespace probe::sema {
namespace {

// Which way success goes: a joint's travel at least so much, or at most.
struct JointGoal {
  const Model& model;
  bool opens = false, closes = false, is_open_ended = false;
  std::set<ExprRef> seen = {};

  bool has_travel(ExprRef ref) const {
    const ExprNode& node = model.exprs.nodes[ref];
    if (node.op == ExprOp::kMeasure &&
        (node.measure == Measure::kTravel || node.measure == Measure::kSlide ||
         node.measure == Measure::kTurn))
      return true;
    return std::ranges::any_of(node.args, [&](ExprRef arg) { return has_travel(arg); });
  }
  void look(ExprRef ref) {
    if (ref == kNoExpr || !seen.insert(ref).second) return;
    const ExprNode& node = model.exprs.nodes[ref];
    // What is denied, latched or one of several ways says nothing for certain.
    is_open_ended = is_open_ended || node.op == ExprOp::kNot || node.op == ExprOp::kOr ||
                    node.op == ExprOp::kOnce || node.op == ExprOp::kNo;
    if (node.op == ExprOp::kLess || node.op == ExprOp::kLessEqual) {
      const bool less = has_travel(node.args[0]), more = has_travel(node.args[1]);
      closes = closes || (less && !more);
      opens = opens || (more && !less);
      return;
    }
    for (const ExprRef arg : node.args) look(arg);
    if (node.op == ExprOp::kCall) look(model.predicates[node.predicate].body);
  }
};

}  // namespace

std::optional<std::string> joint_word_lack(Told& told, const GoalWords& one) {
  if (!told.tells_to(one)) return std::nullopt;
  const Asks asks = one.asks;
  JointGoal travels{told.model()};
  for (const Metric& metric : told.task().judged) {
    if (metric.name == "success") travels.look(metric.expr);
  }
  if (travels.opens == travels.closes || travels.is_open_ended) return std::nullopt;
  if (told.says(Asks::kOpens) == told.says(Asks::kCloses) ||
      travels.opens == (asks == Asks::kOpens))
    return std::nullopt;
  return std::string("succeeds when a joint's travel is ") +
         (travels.opens ? "at least so much" : "at most so much");
}

}  // namespace probe::sema
