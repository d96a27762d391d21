#include "compiler/define/judgement.h"

#include <algorithm>

#include "compiler/define/passes.h"
#include "runtime/plan/readouts.h"

namespace probe::sema {
namespace {

const MeasureInfo kMeasures[] = {
#define PROBE_MEASURE(id, name, params, result, length, time, angle, mass, meaning) \
  {Measure::id, name, params, result, {length, time, angle, mass, 0}, meaning},
#include "compiler/model/measures.def"
};

constexpr std::pair<std::string_view, SetOp> kSets[] = {
    {"fingers", SetOp::kFingers}, {"links", SetOp::kLinks},   {"bodies", SetOp::kBodies},
    {"objects", SetOp::kObjects}, {"others", SetOp::kOthers}, {"distractors", SetOp::kDistractors},
};

const Type kBoolType{TypeKind::kBool, dim::kNumber};
const Type kPoisonType{};

Type real(const Dimension& dimension) { return {TypeKind::kReal, dimension}; }

std::string type_name(const Type& type) {
  switch (type.kind) {
    case TypeKind::kPoison:
      return "nothing";
    case TypeKind::kBool:
      return "a condition";
    case TypeKind::kReal:
      return name_of(type.dimension);
    case TypeKind::kVector:
      return type.dimension == dim::kNumber ? "a direction"
                                            : "a vector of " + name_of(type.dimension).substr(2);
    case TypeKind::kBody:
      return type.is_object ? "an object" : "a body";
  }
  return {};
}

Type type_of(const syntax::Param& param) {
  switch (param.type) {
    case syntax::ParamType::kObject:
      return {TypeKind::kBody, dim::kNumber, true};
    case syntax::ParamType::kBody:
      return {TypeKind::kBody, dim::kNumber, false};
    case syntax::ParamType::kLength:
      return real(dim::kLength);
    case syntax::ParamType::kAngle:
      return real(dim::kAngle);
    case syntax::ParamType::kTime:
      return real(dim::kTime);
    case syntax::ParamType::kImpulse:
      return real(dim::kImpulse);
    case syntax::ParamType::kNumber:
      return real(dim::kNumber);
  }
  return kPoisonType;
}

// Reads the expressions of one predicate or metric. Recursion is bounded by the parser's depth, and
// through the predicates that are called by kMaxLevels.
class ExprReader {
 public:
  struct Variable {
    std::string_view name;
    Type type;
    std::uint32_t index;
  };

  ExprReader(Context& context, const syntax::File& file) : context_(context), file_(file) {}

  void add_variable(std::string_view name, const Type& type) {
    scope_.push_back({name, type, variables_++});
  }
  std::uint32_t variables() const { return variables_; }

  ExprRef condition(syntax::ExprId id) { return expect(read(id), TypeKind::kBool, "a condition"); }
  ExprRef number(syntax::ExprId id) { return expect(read(id), TypeKind::kReal, "a number"); }

  ExprRef read(syntax::ExprId id) {
    // Left out by a syntax error, which has been reported.
    if (id.value == syntax::ExprId::kNone) return poison({});
    const syntax::Expr& expr = file_[id];
    const Level level(context_);
    return std::visit([&](const auto& node) { return read_node(expr.span, node); }, expr.node);
  }

  const ExprNode& node(ExprRef ref) const { return context_.model.exprs.nodes[ref]; }

 private:
  ExprArena& arena() { return context_.model.exprs; }

  ExprRef add(ExprNode node) {
    for (const ExprRef arg : node.args)
      node.height = std::max(node.height, arena().nodes[arg].height + 1);
    arena().nodes.push_back(std::move(node));
    return static_cast<ExprRef>(arena().nodes.size() - 1);
  }
  ExprRef add(ExprOp op, const Type& type, const Span& span, std::vector<ExprRef> args = {},
              std::uint32_t a = 0) {
    ExprNode node;
    node.op = op;
    node.type = type;
    node.span = span;
    node.args = std::move(args);
    node.a = a;
    return add(std::move(node));
  }
  ExprRef poison(const Span& span) { return add(ExprOp::kPoison, kPoisonType, span); }
  bool is_poison(ExprRef ref) const { return node(ref).type.kind == TypeKind::kPoison; }

