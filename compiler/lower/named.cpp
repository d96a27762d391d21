// What names, roles and sets stand for among the bodies of a task.
#include <iterator>

#include "compiler/lower/lowering.h"
#include "compiler/model/moving_joint.h"

namespace probe::lower {

namespace {
constexpr auto kSourceRole = static_cast<std::uint32_t>(sema::RoleId::kSource);
}  // namespace

Value Lowering::in_role(const ExprNode& node) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (const Body::Filled& filled : bodies_[i].filled) {
      if (filled.role == node.a) return of_region(static_cast<std::uint16_t>(i), *filled.region);
    }
  }
  return only(node, [&](const Body& b) { return b.role == node.a; });
}

bool Lowering::fits(const Span& span, const Value& value, char wanted, std::string_view what) {
  const bool is_body = value.kind == Value::kBody;
  const auto is = [&](plan::BodyKind kind) { return is_body && bodies_[value.index].kind == kind; };
  const bool is_region = value.kind == Value::kRegion;
  const char* name = "";
  bool fits = true;
  switch (wanted) {
    case 'B':
      fits = is_body, name = "a body";
      break;
    case 'O':
      fits = is(plan::BodyKind::kObject), name = "an object";
      break;
    case 'P':
      fits = !is_region, name = "a body or a point";
      break;
    case 'J':
      fits = value.kind == Value::kJoint || is(plan::BodyKind::kPart), name = "a joint or a part";
      break;
    case 'A':
      fits = is(plan::BodyKind::kPart), name = "a part";
      break;
    case 'G':
      fits = is_region, name = "a region";
      break;
    case 'F':
      fits = is_body || is_region, name = "a body or a region";
      break;
    default:
      break;
  }
  if (fits || !ok_) return fits;
  const Body& body = bodies_[value.index];
  std::string found = "`" + body.name + "`";
  if (is_region) found = "region `" + value.region->name + "` of `" + body.name + "`";
  Diagnostic& said = diagnostics_.report(Code::P0601, span,
                                         std::string(what) + " takes " + name + ", found " + found);
  ok_ = false;
  // Of a set that has both, what is asked of objects alone is asked of its objects.
  if (body.kind == plan::BodyKind::kPart && body.role == kDistractorRole)
    said.help("`distractors & objects` are those without parts of fixtures, `distractors & parts` the parts");
  return false;
}

Value Lowering::surface() const {
  std::uint16_t at = 0;
  while (bodies_[at].kind != plan::BodyKind::kSurface) ++at;
  return Value::of_body(at);
}

Value Lowering::not_here(const ExprNode& node, const std::string& name) {
  if (ok_) {
    diagnostics_.report(Code::P0201, node.span, "`" + name + "` is not in the scene of this task")
        .help("a scene names its fixtures: `fixture " + name + "`");
  }
  ok_ = false;
  return Value::of_truth(false);
}

Value Lowering::part(const ExprNode& node) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    if (body.kind == plan::BodyKind::kPart && body.index == node.a && body.part == node.b)
      return Value::of_body(static_cast<std::uint16_t>(i));
  }
  return not_here(node, model_.fixtures[static_cast<sema::FixtureId>(node.a)].name);
}

Value Lowering::joint(const ExprNode& node, std::uint32_t fixture, std::uint32_t which) {
  std::size_t before = 0;
  std::uint32_t last = static_cast<std::uint32_t>(sema::FixtureId::kNone);
  for (const Body& body : bodies_) {
    if (body.kind != plan::BodyKind::kPart || body.index == last) continue;
    last = body.index;
    const auto& joints = model_.fixtures[static_cast<sema::FixtureId>(last)].joints;
    if (last == fixture) {
      Value value;
      value.kind = Value::kJoint;
      value.index = static_cast<std::uint16_t>(before + which);
      value.joint = &joints[which];
      return value;
    }
    before += joints.size();
  }
  return not_here(node, model_.fixtures[static_cast<sema::FixtureId>(fixture)].name);
}

Value Lowering::joint_of(const ExprNode& node, const Value& value) {
  if (value.kind == Value::kJoint) return value;
  const Body& body = bodies_[value.index];
  const sema::Fixture& fixture = model_.fixtures[static_cast<sema::FixtureId>(body.index)];
  const sema::Fixture::Part& part = fixture.parts[body.part];
  if (!part.joint) return fail(node.span, sema::no_travel(fixture, part));
  return joint(node, body.index, *part.joint);
}

Value Lowering::of_region(std::uint16_t body, const sema::Region& region) {
  Value value;
  value.kind = Value::kRegion;
  value.index = body;
  value.region = &region;
  return value;
}

