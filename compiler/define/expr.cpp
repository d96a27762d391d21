#include "compiler/define/expr.h"

#include <algorithm>

#include "compiler/define/role.h"
#include "compiler/model/moving_joint.h"

namespace probe::sema {

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
      return type.is_object ? "an object" : type.is_part ? "a part" : "a body";
    case TypeKind::kJoint:
      return "a joint";
    case TypeKind::kRegion:
      return "a region";
  }
  return {};
}

void ExprReader::add_variable(std::string_view name, const Type& type) {
  scope_.push_back({name, type, variables_++});
}

ExprRef ExprReader::read(syntax::ExprId id) {
  // Left out by a syntax error, which has been reported.
  if (id.value == syntax::ExprId::kNone) return poison({});
  const syntax::Expr& expr = file_[id];
  const Level level(context_);
  return std::visit([&](const auto& node) { return read_node(expr.span, node); }, expr.node);
}

ExprRef ExprReader::add(ExprNode node) {
  for (const ExprRef arg : node.args)
    node.height = std::max(node.height, arena().nodes[arg].height + 1);
  arena().nodes.push_back(std::move(node));
  return static_cast<ExprRef>(arena().nodes.size() - 1);
}

ExprRef ExprReader::add(ExprOp op, const Type& type, const Span& span, std::vector<ExprRef> args,
                        std::uint32_t a) {
  ExprNode node;
  node.op = op;
  node.type = type;
  node.span = span;
  node.args = std::move(args);
  node.a = a;
  return add(std::move(node));
}

ExprRef ExprReader::expect(ExprRef ref, TypeKind kind, const char* wanted) {
  const Type type = node(ref).type;
  if (type.kind == TypeKind::kPoison || type.kind == kind) return ref;
  context_.report(Code::P0601, node(ref).span,
                  std::string("expected ") + wanted + ", found " + type_name(type));
  return poison(node(ref).span);
}

ExprRef ExprReader::plain(ExprRef ref) {
  if (!node(ref).type.is_angle_between) return ref;
  context_.report(Code::P0601, node(ref).span, "`angle` stands alone on one side of a comparison")
      .help("write `angle(u, v) <= 60deg`");
  return poison(node(ref).span);
}

bool ExprReader::same_dimension(ExprRef left, ExprRef right) {
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

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprNumber& number) {
  if (number.value.unit == syntax::Unit::kUnknown) return poison(span);
  const auto quantity = make_quantity(number.value.digits, to_text(number.value.unit));
  if (!quantity) {
    context_.report(Situation::kTooManyDigits, span,
                    "more digits or a larger exponent than is kept");
    return poison(span);
  }
  arena().quantities.push_back(*quantity);
  return add(ExprOp::kConstant, real_type(quantity->dimension), span, {},
             static_cast<std::uint32_t>(arena().quantities.size() - 1));
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprName& name) {
  for (auto variable = scope_.rbegin(); variable != scope_.rend(); ++variable) {
    if (variable->name == name.name.text)
      return add(ExprOp::kVariable, variable->type, span, {}, variable->index);
  }
  if (const auto ref = body_name(name.name)) return *ref;
  for (const MeasureInfo& measure : all_measures()) {
    if (measure.name != name.name.text) continue;
    if (measure.params.empty()) return add_measure(span, measure, {});
    context_
        .report(Code::P0601, span, "`" + std::string(measure.name) + "` is measured of something")
        .help("write `" + std::string(measure.name) + "(...)`");
    return poison(span);
  }
  if (const auto ref = named_body(name.name)) return *ref;
  std::vector<std::string_view> candidates = role_names(context_);
  candidates.push_back("surface");
  for (const syntax::Name& object : context_.symbols.objects.names())
    candidates.push_back(object.text);
  for (const syntax::Name& known : context_.symbols.fixtures.names())
    candidates.push_back(known.text);
  for (const Variable& variable : scope_) candidates.push_back(variable.name);
  for (const MeasureInfo& measure : all_measures()) {
    if (measure.params.empty()) candidates.push_back(measure.name);
  }
  Diagnostic& unknown = report_unknown(context_.diagnostics, "name", name.name, candidates);
  if (name.name.text == "success")
    unknown.help(
        "no metric reads another: what several share is a `predicate`, which each of them calls");
  return poison(span);
}

