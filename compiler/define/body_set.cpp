// Sets of bodies, over which quantifiers go.
#include <algorithm>

#include "compiler/define/expr.h"
#include "compiler/define/role.h"
#include "compiler/define/thing.h"

namespace probe::sema {
namespace {

constexpr std::pair<std::string_view, SetOp> kSets[] = {
    {"fingers", SetOp::kFingers}, {"links", SetOp::kLinks},   {"bodies", SetOp::kBodies},
    {"objects", SetOp::kObjects}, {"others", SetOp::kOthers}, {"distractors", SetOp::kDistractors},
    {"alike", SetOp::kAlike},     {"parts", SetOp::kParts},
};

}  // namespace

bool ExprReader::only_objects(SetRef ref) {
  const SetNode& set = arena().sets[ref];
  switch (set.op) {
    case SetOp::kObjects:
    case SetOp::kOthers:
    case SetOp::kDistractors:
    case SetOp::kAlike:
    case SetOp::kRole:
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

bool ExprReader::may_have_parts(SetRef ref) {
  const SetNode& set = arena().sets[ref];
  switch (set.op) {
    case SetOp::kDistractors:
      return context_.model.has_part_distractors;
    case SetOp::kRole:
      return context_.model.roles[set.role].takes_things;
    case SetOp::kUnion:
      return may_have_parts(set.left) || may_have_parts(set.right);
    case SetOp::kIntersection:
      return may_have_parts(set.left) && may_have_parts(set.right);
    case SetOp::kDifference:
      return may_have_parts(set.left);
    default:
      return false;
  }
}

bool ExprReader::only_parts(SetRef ref) {
  const SetNode& set = arena().sets[ref];
  switch (set.op) {
    case SetOp::kParts:
      return true;
    case SetOp::kNames:
      return std::ranges::all_of(set.bodies,
                                 [&](ExprRef body) { return node(body).type.is_part; });
    case SetOp::kUnion:
      return only_parts(set.left) && only_parts(set.right);
    case SetOp::kIntersection:
      return only_parts(set.left) || only_parts(set.right);
    case SetOp::kDifference:
      return only_parts(set.left);
    default:
      return false;
  }
}

// `carrot` or `cabinet.top_drawer`.
ExprRef ExprReader::read_thing(const syntax::Name& name) {
  const auto of = halves_of(name);
  return of ? read_node(name.span, syntax::ExprPath{of->first, of->second})
            : read_node(name.span, syntax::ExprName{name});
}

std::optional<SetRef> ExprReader::read_set(syntax::SetExprId id) {
  if (id.value == syntax::SetExprId::kNone) return std::nullopt;
  const syntax::SetExpr& written = file_[id];
  SetNode set;
  set.span = written.span;
  if (const auto* names = std::get_if<syntax::SetNames>(&written.node)) {
    set.op = SetOp::kNames;
    for (const syntax::Name& name : names->names) {
      const ExprRef body =
          expect(read_thing(name), TypeKind::kBody, "a body");
      if (is_poison(body)) return std::nullopt;
      set.bodies.push_back(body);
    }
  } else if (const auto* whole = std::get_if<syntax::SetWhole>(&written.node)) {
    set.op = SetOp::kWhole;
    const ExprRef thing = read_thing(whole->name);
    if (is_poison(thing)) return std::nullopt;
    const Type& type = node(thing).type;
    if (type.kind != TypeKind::kBody && type.kind != TypeKind::kRegion) {
      context_
          .report(Code::P0601, whole->name.span,
                  "expected a body or a region, found " + type_name(type))
          .point("`whole` is all bodies of a thing");
      return std::nullopt;
    }
    set.bodies.push_back(thing);
  } else if (const auto* name = std::get_if<syntax::SetName>(&written.node)) {
    std::vector<std::string_view> candidates;
    bool found = false;
    for (const auto& [text, op] : kSets) {
      if (op == SetOp::kAlike && !is_relation_) continue;
      candidates.push_back(text);
      if (text != name->name.text) continue;
      set.op = op;
      found = true;
    }
    if (const auto role = find_role(context_, name->name.text); role && !found) {
      set.op = SetOp::kRole;
      set.role = *role;
      found = true;
    }
    for (const Role& role : context_.model.roles) candidates.push_back(role.name);
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

}  // namespace probe::sema