Value Lowering::region(const ExprNode& node) {
  const sema::Fixture& fixture = model_.fixtures[static_cast<sema::FixtureId>(node.a)];
  const sema::Fixture::OwnRegion& own = fixture.regions[node.b];
  ExprNode owner = node;
  owner.b = own.part;
  const Value body = part(owner);
  return ok_ ? of_region(body.index, own.region) : body;
}

Value Lowering::region_of(const ExprNode& node) {
  const Value body = eval(node.args[0]);
  if (!ok_ || !fits(node.span, body, 'B', "`." + model_.exprs.names[node.a] + "`")) return body;
  const Body& owner = bodies_[body.index];
  const std::string& name = model_.exprs.names[node.a];
  std::string known;
  if (owner.regions != nullptr) {
    for (const sema::Region& region : *owner.regions) {
      if (region.name == name) return of_region(body.index, region);
      known += (known.empty() ? "" : ", ") + region.name;
    }
  }
  if (ok_) {
    diagnostics_.report(Code::P0201, node.span, "`" + owner.name + "` has no region `" + name + "`")
        .point(known.empty() ? "it has none" : "it has " + known);
  }
  ok_ = false;
  return Value::of_truth(false);
}

Value Lowering::standing(const ExprNode& node) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].kind == plan::BodyKind::kFixture)
      return Value::of_body(static_cast<std::uint16_t>(i));
  }
  return fail(node.span, "the scene of this task has no `fixture \"...\"`");
}

Bodies Lowering::members(sema::SetRef ref) {
  const sema::SetNode& set = model_.exprs.sets[ref];
  const auto where = [&](auto&& wanted) {
    Bodies result;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (wanted(bodies_[i], i)) result.push_back(static_cast<std::uint16_t>(i));
    }
    return result;
  };
  using plan::BodyKind;
  switch (set.op) {
    case sema::SetOp::kFingers:
      return where([](const Body& b, std::size_t) { return b.is_finger; });
    case sema::SetOp::kLinks:
      return where([](const Body& b, std::size_t) { return b.kind == BodyKind::kLink; });
    case sema::SetOp::kBodies:
      return where([](const Body&, std::size_t) { return true; });
    case sema::SetOp::kObjects:
      return where([](const Body& b, std::size_t) { return b.kind == BodyKind::kObject; });
    case sema::SetOp::kOthers:
      return where([](const Body& b, std::size_t) {
        return b.kind == BodyKind::kObject && b.role != kSourceRole;
      });
    case sema::SetOp::kDistractors:
      return where([](const Body& b, std::size_t) { return b.role == kDistractorRole; });
    case sema::SetOp::kAlike:
      if (!alike_)
        fail(set.span, "only a phrase has a rest that other objects fit: `alike` is not judged");
      return alike_.value_or(Bodies{});
    case sema::SetOp::kRole:
      return where([&](const Body& b, std::size_t) {
        return b.role == static_cast<std::uint32_t>(set.role);
      });
    case sema::SetOp::kParts:
      return where([&](const Body& b, std::size_t) {
        if (b.kind != BodyKind::kPart) return false;
        const auto& parts = model_.fixtures[static_cast<sema::FixtureId>(b.index)].parts;
        return parts[b.part].declared && parts[b.part].joint.has_value();
      });
    case sema::SetOp::kWhole: {
      const Value thing = eval(set.bodies.front());
      if (!ok_) return {};
      const Body& of = bodies_[thing.index];
      return where([&](const Body& b, std::size_t i) {
        const bool is_part = b.kind == BodyKind::kPart && of.kind == BodyKind::kPart;
        return is_part ? b.index == of.index : i == thing.index;
      });
    }
    case sema::SetOp::kNames: {
      Bodies result;
      for (const ExprRef body : set.bodies) {
        const Value member = eval(body);
        if (ok_) fits(model_.exprs.nodes[body].span, member, 'B', "a set");
        result.push_back(member.index);
      }
      std::sort(result.begin(), result.end());
      result.erase(std::unique(result.begin(), result.end()), result.end());
      return result;
    }
    default:
      break;
  }
  const Bodies left = members(set.left);
  const Bodies right = members(set.right);
  Bodies result;
  const auto out = std::back_inserter(result);
  if (set.op == sema::SetOp::kUnion)
    std::set_union(left.begin(), left.end(), right.begin(), right.end(), out);
  if (set.op == sema::SetOp::kIntersection)
    std::set_intersection(left.begin(), left.end(), right.begin(), right.end(), out);
  if (set.op == sema::SetOp::kDifference)
    std::set_difference(left.begin(), left.end(), right.begin(), right.end(), out);
  return result;
}

}  // namespace probe::lower
