#include "compiler/define/query.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

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

// A relation that need not hold would be words that need not be true.
bool has_relation(const Query& query, std::size_t from) {
  return std::any_of(query.begin() + static_cast<std::ptrdiff_t>(from), query.end(),
                     [](const QueryOp& op) { return op.kind == QueryOp::kRelation; });
}

}  // namespace

// The relation of that name. Its first object is the one that is described.
std::optional<std::uint32_t> find_relation(const Context& context, std::string_view name) {
  const auto found = context.symbols.predicates.peek(name);
  if (!found || !context.symbols.predicate_decls[*found].node->is_relation) return std::nullopt;
  return found;
}

// False when something was reported.
bool compile_relation(Context& context, std::uint32_t relation, const syntax::Name& name,
                      std::span<const syntax::Name> objects, Query& out) {
  const syntax::PredicateDecl& node = *context.symbols.predicate_decls[relation].node;
  const std::size_t wanted = objects_of(node);
  if (objects.size() + 1 != wanted) {
    context
        .report(
            Situation::kRelationObjects, name.span,
            "`" + std::string(name.text) + "` takes " +
                (wanted < 2 ? "no object"
                            : std::to_string(wanted - 1) + (wanted == 2 ? " object" : " objects")) +
                " behind the one that is described, found " + std::to_string(objects.size()))
        .label(node.name.span, "declared here");
    return false;
  }
  QueryOp op{QueryOp::kRelation, relation};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!context.symbols.objects.peek(objects[i].text) &&
        context.symbols.fixtures.peek(objects[i].text)) {
      context
          .report(Situation::kRelationObjects, objects[i].span,
                  "`" + std::string(objects[i].text) + "` is a fixture, and `" +
                      std::string(name.text) + "` in a phrase takes objects")
          .help(
              "a phrase can say where something is among objects; the words of an instruction can "
              "name a fixture or a part");
      return false;
    }
    const auto object = context.symbols.objects.find(objects[i], context.diagnostics);
    if (!object) return false;
    if (i > 0 && op.to[0] == static_cast<ObjectId>(*object)) {
      context.report(
          Situation::kRelationObjects, objects[i].span,
          "`" + std::string(name.text) + "` is given `" + std::string(objects[i].text) + "` twice");
      return false;
    }
    op.to[i] = static_cast<ObjectId>(*object);
  }
  out.push_back(op);
  return true;
}