// An object or a fixture by its own name; whether it is in the scene is asked of each task.
std::optional<ExprRef> ExprReader::named_body(const syntax::Name& name) {
  if (const auto object = context_.symbols.objects.peek(name.text)) {
    arena().names_objects = true;
    return add(ExprOp::kObject, {TypeKind::kBody, dim::kNumber, true}, name.span, {}, *object);
  }
  const auto& scenes = context_.model.scenes;
  const bool is_fixture = std::any_of(scenes.begin(), scenes.end(), [&](const Scene& scene) {
    return scene.fixture && scene.fixture->text == name.text;
  });
  if (!is_fixture) return std::nullopt;
  arena().names_objects = true;
  return add(ExprOp::kFixture, {TypeKind::kBody, dim::kNumber, false}, name.span);
}

std::optional<ExprRef> ExprReader::body_name(const syntax::Name& name) {
  if (const auto role = find_role(context_, name.text)) {
    if (context_.model.roles[*role].is_set) {
      context_
          .report(Code::P1105, name.span,
                  "`" + std::string(name.text) + "` is a set, and one object is wanted here")
          .label(context_.model.roles[*role].span, "declared as a set")
          .help("ask of each: `all o in " + std::string(name.text) + ": ...`");
      return poison(name.span);
    }
    Type type{TypeKind::kBody, dim::kNumber, true};
    type.is_open = context_.model.roles[*role].takes_things;
    return add(ExprOp::kRole, type, name.span, {}, static_cast<std::uint32_t>(*role));
  }
  // The fixture itself is the part that its root link is.
  if (const auto found = context_.symbols.fixtures.peek(name.text)) {
    const auto id = static_cast<FixtureId>(*found);
    const Fixture& fixture = context_.model.fixtures[id];
    if (fixture.broken) return poison(name.span);
    for (std::size_t i = 0; i < fixture.parts.size(); ++i) {
      if (fixture.parts[i].index == fixture.model->root)
        return add_of(ExprOp::kPart, {TypeKind::kBody, dim::kNumber}, name.span, id, i);
    }
    context_
        .report(Situation::kUntouchable, name.span,
                "the root link of `" + fixture.name + "` has no collision, it is no body")
        .help("name one of its parts: `" + fixture.name + ".PART`");
    return poison(name.span);
  }
  if (name.text == "surface")
    return add(ExprOp::kSurface, {TypeKind::kBody, dim::kNumber, false}, name.span);
  return std::nullopt;
}

ExprRef ExprReader::add_of(ExprOp op, const Type& type, const Span& span, FixtureId fixture,
                           std::size_t which) {
  const ExprRef ref = add(op, type, span, {}, static_cast<std::uint32_t>(fixture));
  arena().nodes[ref].b = static_cast<std::uint32_t>(which);
  return ref;
}

// `cabinet.top`: a part, a joint or a region of a fixture.
ExprRef ExprReader::of_fixture(const Span& span, FixtureId id, const syntax::Name& name) {
  const Fixture& fixture = context_.model.fixtures[id];
  if (fixture.broken) return poison(span);
  std::vector<std::string_view> known;
  for (std::size_t i = 0; i < fixture.parts.size(); ++i) {
    const Fixture::Part& part = fixture.parts[i];
    if (!part.declared) continue;
    known.push_back(part.name);
    if (part.name != name.text) continue;
    Type type{TypeKind::kBody, dim::kNumber};
    type.is_part = true;
    return add_of(ExprOp::kPart, type, span, id, i);
  }
  for (std::size_t i = 0; i < fixture.joints.size(); ++i) {
    known.push_back(fixture.joints[i].name);
    if (fixture.joints[i].name == name.text)
      return add_of(ExprOp::kJoint, {TypeKind::kJoint, dim::kNumber}, span, id, i);
  }
  for (std::size_t i = 0; i < fixture.regions.size(); ++i) {
    known.push_back(fixture.regions[i].region.name);
    if (fixture.regions[i].region.name == name.text)
      return add_of(ExprOp::kRegion, {TypeKind::kRegion, dim::kNumber}, span, id, i);
  }
  report_unknown(context_.diagnostics, "part, joint or region of `" + fixture.name + "`", name,
                 known)
      .label(fixture.span, "the fixture");
  return poison(span);
}