  // One mistake, one message: poison passes silently.
  ExprRef expect(ExprRef ref, TypeKind kind, const char* wanted) {
    const Type type = node(ref).type;
    if (type.kind == TypeKind::kPoison || type.kind == kind) return ref;
    context_.report(Code::P0601, node(ref).span,
                    std::string("expected ") + wanted + ", found " + type_name(type));
    return poison(node(ref).span);
  }
  // `angle(u, v)` has no value of its own on the judge: only its comparison with a constant has.
  ExprRef plain(ExprRef ref) {
    if (!node(ref).type.is_angle_between) return ref;
    context_.report(Code::P0601, node(ref).span, "`angle` stands alone on one side of a comparison")
        .help("write `angle(u, v) <= 60deg`");
    return poison(node(ref).span);
  }
  bool same_dimension(ExprRef left, ExprRef right) {
    const Type a = node(left).type;
    const Type b = node(right).type;
    if (a.dimension == b.dimension) return true;
    // The literal is the one to correct.
    const bool left_is_literal = node(left).op == ExprOp::kConstant;
    const ExprRef wrong = left_is_literal ? left : right;
    const Dimension& wanted = left_is_literal ? b.dimension : a.dimension;
    Diagnostic& diagnostic =
        context_.report(Code::P0302, node(wrong).span,
                        "expected " + name_of(wanted) + ", found " +
                            name_of(left_is_literal ? a.dimension : b.dimension));
    diagnostic.label(node(left_is_literal ? right : left).span, "this is " + name_of(wanted));
    if (node(wrong).op == ExprOp::kConstant && node(wrong).type.dimension == dim::kNumber &&
        !usual_unit(wanted).empty()) {
      diagnostic.help("a unit touches its number: `" +
                      std::string(context_.sources.text(node(wrong).span)) +
                      std::string(usual_unit(wanted)) + "`");
    }
    return false;
  }

  ExprRef read_node(const Span& span, const syntax::ExprNumber& number) {
    if (number.value.unit == syntax::Unit::kUnknown) return poison(span);
    const auto quantity = make_quantity(number.value.digits, to_text(number.value.unit));
    if (!quantity) {
      context_.report(Code::P0304, span, "more digits or a larger exponent than is kept");
      return poison(span);
    }
    arena().quantities.push_back(*quantity);
    return add(ExprOp::kConstant, real(quantity->dimension), span, {},
               static_cast<std::uint32_t>(arena().quantities.size() - 1));
  }

  ExprRef read_node(const Span& span, const syntax::ExprName& name) {
    for (auto variable = scope_.rbegin(); variable != scope_.rend(); ++variable) {
      if (variable->name == name.name.text)
        return add(ExprOp::kVariable, variable->type, span, {}, variable->index);
    }
    if (const auto ref = body_name(name.name)) return *ref;
    for (const MeasureInfo& measure : kMeasures) {
      if (measure.name != name.name.text) continue;
      if (measure.params.empty()) return add_measure(span, measure, {});
      context_
          .report(Code::P0601, span, "`" + std::string(measure.name) + "` is measured of something")
          .help("write `" + std::string(measure.name) + "(...)`");
      return poison(span);
    }
    std::vector<std::string_view> candidates = {"source", "target", "surface"};
    for (const Variable& variable : scope_) candidates.push_back(variable.name);
    for (const MeasureInfo& measure : kMeasures) {
      if (measure.params.empty()) candidates.push_back(measure.name);
    }
    report_unknown(context_.diagnostics, "name", name.name, candidates);
    return poison(span);
  }

  std::optional<ExprRef> body_name(const syntax::Name& name) {
    if (name.text == "source" || name.text == "target") {
      const std::uint32_t role = name.text == "source" ? 0 : 1;
      return add(ExprOp::kRole, {TypeKind::kBody, dim::kNumber, true}, name.span, {}, role);
    }
    if (name.text == "surface")
      return add(ExprOp::kSurface, {TypeKind::kBody, dim::kNumber, false}, name.span);
    return std::nullopt;
  }

