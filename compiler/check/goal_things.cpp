#include "compiler/check/goal_things.h"

namespace probe::sema {

Things GoalThings::things(ExprRef ref, const Given& given) const {
  if (ref == kNoExpr) return {};
  const ExprNode& node = at(ref);
  Things found;
  const auto fixture = static_cast<FixtureId>(node.a);
  switch (node.op) {
    case ExprOp::kRole: {
      const auto filled = task_.objects_in(static_cast<RoleId>(node.a));
      found.insert(filled.begin(), filled.end());
      break;
    }
    case ExprOp::kObject:
      found.insert(static_cast<ObjectId>(node.a));
      break;
    case ExprOp::kPart:
      found.insert(model_.fixtures[fixture].parts[node.b].thing);
      break;
    case ExprOp::kRegion:
      found.insert(model_.fixtures[fixture].regions[node.b].thing);
      break;
    case ExprOp::kJoint:
      for (const Fixture::Part& part : model_.fixtures[fixture].parts) {
        if (part.joint == node.b) found.insert(part.thing);
      }
      break;
    case ExprOp::kVariable:
      if (node.a < given.size()) found = given[node.a];
      break;
    case ExprOp::kAny:
    case ExprOp::kAll:
    case ExprOp::kNo: {
      Given inner = given;
      bind(inner, node.a, things_in(node.set, given));
      found = things(node.args[0], inner);
      break;
    }
    default:
      for (const ExprRef arg : node.args) found.merge(things(arg, given));
  }
  found.erase(ObjectId::kNone);
  return found;
}

Things GoalThings::things_in(SetRef ref, const Given& given) const {
  const SetNode& set = model_.exprs.sets[ref];
  Things found;
  if (set.op == SetOp::kRole) {
    const auto filled = task_.objects_in(set.role);
    found.insert(filled.begin(), filled.end());
  }
  for (const ExprRef body : set.bodies) found.merge(things(body, given));
  // As it is lowered: those that a joint moves.
  if (set.op == SetOp::kParts) {
    for (const FixtureId id : model_.scenes[task_.scene].fixtures) {
      for (const Fixture::Part& part : model_.fixtures[id].parts) {
        if (part.declared && part.joint) found.insert(part.thing);
      }
    }
    found.erase(ObjectId::kNone);
  }
  if (set.op == SetOp::kDifference && is_certain(set.left) && is_certain(set.right)) {
    found = things_in(set.left, given);
    for (const ObjectId one : things_in(set.right, given)) found.erase(one);
  }
  if (set.op == SetOp::kUnion) {
    found = things_in(set.left, given);
    found.merge(things_in(set.right, given));
  }
  return found;
}

bool GoalThings::is_certain(SetRef ref) const {
  const SetNode& set = model_.exprs.sets[ref];
  switch (set.op) {
    case SetOp::kUnion:
    case SetOp::kDifference:
      return is_certain(set.left) && is_certain(set.right);
    default:
      return set.op == SetOp::kRole || set.op == SetOp::kNames || set.op == SetOp::kParts;
  }
}

Given GoalThings::given_to(const ExprNode& call, const Given& given) const {
  Given inner(called(call).variables);
  for (std::uint32_t i = 0; i < call.args.size(); ++i) bind(inner, i, things(call.args[i], given));
  return inner;
}

}  // namespace probe::sema
