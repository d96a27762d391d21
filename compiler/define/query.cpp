#include "compiler/define/query.h"

#include <algorithm>

#include "compiler/define/attribute.h"

namespace probe::sema {
namespace {

Truth negate(Truth value) {
  if (value == Truth::kUnknown) return value;
  return value == Truth::kYes ? Truth::kNo : Truth::kYes;
}

Truth has_value(const Object& object, std::uint32_t attribute, std::uint32_t value) {
  const auto& values = object.values[attribute];
  if (values.empty()) return Truth::kUnknown;
  return std::find(values.begin(), values.end(), value) != values.end() ? Truth::kYes : Truth::kNo;
}

}  // namespace

// The depth is bounded by the parser.
bool compile_query(Context& context, const syntax::File& file, syntax::QueryId id, Query& out) {
  if (id.value == syntax::QueryId::kNone) return false;  // a syntax error, reported
  const auto& node = file[id].node;
  if (const auto* fact = std::get_if<syntax::QueryFact>(&node)) {
    const auto found = context.symbols.facts.find(fact->fact, context.diagnostics);
    if (!found) return false;
    out.push_back({QueryOp::kFact, *found, 0});
    return true;
  }
  if (const auto* value = std::get_if<syntax::QueryValue>(&node)) {
    const auto attribute = context.symbols.attributes.find(value->attribute, context.diagnostics);
    if (!attribute) return false;
    const auto found = find_value(context, static_cast<AttributeId>(*attribute), value->value);
    if (!found) return false;
    out.push_back({QueryOp::kValue, *attribute, *found});
    return true;
  }
  if (const auto* negation = std::get_if<syntax::QueryNot>(&node)) {
    if (!compile_query(context, file, negation->operand, out)) return false;
    out.push_back({QueryOp::kNot, 0, 0});
    return true;
  }
  const auto binary = [&](syntax::QueryId left, syntax::QueryId right, QueryOp::Kind kind) {
    if (!compile_query(context, file, left, out) || !compile_query(context, file, right, out))
      return false;
    out.push_back({kind, 0, 0});
    return true;
  };
  if (const auto* both = std::get_if<syntax::QueryAnd>(&node))
    return binary(both->left, both->right, QueryOp::kAnd);
  const auto& either = std::get<syntax::QueryOr>(node);
  return binary(either.left, either.right, QueryOp::kOr);
}

Truth evaluate(const Query& query, const Object& object) {
  std::vector<Truth> stack;
  const auto pop = [&stack] {
    const Truth top = stack.back();
    stack.pop_back();
    return top;
  };
  for (const QueryOp& op : query) {
    switch (op.kind) {
      case QueryOp::kFact:
        stack.push_back(object.facts[op.a]);
        break;
      case QueryOp::kValue:
        stack.push_back(has_value(object, op.a, op.b));
        break;
      case QueryOp::kNot:
        stack.push_back(negate(pop()));
        break;
      // Ordered no < unknown < yes, "and" is the least and "or" the largest.
      case QueryOp::kAnd:
        stack.push_back(std::min(pop(), pop()));
        break;
      case QueryOp::kOr:
        stack.push_back(std::max(pop(), pop()));
        break;
    }
  }
  return stack.empty() ? Truth::kUnknown : stack.back();
}

}  // namespace probe::sema