  ExprRef read_node(const Span& span, const syntax::ExprCall& call) {
    for (const MeasureInfo& measure : kMeasures) {
      if (measure.name == call.callee.text) return read_measure(span, call, measure);
    }
    if (const auto predicate = context_.symbols.predicates.peek(call.callee.text)) {
      return read_predicate(span, call, static_cast<PredicateId>(*predicate));
    }
    std::vector<std::string_view> candidates;
    for (const syntax::Name& known : context_.symbols.predicates.names())
      candidates.push_back(known.text);
    for (const MeasureInfo& measure : kMeasures) candidates.push_back(measure.name);
    report_unknown(context_.diagnostics, "predicate", call.callee, candidates);
    return poison(span);
  }

  ExprRef read_measure(const Span& span, const syntax::ExprCall& call, const MeasureInfo& measure) {
    std::vector<ExprRef> args;
    for (const syntax::Argument& argument : call.arguments) {
      if (argument.name) {
        context_.report(Code::P0601, argument.name->span,
                        "`" + std::string(measure.name) + "` has no named arguments");
        return poison(span);
      }
      args.push_back(plain(read(argument.value)));
    }
    if (args.size() != measure.params.size()) {
      context_.report(Code::P0601, span,
                      "`" + std::string(measure.name) + "` takes " +
                          std::to_string(measure.params.size()) + " arguments, found " +
                          std::to_string(args.size()));
      return poison(span);
    }
    bool fits = true;
    for (std::size_t i = 0; i < args.size(); ++i) fits = argument_fits(measure, i, args[i]) && fits;
    if (!fits) return poison(span);
    if (measure.params == "RR" && !same_dimension(args[0], args[1])) return poison(span);
    return add_measure(span, measure, std::move(args));
  }

  bool argument_fits(const MeasureInfo& measure, std::size_t i, ExprRef arg) {
    const Type& type = node(arg).type;
    if (type.kind == TypeKind::kPoison) return false;
    const bool is_body = type.kind == TypeKind::kBody;
    const bool is_point = type.kind == TypeKind::kVector && type.dimension == dim::kLength;
    const char* wanted = "";
    bool fits = false;
    switch (measure.params[i]) {
      case 'B':
        fits = is_body, wanted = "a body";
        break;
      case 'O':
        fits = is_body && type.is_object, wanted = "an object";
        break;
      case 'P':
        fits = is_body || is_point, wanted = "a body or a point";
        break;
      case 'V':
        fits = type.kind == TypeKind::kVector, wanted = "a vector";
        break;
      case 'R':
        fits = type.kind == TypeKind::kReal, wanted = "a number";
        break;
      default:
        break;
    }
    if (!fits) {
      context_
          .report(Code::P0601, node(arg).span,
                  std::string("expected ") + wanted + ", found " + type_name(type))
          .point("`" + std::string(measure.name) + "`: " + std::string(measure.meaning));
    }
    return fits;
  }

  ExprRef add_measure(const Span& span, const MeasureInfo& measure, std::vector<ExprRef> args) {
    Type type;
    type.kind = measure.result == 'v' ? TypeKind::kVector : TypeKind::kReal;
    type.dimension =
        measure.params.starts_with("R") ? node(args[0]).type.dimension : measure.dimension;
    type.is_angle_between = measure.result == 'a';
    const ExprRef ref = add(ExprOp::kMeasure, type, span, std::move(args));
    arena().nodes[ref].measure = measure.measure;
    return ref;
  }

  ExprRef read_predicate(const Span& span, const syntax::ExprCall& call, PredicateId id);

  ExprRef read_node(const Span& span, const syntax::ExprUnary& unary) {
    const ExprRef operand = plain(read(unary.operand));
    if (unary.op == syntax::UnaryOp::kNegate) {
      const Type type = node(operand).type;
      if (type.kind == TypeKind::kVector || is_poison(operand))
        return is_poison(operand) ? operand : negate_vector(span, operand);
      const ExprRef number = expect(operand, TypeKind::kReal, "a number");
      if (is_poison(number)) return number;
      return add(ExprOp::kNegate, real(type.dimension), span, {number});
    }
    const ExprRef condition = expect(operand, TypeKind::kBool, "a condition");
    if (is_poison(condition)) return condition;
    const ExprOp op = unary.op == syntax::UnaryOp::kNot    ? ExprOp::kNot
                      : unary.op == syntax::UnaryOp::kOnce ? ExprOp::kOnce
                                                           : ExprOp::kAlways;
    return add(op, kBoolType, span, {condition});
  }
  ExprRef negate_vector(const Span& span, ExprRef operand) {
    return add(ExprOp::kNegate, node(operand).type, span, {operand});
  }