// Of whatever stands there in the task: its regions are looked up when that is known.
ExprRef ExprReader::region_of(const Span& span, ExprRef body, const syntax::Name& name) {
  arena().names.emplace_back(name.text);
  const auto index = static_cast<std::uint32_t>(arena().names.size() - 1);
  return add(ExprOp::kRegionOf, {TypeKind::kRegion, dim::kNumber}, span, {body}, index);
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprPath& path) {
  const std::string_view owner = path.owner.text;
  const bool is_variable =
      std::ranges::any_of(scope_, [&](const Variable& variable) { return variable.name == owner; });
  if (!is_variable) {
    if (const auto fixture = context_.symbols.fixtures.peek(owner))
      return of_fixture(span, static_cast<FixtureId>(*fixture), path.name);
    if (owner == "fixture") {
      const ExprRef body = add(ExprOp::kStanding, {TypeKind::kBody, dim::kNumber}, span);
      return region_of(span, body, path.name);
    }
  }
  const ExprRef body =
      expect(read_node(path.owner.span, syntax::ExprName{path.owner}), TypeKind::kBody, "a body");
  if (is_poison(body)) return poison(span);
  return region_of(span, body, path.name);
}

ExprRef ExprReader::read_node(const Span& span, const syntax::ExprCall& call) {
  for (const MeasureInfo& measure : all_measures()) {
    // Texts that are older than these have predicates of such names.
    const bool is_own = measure.measure >= Measure::kTravel &&
                        context_.symbols.predicates.peek(call.callee.text).has_value();
    if (measure.name == call.callee.text && !is_own) return read_measure(span, call, measure);
  }
  if (const auto predicate = context_.symbols.predicates.peek(call.callee.text)) {
    return read_predicate(span, call, static_cast<PredicateId>(*predicate));
  }
  std::vector<std::string_view> candidates;
  for (const syntax::Name& known : context_.symbols.predicates.names())
    candidates.push_back(known.text);
  for (const MeasureInfo& measure : all_measures()) candidates.push_back(measure.name);
  report_unknown(context_.diagnostics, "predicate", call.callee, candidates);
  return poison(span);
}

ExprRef ExprReader::read_measure(const Span& span, const syntax::ExprCall& call,
                                 const MeasureInfo& measure) {
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

bool ExprReader::argument_fits(const MeasureInfo& measure, std::size_t i, ExprRef arg) {
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
    case 'J':
      fits = type.kind == TypeKind::kJoint || type.is_part || type.is_open;
      wanted = "a joint or a part";
      break;
    case 'G':
      fits = type.kind == TypeKind::kRegion || type.is_open, wanted = "a region";
      break;
    case 'F':
      fits = is_body || type.kind == TypeKind::kRegion, wanted = "a body or a region";
      break;
    case 'C':
      fits = type.kind == TypeKind::kBool, wanted = "a condition";
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

// A length or an angle where the joint is known; of a parameter neither yet.
Dimension ExprReader::travel_of(ExprRef ref) const {
  const ExprNode& at = node(ref);
  if (at.op != ExprOp::kPart && at.op != ExprOp::kJoint) return dim::kTravel;
  const Fixture& fixture = context_.model.fixtures[static_cast<FixtureId>(at.a)];
  std::optional<std::uint32_t> joint = at.b;
  if (at.op == ExprOp::kPart) joint = fixture.parts[at.b].joint;
  if (!joint) return dim::kTravel;
  return fixture.joints[*joint].slides ? dim::kLength : dim::kAngle;
}

ExprRef ExprReader::add_measure(const Span& span, const MeasureInfo& measure,
                                std::vector<ExprRef> args) {
  // A parameter's part is known where the predicate is unrolled.
  if (measure.params.starts_with("J") && node(args[0]).op == ExprOp::kPart) {
    const ExprNode& at = node(args[0]);
    const Fixture& fixture = context_.model.fixtures[static_cast<FixtureId>(at.a)];
    if (const Fixture::Part& part = fixture.parts[at.b]; !part.joint) {
      context_.report(Code::P0601, span, no_travel(fixture, part));
      return poison(span);
    }
  }
  Type type;
  type.kind = measure.result == 'v'   ? TypeKind::kVector
              : measure.result == 'b' ? TypeKind::kBool
                                      : TypeKind::kReal;
  type.dimension =
      measure.params.starts_with("R") ? node(args[0]).type.dimension : measure.dimension;
  type.is_angle_between = measure.result == 'a';
  if (measure.result == 't' || measure.result == 's') {
    type.dimension = travel_of(args[0]);
    if (measure.result == 's') type.dimension = type.dimension / dim::kTime;
  }
  const ExprRef ref = add(ExprOp::kMeasure, type, span, std::move(args));
  arena().nodes[ref].measure = measure.measure;
  arena().needs_frame = arena().needs_frame || is_of_frame(measure.measure);
  return ref;
}

}  // namespace probe::sema
