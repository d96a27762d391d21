// `predicate`: read when first called, so that their order in the text does not matter.
#include <algorithm>

#include "compiler/define/define.h"
#include "compiler/define/expr.h"

namespace probe::sema {
namespace {

Type type_of(const syntax::Param& param) {
  switch (param.type) {
    case syntax::ParamType::kObject:
      return {TypeKind::kBody, dim::kNumber, true};
    case syntax::ParamType::kBody:
      return {TypeKind::kBody, dim::kNumber, false};
    case syntax::ParamType::kPart: {
      Type type{TypeKind::kBody, dim::kNumber};
      type.is_part = true;
      return type;
    }
    case syntax::ParamType::kRegion:
      return {TypeKind::kRegion, dim::kNumber};
    case syntax::ParamType::kLength:
      return real_type(dim::kLength);
    case syntax::ParamType::kAngle:
      return real_type(dim::kAngle);
    case syntax::ParamType::kTime:
      return real_type(dim::kTime);
    case syntax::ParamType::kImpulse:
      return real_type(dim::kImpulse);
    case syntax::ParamType::kNumber:
      return real_type(dim::kNumber);
  }
  return Type{};
}

// What fills an open role is known of each task alone: there it is looked at again.
bool is_taken(const Type& wanted, const Type& found) {
  const bool is_thing = wanted.kind == TypeKind::kBody || wanted.kind == TypeKind::kRegion;
  if (found.is_open && is_thing) return true;
  return found.kind == wanted.kind &&
         !(wanted.kind == TypeKind::kBody &&
           ((wanted.is_object && !found.is_object) || (wanted.is_part && !found.is_part)));
}

// Predicates are read when first called, so their order in the text does not matter. A span that is
// set and a body that is not: being read right now.
void read_body(Context& context, PredicateId id) {
  const auto& declared = context.symbols.predicate_decls[static_cast<std::size_t>(id)];
  const syntax::PredicateDecl& node = *declared.node;
  {
    Predicate& predicate = context.model.predicates[id];
    if (!predicate.name.empty()) return;
    predicate.name = std::string(node.name.text);
    predicate.span = node.name.span;
  }
  const auto errors = context.mistakes();
  ExprReader reader(context, *declared.file);
  if (node.is_relation) reader.read_relation();
  std::vector<Parameter> parameters;
  for (const syntax::Param& param : node.params) {
    Parameter parameter{std::string(param.name.text), type_of(param), kNoExpr};
    if (param.default_value) {
      ExprReader alone(context, *declared.file);
      const ExprRef value = alone.number(*param.default_value);
      const Type found = alone.node(value).type;
      if (found.kind == TypeKind::kReal && !(found.dimension == parameter.type.dimension)) {
        context
            .report(Code::P0302, alone.node(value).span,
                    "expected " + name_of(parameter.type.dimension) + ", found " +
                        name_of(found.dimension))
            .label(param.type_span, "declared here");
      } else {
        parameter.default_value = value;
      }
    }
    reader.add_variable(param.name.text, parameter.type);
    parameters.push_back(std::move(parameter));
  }
  context.model.predicates[id].parameters = std::move(parameters);
  const ExprRef body = reader.read(node.body);
  Predicate& predicate = context.model.predicates[id];
  predicate.body = body;
  predicate.variables = reader.variables();
  predicate.type = context.model.exprs.nodes[body].type;
  if (node.is_relation) check_relation(context, node, predicate);
  predicate.broken = !declared.decl->complete || context.mistakes() != errors;
}

}  // namespace

ExprRef ExprReader::read_predicate(const Span& span, const syntax::ExprCall& call, PredicateId id) {
  if (context_.levels > kMaxLevels && context_.model.predicates[id].name.empty()) {
    report_levels(context_.diagnostics, call.callee.span);
    return poison(span);
  }
  read_body(context_, id);
  const Predicate& predicate = context_.model.predicates[id];
  if (predicate.body == kNoExpr) {
    context_
        .report(Code::P0601, call.callee.span,
                "predicate `" + predicate.name + "` is part of its own meaning")
        .label(predicate.span, "declared here");
    return poison(span);
  }
  if (predicate.broken) return poison(span);
  std::vector<ExprRef> args(predicate.parameters.size(), kNoExpr);
  std::size_t next = 0;
  bool fits = predicate.type.kind != TypeKind::kPoison;
  for (const syntax::Argument& argument : call.arguments) {
    std::size_t at = next++;
    if (argument.name) {
      const auto& parameters = predicate.parameters;
      at = 0;
      while (at < parameters.size() && parameters[at].name != argument.name->text) ++at;
      if (at == parameters.size()) {
        std::vector<std::string_view> candidates;
        for (const Parameter& parameter : parameters) candidates.push_back(parameter.name);
        report_unknown(context_.diagnostics, "parameter of `" + predicate.name + "`",
                       *argument.name, candidates);
        return poison(span);
      }
    }
    if (at >= args.size() || args[at] != kNoExpr) {
      context_.report(Code::P0601, argument.span,
                      at >= args.size() ? "`" + predicate.name + "` takes " +
                                              std::to_string(args.size()) + " arguments"
                                        : "`" + predicate.parameters[at].name + "` is given twice");
      return poison(span);
    }
    const ExprRef value = plain(read(argument.value));
    const Type wanted = context_.model.predicates[id].parameters[at].type;
    const Type found = node(value).type;
    args[at] = value;
    if (found.kind == TypeKind::kPoison) {
      fits = false;
    } else if (!is_taken(wanted, found)) {
      context_
          .report(Code::P0601, argument.span,
                  "expected " + type_name(wanted) + ", found " + type_name(found))
          .label(predicate.span, "`" + predicate.parameters[at].name + "` of this predicate");
      fits = false;
    } else if (wanted.kind == TypeKind::kReal && !(wanted.dimension == found.dimension)) {
      context_
          .report(Code::P0302, argument.span,
                  "expected " + type_name(wanted) + ", found " + type_name(found))
          .label(predicate.span, "`" + predicate.parameters[at].name + "` of this predicate");
      fits = false;
    }
  }
  for (std::size_t i = 0; i < args.size(); ++i) {
    if (args[i] == kNoExpr) args[i] = predicate.parameters[i].default_value;
    if (args[i] != kNoExpr) continue;
    context_
        .report(Code::P0601, span,
                "`" + predicate.name + "` needs `" + predicate.parameters[i].name + "`")
        .label(predicate.span, "declared here");
    return poison(span);
  }
  if (!fits) return poison(span);
  const std::uint32_t height = node(predicate.body).height + 1;
  if (height > kMaxLevels) {
    report_levels(context_.diagnostics, call.callee.span);
    return poison(span);
  }
  const ExprRef ref = add(ExprOp::kCall, predicate.type, span, std::move(args));
  arena().nodes[ref].predicate = id;
  arena().nodes[ref].height = std::max(node(ref).height, height);
  return ref;
}

void define_predicates(Context& context) {
  const Symbols& symbols = context.symbols;
  for (std::size_t i = 0; i < symbols.predicate_decls.size(); ++i) context.model.predicates.add({});
  for (std::size_t i = 0; i < symbols.predicate_decls.size(); ++i)
    read_body(context, static_cast<PredicateId>(i));
}

}  // namespace probe::sema