  ExprRef read_node(const Span& span, const syntax::ExprBinary& binary) {
    using syntax::BinaryOp;
    if (binary.op == BinaryOp::kAnd || binary.op == BinaryOp::kOr) return logical(span, binary);
    const ExprRef left = read(binary.left);
    const ExprRef right = read(binary.right);
    if (is_poison(left) || is_poison(right)) return poison(span);
    if (binary.op >= BinaryOp::kLess && binary.op <= BinaryOp::kNotEqual)
      return comparison(span, binary.op, left, right);
    return arithmetic(span, binary, plain(left), plain(right));
  }

  ExprRef logical(const Span& span, const syntax::ExprBinary& binary) {
    const ExprRef left = condition(binary.left);
    const ExprRef right = condition(binary.right);
    if (is_poison(left) || is_poison(right)) return poison(span);
    return add(binary.op == syntax::BinaryOp::kAnd ? ExprOp::kAnd : ExprOp::kOr, kBoolType, span,
               {left, right});
  }

  ExprRef comparison(const Span& span, syntax::BinaryOp op, ExprRef left, ExprRef right) {
    using syntax::BinaryOp;
    left = expect(left, TypeKind::kReal, "a number");
    right = expect(right, TypeKind::kReal, "a number");
    if (is_poison(left) || is_poison(right)) return poison(span);
    if (node(left).type.is_angle_between && node(right).type.is_angle_between) {
      context_.report(Code::P0601, span, "`angle` is compared with a constant");
      return poison(span);
    }
    if (!same_dimension(left, right)) return poison(span);
    switch (op) {
      case BinaryOp::kLess:
        return add(ExprOp::kLess, kBoolType, span, {left, right});
      case BinaryOp::kLessEqual:
        return add(ExprOp::kLessEqual, kBoolType, span, {left, right});
      case BinaryOp::kGreater:
        return add(ExprOp::kLess, kBoolType, span, {right, left});
      case BinaryOp::kGreaterEqual:
        return add(ExprOp::kLessEqual, kBoolType, span, {right, left});
      default:
        break;
    }
    // Counts are whole numbers; anything measured in units is never equal twice.
    if (!(node(left).type.dimension == dim::kNumber)) {
      context_.report(Code::P0606, span, "measured values are compared for equality")
          .help("give a tolerance: `abs(a - b) <= 1mm`");
    }
    plain(left), plain(right);
    const ExprRef equal = add(ExprOp::kEqual, kBoolType, span, {left, right});
    return op == BinaryOp::kEqual ? equal : add(ExprOp::kNot, kBoolType, span, {equal});
  }

  ExprRef arithmetic(const Span& span, const syntax::ExprBinary& binary, ExprRef left,
                     ExprRef right) {
    using syntax::BinaryOp;
    const Type a = node(left).type;
    const Type b = node(right).type;
    if (is_poison(left) || is_poison(right)) return poison(span);
    const bool is_sum = binary.op == BinaryOp::kAdd || binary.op == BinaryOp::kSubtract;
    const ExprOp op = binary.op == BinaryOp::kAdd        ? ExprOp::kAdd
                      : binary.op == BinaryOp::kSubtract ? ExprOp::kSubtract
                      : binary.op == BinaryOp::kMultiply ? ExprOp::kMultiply
                                                         : ExprOp::kDivide;
    const bool numbers = a.kind == TypeKind::kReal && b.kind == TypeKind::kReal;
    const bool vectors = a.kind == TypeKind::kVector && b.kind == TypeKind::kVector;
    if (is_sum && (numbers || vectors)) {
      if (!same_dimension(left, right)) return poison(span);
      return add(op, a, span, {left, right});
    }
    if (op == ExprOp::kMultiply && numbers)
      return add(op, real(a.dimension * b.dimension), span, {left, right});
    if (op == ExprOp::kMultiply && a.kind == TypeKind::kVector && b.kind == TypeKind::kReal) {
      return add(op, {TypeKind::kVector, a.dimension * b.dimension}, span, {left, right});
    }
    if (op == ExprOp::kMultiply && a.kind == TypeKind::kReal && b.kind == TypeKind::kVector) {
      return add(op, {TypeKind::kVector, a.dimension * b.dimension}, span, {right, left});
    }
    if (op == ExprOp::kDivide && numbers)
      return add(op, real(a.dimension / b.dimension), span, {left, right});
    context_.report(
        Code::P0601, span,
        "found " + type_name(a) + " and " + type_name(b) + " where numbers are combined");
    return poison(span);
  }