// The depth is bounded by the parser.
bool compile_query(Context& context, const syntax::File& file, syntax::QueryId id, Query& out) {
  const std::size_t from = out.size();
  const auto may_not_hold = [&] {
    if (!has_relation(out, from)) return false;
    context.report(Situation::kRelationOpen, file[id].span,
                   "a relation in a phrase holds: it stands alone or behind `and`, not under "
                   "`not` or `or`");
    return true;
  };
  if (id.value == syntax::QueryId::kNone) return false;  // a syntax error, reported
  const auto& node = file[id].node;
  if (const auto* fact = std::get_if<syntax::QueryFact>(&node)) {
    if (!context.symbols.facts.peek(fact->fact.text)) {
      if (const auto relation = find_relation(context, fact->fact.text))
        return compile_relation(context, *relation, fact->fact, {}, out);
    }
    const auto found = context.symbols.facts.find(fact->fact, context.diagnostics);
    if (!found) return false;
    out.push_back({QueryOp::kFact, *found, 0});
    return true;
  }
  if (const auto* placed = std::get_if<syntax::QueryRelation>(&node)) {
    if (const auto relation = find_relation(context, placed->relation.text))
      return compile_relation(context, *relation, placed->relation, placed->objects, out);
    std::vector<std::string_view> known;
    for (const auto& declared : context.symbols.predicate_decls) {
      if (declared.node->is_relation) known.push_back(declared.node->name.text);
    }
    report_unknown(context.diagnostics, "relation", placed->relation, known);
    return false;
  }
  if (const auto* value = std::get_if<syntax::QueryValue>(&node)) {
    if (!context.symbols.attributes.peek(value->attribute.text)) {
      if (const auto relation = find_relation(context, value->attribute.text))
        return compile_relation(context, *relation, value->attribute, {&value->value, 1}, out);
    }
    const auto attribute = context.symbols.attributes.find(value->attribute, context.diagnostics);
    if (!attribute) return false;
    const auto found = find_value(context, static_cast<AttributeId>(*attribute), value->value);
    if (!found) return false;
    out.push_back({QueryOp::kValue, *attribute, *found});
    return true;
  }
  if (const auto* negation = std::get_if<syntax::QueryNot>(&node)) {
    if (!compile_query(context, file, negation->operand, out)) return false;
    if (may_not_hold()) return false;
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
  return binary(either.left, either.right, QueryOp::kOr) && !may_not_hold();
}

Truth evaluate(const Query& query, const Object& object) {
  return evaluate(query, object, [](const QueryOp&) { return Truth::kUnknown; });
}

Truth evaluate(const Query& query, const Object& object,
               const std::function<Truth(const QueryOp&)>& placed) {
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
      case QueryOp::kRelation:
        stack.push_back(placed(op));
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

namespace {

// A piece of a query, and whether it is so of an object.
struct Wanted {
  std::string text;  // "category toy", "not heavy", "between(plate, towel)"
  Truth truth = Truth::kUnknown;
  std::optional<AttributeId> attribute = {};  // whose value it is
};

// The pieces that `and` joins.
std::vector<Wanted> wanted_of(const Model& model, const Query& query, const Object& object,
                              const std::function<Truth(const QueryOp&)>& placed) {
  std::vector<std::vector<Wanted>> stack;
  const auto pop = [&stack] {
    std::vector<Wanted> top = std::move(stack.back());
    stack.pop_back();
    return top;
  };
  // Several as one.
  const auto joined = [](const std::vector<Wanted>& all) {
    Wanted one{{}, Truth::kYes};
    for (const Wanted& piece : all) {
      one.text += (one.text.empty() ? "" : " and ") + piece.text;
      one.truth = std::min(one.truth, piece.truth);
    }
    if (all.size() > 1) one.text = "(" + one.text + ")";
    return one;
  };
  for (const QueryOp& op : query) {
    switch (op.kind) {
      case QueryOp::kFact:
        stack.push_back({{model.facts[op.a], object.facts[op.a]}});
        break;
      case QueryOp::kValue: {
        const auto id = static_cast<AttributeId>(op.a);
        const Attribute& attribute = model.attributes[id];
        stack.push_back(
            {{attribute.name + " " + attribute.values[op.b], has_value(object, op.a, op.b), id}});
        break;
      }
      case QueryOp::kRelation: {
        std::string text = model.predicates[static_cast<PredicateId>(op.a)].name;
        std::string to;
        for (const ObjectId other : op.to) {
          if (other != ObjectId::kNone) to += (to.empty() ? "" : ", ") + model.objects[other].name;
        }
        if (!to.empty()) text += "(" + to + ")";
        stack.push_back({{text, placed(op)}});
        break;
      }
      case QueryOp::kNot: {
        const Wanted one = joined(pop());
        stack.push_back({{"not " + one.text, negate(one.truth)}});
        break;
      }
      case QueryOp::kAnd: {
        const std::vector<Wanted> right = pop();
        stack.back().insert(stack.back().end(), right.begin(), right.end());
        break;
      }
      case QueryOp::kOr: {
        const Wanted right = joined(pop()), left = joined(pop());
        stack.push_back(
            {{"(" + left.text + " or " + right.text + ")", std::max(left.truth, right.truth)}});
        break;
      }
    }
  }
  return stack.empty() ? std::vector<Wanted>() : std::move(stack.back());
}

}  // namespace

std::string lack_of(const Model& model, const Query& query, const Object& object,
                    const std::function<Truth(const QueryOp&)>& placed) {
  std::string lacks, has;
  for (const Wanted& piece : wanted_of(model, query, object, placed)) {
    if (piece.truth != Truth::kNo) continue;
    lacks += (lacks.empty() ? "`" : ", `") + piece.text + "`";
    if (!piece.attribute) continue;
    const Attribute& attribute = model.attributes[*piece.attribute];
    const auto& values = object.values[static_cast<std::size_t>(*piece.attribute)];
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i == 0) has += (has.empty() ? ", whose " : ", ") + attribute.name + " is ";
      has += (i == 0 ? "" : " and ") + attribute.values[values[i]];
    }
  }
  return lacks.empty() ? std::string() : lacks + " is not true of `" + object.name + "`" + has;
}

}  // namespace probe::sema