  ExprRef read_node(const Span& span, const syntax::ExprHold& hold) {
    const ExprRef operand = condition(hold.operand);
    if (is_poison(operand)) return operand;
    if (hold.steps.value < 1 || hold.steps.value > 65535) {
      context_.report(Code::P0304, hold.steps.span, "expected 1 to 65535 steps");
      return poison(span);
    }
    return add(ExprOp::kHold, kBoolType, hold.for_span, {operand},
               static_cast<std::uint32_t>(hold.steps.value));
  }

  ExprRef read_node(const Span& span, const syntax::ExprBlock& block) {
    std::vector<ExprRef> conditions;
    bool fits = true;
    for (const syntax::ExprId id : block.conditions) {
      conditions.push_back(condition(id));
      fits = fits && !is_poison(conditions.back());
    }
    if (!fits || conditions.empty()) return poison(span);
    const bool all = block.quantifier == syntax::Quantifier::kAll;
    const ExprRef whole =
        add(all ? ExprOp::kAnd : ExprOp::kOr, kBoolType, span, std::move(conditions));
    return block.quantifier == syntax::Quantifier::kNo ? add(ExprOp::kNot, kBoolType, span, {whole})
                                                       : whole;
  }

  ExprRef read_node(const Span& span, const syntax::ExprQuantified& quantified) {
    const auto set = read_set(quantified.set);
    if (!set) return poison(span);
    const std::uint32_t index = variables_;
    add_variable(quantified.variable.text, {TypeKind::kBody, dim::kNumber, only_objects(*set)});
    const ExprRef body = condition(quantified.body);
    scope_.pop_back();
    if (is_poison(body)) return body;
    const ExprOp op = quantified.quantifier == syntax::Quantifier::kAny   ? ExprOp::kAny
                      : quantified.quantifier == syntax::Quantifier::kAll ? ExprOp::kAll
                                                                          : ExprOp::kNo;
    const ExprRef ref = add(op, kBoolType, span, {body}, index);
    arena().nodes[ref].set = *set;
    return ref;
  }

  bool only_objects(SetRef ref) {
    const SetNode& set = arena().sets[ref];
    switch (set.op) {
      case SetOp::kObjects:
      case SetOp::kOthers:
      case SetOp::kDistractors:
        return true;
      case SetOp::kNames:
        return std::all_of(set.bodies.begin(), set.bodies.end(),
                           [&](ExprRef body) { return node(body).type.is_object; });
      case SetOp::kUnion:
        return only_objects(set.left) && only_objects(set.right);
      case SetOp::kIntersection:
        return only_objects(set.left) || only_objects(set.right);
      case SetOp::kDifference:
        return only_objects(set.left);
      default:
        return false;
    }
  }

  std::optional<SetRef> read_set(syntax::SetExprId id) {
    if (id.value == syntax::SetExprId::kNone) return std::nullopt;
    const syntax::SetExpr& written = file_[id];
    SetNode set;
    set.span = written.span;
    if (const auto* names = std::get_if<syntax::SetNames>(&written.node)) {
      set.op = SetOp::kNames;
      for (const syntax::Name& name : names->names) {
        const ExprRef body =
            expect(read_node(name.span, syntax::ExprName{name}), TypeKind::kBody, "a body");
        if (is_poison(body)) return std::nullopt;
        set.bodies.push_back(body);
      }
    } else if (const auto* name = std::get_if<syntax::SetName>(&written.node)) {
      std::vector<std::string_view> candidates;
      bool found = false;
      for (const auto& [text, op] : kSets) {
        candidates.push_back(text);
        if (text != name->name.text) continue;
        set.op = op;
        found = true;
      }
      if (!found) {
        report_unknown(context_.diagnostics, "set of bodies", name->name, candidates);
        return std::nullopt;
      }
    } else {
      const auto& binary = std::get<syntax::SetBinary>(written.node);
      const auto left = read_set(binary.left);
      const auto right = read_set(binary.right);
      if (!left || !right) return std::nullopt;
      set.left = *left;
      set.right = *right;
      set.op = binary.op == syntax::SetOp::kUnion          ? SetOp::kUnion
               : binary.op == syntax::SetOp::kIntersection ? SetOp::kIntersection
                                                           : SetOp::kDifference;
    }
    arena().sets.push_back(std::move(set));
    return static_cast<SetRef>(arena().sets.size() - 1);
  }

  Context& context_;
  const syntax::File& file_;
  std::vector<Variable> scope_;
  std::uint32_t variables_ = 0;
};

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
  predicate.broken = !declared.decl->complete || context.mistakes() != errors;
}

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
    } else if (found.kind != wanted.kind ||
               (wanted.kind == TypeKind::kBody && wanted.is_object && !found.is_object)) {
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

}  // namespace

std::span<const MeasureInfo> all_measures() { return kMeasures; }

Metric analyze_metric(Context& context, const syntax::File& file, const syntax::MetricStmt& stmt) {
  Metric metric;
  metric.name = std::string(stmt.name.text);
  metric.span = stmt.name.span;
  metric.readout = stmt.readout.kind;
  metric.readout_span = stmt.readout.span;
  ExprReader reader(context, file);
  const bool takes_truth = plan::info(metric.readout).takes == plan::Kind::kBool;
  metric.expr =
      takes_truth ? reader.condition(stmt.readout.expr) : reader.number(stmt.readout.expr);
  metric.variables = reader.variables();
  metric.type = context.model.exprs.nodes[metric.expr].type;
  if (metric.type.is_angle_between) {
    context.report(Code::P0601, stmt.readout.span,
                   "`angle` stands alone on one side of a comparison");
  }
  return metric;
}

void define_judgement(Context& context) {
  const Symbols& symbols = context.symbols;
  for (std::size_t i = 0; i < symbols.predicate_decls.size(); ++i) context.model.predicates.add({});
  for (std::size_t i = 0; i < symbols.predicate_decls.size(); ++i)
    read_body(context, static_cast<PredicateId>(i));

  const auto& decls = symbols.metrics_decls;
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  for (std::size_t i = 0; i < decls.size(); ++i) {
    context.model.metrics.add({});
    if (decls[i].node->like)
      parents[i] = symbols.metrics.find(*decls[i].node->like, context.diagnostics);
  }
  for (const std::uint32_t i : parents_first(context, parents, symbols.metrics.names())) {
    const syntax::MetricsDecl& node = *decls[i].node;
    Metrics metrics;
    if (parents[i]) metrics.like = static_cast<MetricsId>(*parents[i]);
    if (parents[i])
      metrics.items = context.model.metrics[static_cast<MetricsId>(*parents[i])].items;
    metrics.name = std::string(node.name.text);
    metrics.span = node.name.span;
    metrics.broken =
        !decls[i].decl->complete || (node.like && !parents[i]) ||
        (parents[i] && context.model.metrics[static_cast<MetricsId>(*parents[i])].broken);
    const auto errors = context.mistakes();
    std::vector<std::string_view> here;
    for (const syntax::MetricStmt& stmt : node.body) {
      Metric metric = analyze_metric(context, *decls[i].file, stmt);
      if (std::find(here.begin(), here.end(), stmt.name.text) != here.end()) {
        context.report(Code::P0203, stmt.name.span,
                       "metric `" + metric.name + "` is declared twice");
        continue;
      }
      here.push_back(stmt.name.text);
      const auto known = std::find_if(metrics.items.begin(), metrics.items.end(),
                                      [&](const Metric& old) { return old.name == metric.name; });
      if (known != metrics.items.end()) {
        *known = std::move(metric);
      } else {
        metrics.items.push_back(std::move(metric));
      }
    }
    // A metric of a predicate that was reported has no meaning either.
    const auto is_poison = [&](const Metric& metric) {
      return metric.type.kind == TypeKind::kPoison;
    };
    metrics.broken = metrics.broken || context.mistakes() != errors ||
                     std::any_of(metrics.items.begin(), metrics.items.end(), is_poison);
    context.model.metrics[static_cast<MetricsId>(i)] = std::move(metrics);
  }
}

}  // namespace probe::sema
