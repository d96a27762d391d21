#include "compiler/lower/lower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "compiler/lower/builder.h"
#include "compiler/model/measures.h"
#include "compiler/model/moving_joint.h"
#include "runtime/base/check.h"
#include "runtime/base/geometry.h"
#include "runtime/base/trig.h"
#include "runtime/plan/claims.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/regions.h"

namespace probe::lower {
namespace {

using plan::Op;
using sema::ExprNode;
using sema::ExprOp;
using sema::ExprRef;
using sema::Measure;

using Bodies = std::vector<std::uint16_t>;  // ascending

constexpr auto kSourceRole = static_cast<std::uint32_t>(sema::RoleId::kSource);

class Lowering {
 public:
  Lowering(const sema::Model& model, const std::vector<Body>& bodies, const sema::Frame& frame,
           Diagnostics& diagnostics)
      : model_(model), bodies_(bodies), frame_(frame), diagnostics_(diagnostics) {}

  // False when something was reported.
  bool metric(const sema::Metric& metric) {
    variables_.assign(metric.variables, Value{});
    empty_.clear();
    Value value = eval(metric.expr);
    builder_.at(metric.readout_span);
    ProgramMetric record{metric.name, plan::MetricType::kBool, metric.readout, metric.span, empty_};
    const plan::ReadoutInfo& readout = plan::info(metric.readout);
    if (readout.has_monitor()) value = builder_.monitor(readout.monitor, value);
    record.type = readout.is_truth() ? plan::MetricType::kBool : plan::MetricType::kReal;
    builder_.emit_metric(value, std::move(record));
    if (builder_.is_full() && ok_) {
      diagnostics_.report(Code::P0601, metric.span,
                          "the metrics of this task need more than 4096 instructions");
      ok_ = false;
    }
    return ok_;
  }

  // The same of a relation of bodies, as the one metric of a program.
  bool relation(const sema::Predicate& relation, std::span<const std::uint16_t> of,
                const Bodies& alike) {
    const Value value = related(relation, of, alike);
    builder_.at(relation.span);
    builder_.emit_metric(
        value, {relation.name, plan::MetricType::kBool, plan::Readout::kAtEnd, relation.span});
    return ok_ && !builder_.is_full();
  }

  bool claimed(const ClaimedBody& claimed) {
    Value all = Value::of_truth(true);
    Span span;
    for (const ClaimedBody::Relation& one : claimed.relations) {
      span = one.relation->span;
      Value holds = Value::of_truth(claimed.is_meant);
      for (const Bodies& alike : one.alike) {
        const Value here = related(*one.relation, one.of, alike);
        builder_.at(span);
        holds =
            claimed.is_meant ? builder_.logical_and(holds, here) : builder_.logical_or(holds, here);
      }
      all = builder_.logical_and(all, holds);
    }
    builder_.at(span);
    builder_.emit_metric(all, {plan::claim_metric(claimed.body), plan::MetricType::kBool,
                               plan::Readout::kAtEnd, span});
    return ok_ && !builder_.is_full();
  }

  // It is over or in what carries it: of a region between its sides and above its floor, for what
  // is high reaches out of it.
  bool put(const PutBody& put, const Span& span) {
    builder_.at(span);
    Value holds = Value::of_truth(true);
    const std::uint16_t own = builder_.emit(Op::kPOS, put.body);
    if (put.region != nullptr) {
      const std::uint16_t here = builder_.emit(Op::kLOCAL, put.carrier, own);
      constexpr Op kAxes[] = {Op::kVX, Op::kVY, Op::kVZ};
      for (std::size_t i = 0; i < 3; ++i) {
        const Value at = Value::of_register(builder_.emit(kAxes[i], here));
        const Value low = builder_.less(Value::of_number(put.region->low[i]), at, true);
        holds = builder_.logical_and(holds, low);
        if (i == 2) break;
        const Value high = builder_.less(at, Value::of_number(put.region->high[i]), true);
        holds = builder_.logical_and(holds, high);
      }
    } else {
      const std::uint16_t other = builder_.emit(Op::kPOS, put.carrier);
      const Value apart =
          Value::of_register(builder_.emit(Op::kVLENXY, builder_.emit(Op::kVSUB, own, other)));
      const Value reach =
          Value::of_register(builder_.emit(Op::kVLENXY, builder_.emit(Op::kHALF, put.carrier)));
      holds = builder_.less(apart, reach, true);
      if (!put.in) {
        const Value low = Value::of_register(builder_.emit(Op::kVZ, other));
        const Value high = Value::of_register(builder_.emit(Op::kVZ, own));
        const Value above = builder_.less(low, high, false);
        holds = builder_.logical_and(holds, above);
      }
    }
    builder_.emit_metric(holds, {plan::claim_metric(put.body), plan::MetricType::kBool,
                                 plan::Readout::kAtEnd, span});
    return ok_ && !builder_.is_full();
  }

  Program finish() { return builder_.finish(); }

 private:
  Value related(const sema::Predicate& relation, std::span<const std::uint16_t> of,
                const Bodies& alike) {
    variables_.assign(relation.variables, Value{});
    for (std::size_t i = 0; i < relation.parameters.size(); ++i)
      variables_[i] =
          i < of.size() ? Value::of_body(of[i]) : eval(relation.parameters[i].default_value);
    alike_ = alike;
    return eval(relation.body);
  }

  // Predicates that call others twice double at each level, also where the instructions are shared.
  static constexpr std::size_t kMostVisited = std::size_t{1} << 22u;
  std::size_t visited_ = 0;

  Value fail(const Span& span, std::string message) {
    if (ok_) diagnostics_.report(Code::P0601, span, std::move(message));
    ok_ = false;
    return Value::of_truth(false);
  }

  // Inner expressions first, so that each instruction carries the innermost text that asked for it.
  Value eval(ExprRef ref) {
    // A program that is too long or wrong is not used: stop unrolling it.
    if (!ok_ || builder_.is_full()) return Value::of_truth(false);
    const ExprNode& node = model_.exprs.nodes[ref];
    if (++visited_ > kMostVisited)
      return fail(node.span, "the predicates of this task call one another too often to unroll");
    if (!joins_travels(node)) return value_of(node);
    // Of a parameter it is known only here whether a part slides or turns.
    const unsigned before = std::exchange(motions_, 0U);
    const Value value = value_of(node);
    const unsigned met = motions_;
    motions_ = before | (is_travel(node) ? met : 0U);
    if (met == (kSlidesMet | kTurnsMet))
      return fail(node.span, "a length and an angle: one of these parts slides, another turns");
    return value;
  }

  static constexpr unsigned kSlidesMet = 1, kTurnsMet = 2;

  bool is_travel(const ExprNode& node) const { return node.type.dimension.travel == 1; }
  // Whether it compares or adds what parts have travelled.
  bool joins_travels(const ExprNode& node) const {
    const bool multiplies = node.op == ExprOp::kMultiply || node.op == ExprOp::kDivide;
    if (node.args.size() < 2 || node.op == ExprOp::kCall || multiplies) return false;
    return std::ranges::all_of(node.args,
                               [&](ExprRef arg) { return is_travel(model_.exprs.nodes[arg]); });
  }

  Value value_of(const ExprNode& node) {
    switch (node.op) {
      case ExprOp::kPoison:
        return fail(node.span, "this has no value");
      case ExprOp::kConstant:
        return constant(node);
      case ExprOp::kRole:
        return in_role(node);
      case ExprOp::kObject:
        return only(node, [&](const Body& b) {
          return b.kind == plan::BodyKind::kObject && b.index == node.a;
        });
      case ExprOp::kFixture:
        return only(node, [](const Body& b) { return b.kind == plan::BodyKind::kFixture; });
      case ExprOp::kSurface:
        return surface();
      case ExprOp::kPart:
        return part(node);
      case ExprOp::kJoint:
        return joint(node, node.a, node.b);
      case ExprOp::kRegion:
        return region(node);
      case ExprOp::kRegionOf:
        return region_of(node);
      case ExprOp::kStanding:
        return standing(node);
      case ExprOp::kVariable:
        return variables_[node.a];
      case ExprOp::kVector:
        return vector(node);
      case ExprOp::kMeasure:
        return measure(node);
      case ExprOp::kCall:
        return call(node);
      case ExprOp::kAdd:
      case ExprOp::kSubtract:
      case ExprOp::kMultiply:
      case ExprOp::kDivide:
        return arithmetic(node);
      case ExprOp::kNegate:
        return negate(node);
      case ExprOp::kLess:
        return compare(node, false);
      case ExprOp::kLessEqual:
        return compare(node, true);
      case ExprOp::kEqual: {
        const Value a = eval(node.args[0]);
        const Value b = eval(node.args[1]);
        builder_.at(node.span);
        return builder_.logical_and(builder_.less(a, b, true), builder_.less(b, a, true));
      }
      case ExprOp::kAnd:
      case ExprOp::kOr:
        return chain(node);
      case ExprOp::kNot: {
        const Value operand = eval(node.args[0]);
        builder_.at(node.span);
        return builder_.logical_not(operand);
      }
      case ExprOp::kOnce:
        return monitor(node, Op::kONCE);
      case ExprOp::kAlways:
        return monitor(node, Op::kALWAYS);
      case ExprOp::kHold:
        return monitor(node, Op::kHOLD);
      case ExprOp::kAny:
      case ExprOp::kAll:
      case ExprOp::kNo:
        return quantified(node);
    }
    return Value::of_truth(false);
  }

  Value constant(const ExprNode& node) {
    const sema::Quantity& quantity = model_.exprs.quantities[node.a];
    Value value = Value::of_number(quantity.si());
    if (quantity.dimension == sema::dim::kAngle) value.angle = quantity;
    return value;
  }

  Value vector(const ExprNode& node) {
    double parts[3] = {};
    for (std::size_t i = 0; i < 3; ++i) {
      const Value part = eval(node.args[i]);
      if (part.kind != Value::kNumber)
        return fail(model_.exprs.nodes[node.args[i]].span,
                    "the numbers of a vector are constants, this is measured");
      parts[i] = part.number;
    }
    builder_.at(node.span);
    return Value::of_register(builder_.vector(parts[0], parts[1], parts[2]));
  }

  // The first body that is meant; that there is one was checked.
  template <typename Meant>
  Value only(const ExprNode& node, Meant meant) {
    const auto at = std::find_if(bodies_.begin(), bodies_.end(), meant);
    if (at == bodies_.end()) return fail(node.span, "this is not in the scene");
    return Value::of_body(static_cast<std::uint16_t>(at - bodies_.begin()));
  }

  Value in_role(const ExprNode& node) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      for (const Body::Filled& filled : bodies_[i].filled) {
        if (filled.role == node.a) return of_region(static_cast<std::uint16_t>(i), *filled.region);
      }
    }
    return only(node, [&](const Body& b) { return b.role == node.a; });
  }

  // What an open role stands for fits what is measured, or what a predicate takes; else it is
  // reported where that is asked.
  bool fits(const Span& span, const Value& value, char wanted, std::string_view what) {
    const bool is_body = value.kind == Value::kBody;
    const auto is = [&](plan::BodyKind kind) {
      return is_body && bodies_[value.index].kind == kind;
    };
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
    fail(span, std::string(what) + " takes " + name + ", found " + found);
    return false;
  }

  Value surface() const {
    std::uint16_t at = 0;
    while (bodies_[at].kind != plan::BodyKind::kSurface) ++at;
    return Value::of_body(at);
  }

  Value not_here(const ExprNode& node, const std::string& name) {
    if (ok_) {
      diagnostics_.report(Code::P0201, node.span, "`" + name + "` is not in the scene of this task")
          .help("a scene names its fixtures: `fixture " + name + "`");
    }
    ok_ = false;
    return Value::of_truth(false);
  }

  // The body that a part of a fixture is.
  Value part(const ExprNode& node) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& body = bodies_[i];
      if (body.kind == plan::BodyKind::kPart && body.index == node.a && body.part == node.b)
        return Value::of_body(static_cast<std::uint16_t>(i));
    }
    return not_here(node, model_.fixtures[static_cast<sema::FixtureId>(node.a)].name);
  }

  // Joints are counted over the fixtures of the scene, in the order in which their parts stand.
  Value joint(const ExprNode& node, std::uint32_t fixture, std::uint32_t which) {
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

  // What moves a part, or the joint itself.
  Value joint_of(const ExprNode& node, const Value& value) {
    if (value.kind == Value::kJoint) return value;
    const Body& body = bodies_[value.index];
    const sema::Fixture& fixture = model_.fixtures[static_cast<sema::FixtureId>(body.index)];
    const sema::Fixture::Part& part = fixture.parts[body.part];
    if (!part.joint) return fail(node.span, sema::no_travel(fixture, part));
    return joint(node, body.index, *part.joint);
  }

  Value of_region(std::uint16_t body, const sema::Region& region) {
    Value value;
    value.kind = Value::kRegion;
    value.index = body;
    value.region = &region;
    return value;
  }

  Value region(const ExprNode& node) {
    const sema::Fixture& fixture = model_.fixtures[static_cast<sema::FixtureId>(node.a)];
    const sema::Fixture::OwnRegion& own = fixture.regions[node.b];
    ExprNode owner = node;
    owner.b = own.part;
    const Value body = part(owner);
    return ok_ ? of_region(body.index, own.region) : body;
  }

  Value region_of(const ExprNode& node) {
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
      diagnostics_
          .report(Code::P0201, node.span, "`" + owner.name + "` has no region `" + name + "`")
          .point(known.empty() ? "it has none" : "it has " + known);
    }
    ok_ = false;
    return Value::of_truth(false);
  }

  Value standing(const ExprNode& node) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i].kind == plan::BodyKind::kFixture)
        return Value::of_body(static_cast<std::uint16_t>(i));
    }
    return fail(node.span, "the scene of this task has no `fixture \"...\"`");
  }

  // From where it is closed: the limit nearest 0.
  Value travel(const ExprNode& node, const Value& given) {
    const Value of = joint_of(node, given);
    if (!ok_) return of;
    motions_ |= of.joint->slides ? kSlidesMet : kTurnsMet;
    const sema::Fixture::Joint& joint = *of.joint;
    const Value position =
        Value::of_register(builder_.emit(joint.slides ? Op::kSLIDE : Op::kTURN, of.index));
    if (joint.is_endless) return position;
    if (joint.closes_at_upper()) {
      if (joint.upper == 0) return builder_.negate(position);
      return builder_.arithmetic(Op::kSUB, Value::of_number(joint.upper), position);
    }
    if (joint.lower == 0) return position;
    return builder_.arithmetic(Op::kSUB, position, Value::of_number(joint.lower));
  }

  Value range(const ExprNode& node, const Value& given) {
    const Value of = joint_of(node, given);
    if (!ok_) return of;
    motions_ |= of.joint->slides ? kSlidesMet : kTurnsMet;
    if (of.joint->is_endless)
      return fail(node.span, "joint `" + of.joint->name + "` turns without end, it has no range");
    return Value::of_number(of.joint->upper - of.joint->lower);
  }

  Value rate(const ExprNode& node, const Value& given) {
    const Value of = joint_of(node, given);
    if (!ok_) return of;
    motions_ |= of.joint->slides ? kSlidesMet : kTurnsMet;
    const Value speed =
        Value::of_register(builder_.emit(of.joint->slides ? Op::kSLIDING : Op::kTURNING, of.index));
    return of.joint->closes_at_upper() ? builder_.negate(speed) : speed;
  }

  // The travel of what slides, or of what turns.
  Value travel_as(const ExprNode& node, const Value& given, bool slides) {
    const Value of = joint_of(node, given);
    if (!ok_) return of;
    if (of.joint->slides != slides) {
      return fail(node.span, "joint `" + of.joint->name + "` " +
                                 (of.joint->slides ? "slides, `turn` measures what turns"
                                                   : "turns, `slide` measures what slides"));
    }
    return travel(node, of);
  }

  // Each axis between its two bounds, which belong to the region.
  Value within(const Value& where, const Value& of) {
    const std::uint16_t here = builder_.emit(Op::kLOCAL, of.index, point(where));
    Value all = Value::of_truth(true);
    constexpr Op kAxes[] = {Op::kVX, Op::kVY, Op::kVZ};
    // From its middle along each of its axes, of a turned one.
    std::uint16_t away = here;
    std::optional<Mat3> turn;
    if (of.region->turned) {
      away = builder_.emit(Op::kVSUB, here, vector_of(to_vec(of.region->middle())));
      turn = turn_of(*of.region);
    }
    const std::array<double, 3> half = of.region->half();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const Value at =
          Value::of_register(turn ? builder_.emit(Op::kVDOT, away, vector_of(turn->col(axis)))
                                  : builder_.emit(kAxes[i], here));
      const double least = turn ? -half[i] : of.region->low[i];
      const double most = turn ? half[i] : of.region->high[i];
      const Value low = builder_.less(Value::of_number(least), at, true);
      const Value high = builder_.less(at, Value::of_number(most), true);
      all = builder_.logical_and(all, builder_.logical_and(low, high));
    }
    return all;
  }

  // In the frame of what it belongs to.
  static Mat3 turn_of(const sema::Region& region) {
    Mat3 turn = Mat3::Identity();
    if (!region.turned) return turn;
    const auto rows = plan::axes_of(*region.turned);
    for (std::size_t i = 0; i < 3; ++i)
      turn.row(static_cast<Eigen::Index>(i)) = to_vec(rows[i]).transpose();
    return turn;
  }

  // A vector of a body's frame, in the world.
  std::uint16_t from_body(std::uint16_t body, const Vec3& vector) {
    std::optional<std::uint16_t> sum;
    for (std::uint16_t i = 0; i < 3; ++i) {
      const double along = vector[i];
      if (along == 0 && (sum || i < 2)) continue;
      std::uint16_t part = builder_.emit(Op::kAXIS, body, i);
      if (along != 1) part = builder_.emit(Op::kVSCALE, part, builder_.constant(along));
      sum = sum ? builder_.emit(Op::kVADD, *sum, part) : part;
    }
    return *sum;
  }

  Value axis(const Value& of, std::uint16_t which) {
    if (of.kind != Value::kRegion || !of.region->turned)
      return Value::of_register(builder_.emit(Op::kAXIS, of.index, which));
    return Value::of_register(from_body(of.index, turn_of(*of.region).col(which)));
  }

  Value centre(const Value& of) {
    const std::uint16_t origin = builder_.emit(Op::kORIGIN, of.index);
    const Vec3 middle = to_vec(of.region->middle());
    if (middle == Vec3::Zero()) return Value::of_register(origin);
    return Value::of_register(builder_.emit(Op::kVADD, origin, from_body(of.index, middle)));
  }

  Value call(const ExprNode& node) {
    const sema::Predicate& predicate = model_.predicates[node.predicate];
    std::vector<Value> inner(predicate.variables);
    for (std::size_t i = 0; i < node.args.size(); ++i) {
      inner[i] = eval(node.args[i]);
      const sema::Type& wanted = predicate.parameters[i].type;
      const char kind = wanted.kind == sema::TypeKind::kRegion ? 'G'
                        : wanted.kind != sema::TypeKind::kBody ? ' '
                        : wanted.is_object                     ? 'O'
                        : wanted.is_part                       ? 'A'
                                                               : 'B';
      // What a parameter stands for was looked at where it was given.
      if (ok_ && model_.exprs.nodes[node.args[i]].type.is_open)
        fits(model_.exprs.nodes[node.args[i]].span, inner[i], kind,
             "`" + predicate.parameters[i].name + "` of `" + predicate.name + "`");
    }
    if (!ok_) return Value::of_truth(false);
    std::swap(inner, variables_);
    const Value value = eval(predicate.body);
    std::swap(inner, variables_);
    return value;
  }

  Value monitor(const ExprNode& node, Op op) {
    const Value operand = eval(node.args[0]);
    builder_.at(node.span);
    return builder_.monitor(
        op, operand, op == Op::kHOLD ? static_cast<std::uint16_t>(node.a) : std::uint16_t{0});
  }

  // Operands first, then the chain of connectives, so that the code reads like the text.
  Value join(const std::vector<Value>& values, bool all, const Span& span) {
    builder_.at(span);
    Value result = Value::of_truth(all);
    for (const Value& value : values) {
      result = all ? builder_.logical_and(result, value) : builder_.logical_or(result, value);
    }
    return result;
  }

  Value chain(const ExprNode& node) {
    std::vector<Value> values;
    for (const ExprRef arg : node.args) values.push_back(eval(arg));
    return join(values, node.op == ExprOp::kAnd, node.span);
  }

  Value quantified(const ExprNode& node) {
    std::vector<Value> values;
    const Bodies all = members(node.set);
    if (all.empty()) empty_.insert(model_.exprs.sets[node.set].span);
    for (const std::uint16_t body : all) {
      variables_[node.a] = Value::of_body(body);
      values.push_back(eval(node.args[0]));
    }
    const Value result = join(values, node.op == ExprOp::kAll, node.span);
    return node.op == ExprOp::kNo ? builder_.logical_not(result) : result;
  }

  Bodies members(sema::SetRef ref) {
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

  Value arithmetic(const ExprNode& node) {
    const Value a = eval(node.args[0]);
    const Value b = eval(node.args[1]);
    builder_.at(node.span);
    if (node.type.kind == sema::TypeKind::kVector) {
      const Op op = node.op == ExprOp::kAdd        ? Op::kVADD
                    : node.op == ExprOp::kSubtract ? Op::kVSUB
                                                   : Op::kVSCALE;
      const std::uint16_t right = builder_.in_register(b);
      return Value::of_register(builder_.emit(op, a.index, right));
    }
    if (node.op != ExprOp::kDivide) {
      const Op op = node.op == ExprOp::kAdd        ? Op::kADD
                    : node.op == ExprOp::kSubtract ? Op::kSUB
                                                   : Op::kMUL;
      return finite(builder_.arithmetic(op, a, b), node.span);
    }
    if (a.kind == Value::kNumber && b.kind == Value::kNumber && b.number != 0)
      return finite(Value::of_number(a.number / b.number), node.span);
    return fail(node.span, "the judge has no division: write `a < k * b` for `a / b < k`");
  }

  // What is known while lowering becomes a constant of the plan, which holds no infinity.
  Value finite(const Value& value, const Span& span) {
    if (value.kind != Value::kNumber || std::isfinite(value.number)) return value;
    return fail(span, "this is larger than any number that is kept");
  }

  Value negate(const ExprNode& node) {
    const Value operand = eval(node.args[0]);
    builder_.at(node.span);
    if (node.type.kind != sema::TypeKind::kVector) return builder_.negate(operand);
    return Value::of_register(builder_.emit(Op::kVSCALE, operand.index, builder_.constant(-1)));
  }

  Value compare(const ExprNode& node, bool or_equal) {
    const bool left_angle = model_.exprs.nodes[node.args[0]].type.is_angle_between;
    const bool right_angle = model_.exprs.nodes[node.args[1]].type.is_angle_between;
    if (left_angle || right_angle) return compare_angle(node, left_angle, or_equal);
    // `a > b` is stored as `b < a`; evaluation follows the text, so that the code reads like it.
    const bool swapped =
        model_.exprs.nodes[node.args[1]].span.begin < model_.exprs.nodes[node.args[0]].span.begin;
    const Value first = eval(node.args[swapped ? 1 : 0]);
    const Value second = eval(node.args[swapped ? 0 : 1]);
    builder_.at(node.span);
    return swapped ? builder_.less(second, first, or_equal)
                   : builder_.less(first, second, or_equal);
  }

  // angle(u, v) <= A  is  cos A |u| |v| <= u . v, since the cosine falls from 0 to pi; no inverse
  // cosine at run time.
  Value compare_angle(const ExprNode& node, bool angle_on_left, bool or_equal) {
    const ExprNode& between = model_.exprs.nodes[node.args[angle_on_left ? 0 : 1]];
    const Value limit = eval(node.args[angle_on_left ? 1 : 0]);
    if (limit.kind != Value::kNumber) return fail(node.span, "`angle` is compared with a constant");
    constexpr double kHalfTurn = std::numbers::pi;
    if (!(limit.number >= 0 && limit.number <= kHalfTurn)) {
      if (ok_)
        diagnostics_
            .report(Situation::kAngleRange,
                    model_.exprs.nodes[node.args[angle_on_left ? 1 : 0]].span,
                    "the angle between two vectors is 0deg to 180deg")
            .label(between.span, "compared with this");
      ok_ = false;
      return Value::of_truth(false);
    }
    // At the ends the comparison says nothing, or nothing can pass it.
    if (angle_on_left && limit.number == (or_equal ? kHalfTurn : 0))
      return Value::of_truth(or_equal);
    if (!angle_on_left && limit.number == (or_equal ? 0 : kHalfTurn))
      return Value::of_truth(or_equal);
    const std::uint16_t u = eval(between.args[0]).index;
    const std::uint16_t v = eval(between.args[1]).index;
    builder_.at(node.span);
    const double cosine = limit.angle ? limit.angle->cosine() : portable_cos(limit.number);
    const std::uint16_t u_length = builder_.emit(Op::kVLEN, u);
    const std::uint16_t v_length = builder_.emit(Op::kVLEN, v);
    const std::uint16_t scaled = builder_.emit(Op::kMUL, builder_.constant(cosine), u_length);
    const Value edge = Value::of_register(builder_.emit(Op::kMUL, scaled, v_length));
    const Value dot = Value::of_register(builder_.emit(Op::kVDOT, u, v));
    return angle_on_left ? builder_.less(edge, dot, or_equal) : builder_.less(dot, edge, or_equal);
  }

  // A body stands for its centre of mass.
  std::uint16_t point(const Value& value) {
    return value.kind == Value::kBody ? builder_.emit(Op::kPOS, value.index) : value.index;
  }

  // How far right in the picture, as far away as the middle of the area: points of one line of
  // sight have one. Or how far along the ground towards who looks.
  Value in_view(const ExprNode& node, const Value& of, bool is_across) {
    if (!frame_.sight)
      return fail(node.span, "`" + std::string(sema::info(node.measure).name) +
                                 "` needs a first camera that stands still and sees the area");
    const sema::Sight& sight = *frame_.sight;
    if (!is_across) {
      // One order of instructions, whatever order a C++ compiler gives to arguments.
      const std::uint16_t middle = vector_of(sight.middle);
      const std::uint16_t away = builder_.emit(Op::kVSUB, point(of), middle);
      return Value::of_register(builder_.emit(Op::kVDOT, away, vector_of(sight.near)));
    }
    const std::uint16_t eye = vector_of(sight.eye);
    const std::uint16_t from_eye = builder_.emit(Op::kVSUB, point(of), eye);
    const Vec3 scaled = sight.right * sight.depth;
    const std::uint16_t across = builder_.emit(Op::kVDOT, from_eye, vector_of(scaled));
    const std::uint16_t along = builder_.emit(Op::kVDOT, from_eye, vector_of(sight.forward));
    return Value::of_register(builder_.emit(Op::kRATIO, across, along));
  }

  Value from_robot(const Value& of, const Vec3& axis) {
    const std::uint16_t base = vector_of(frame_.base);
    const std::uint16_t from_base = builder_.emit(Op::kVSUB, point(of), base);
    return Value::of_register(builder_.emit(Op::kVDOT, from_base, vector_of(axis)));
  }

  std::uint16_t vector_of(const Vec3& v) { return builder_.vector(v.x(), v.y(), v.z()); }

  Value measure(const ExprNode& node) {
    std::vector<Value> args;
    const sema::MeasureInfo& info = sema::info(node.measure);
    for (std::size_t i = 0; i < node.args.size(); ++i) {
      args.push_back(eval(node.args[i]));
      // Relations of phrases are asked of parts as of objects.
      if (ok_) fits(node.span, args[i], info.params[i], "`" + std::string(info.name) + "`");
    }
    if (!ok_) return Value::of_truth(false);
    builder_.at(node.span);
    const auto reg = [&](Op op, std::uint16_t a = 0, std::uint16_t b = 0) {
      return Value::of_register(builder_.emit(op, a, b));
    };
    const std::uint16_t first = args.empty() ? std::uint16_t{0} : args[0].index;
    switch (node.measure) {
      case Measure::kImpulse:
        return reg(Op::kIMP, std::min(first, args[1].index), std::max(first, args[1].index));
      case Measure::kPush:
        return reg(Op::kPUSH, first, args[1].index);
      case Measure::kOpening:
        if (!bodies_[first].is_finger) {
          return fail(node.span,
                      "`opening` is measured of a finger, found `" + bodies_[first].name + "`");
        }
        return reg(Op::kOPEN, first);
      case Measure::kAngle:
        return fail(node.span, "`angle` stands alone on one side of a comparison");
      case Measure::kDistance:
      case Measure::kDistanceXy: {
        const std::uint16_t a = point(args[0]);
        const std::uint16_t b = point(args[1]);
        return reg(node.measure == Measure::kDistance ? Op::kVLEN : Op::kVLENXY,
                   builder_.emit(Op::kVSUB, a, b));
      }
      case Measure::kOrigin:
        return reg(Op::kORIGIN, first);
      case Measure::kPosition:
        return reg(Op::kPOS, first);
      case Measure::kStart:
        return reg(Op::kSTART, first);
      case Measure::kVelocity:
        return reg(Op::kVEL, first);
      case Measure::kSpeed:
        return reg(Op::kVLEN, builder_.emit(Op::kVEL, first));
      case Measure::kSpin:
        return reg(Op::kSPIN, first);
      case Measure::kHeight:
        return reg(Op::kVZ, point(args[0]));
      case Measure::kX:
        return reg(Op::kVX, point(args[0]));
      case Measure::kY:
        return reg(Op::kVY, point(args[0]));
      case Measure::kZ:
        return reg(Op::kVZ, point(args[0]));
      case Measure::kViewX:
        return in_view(node, args[0], true);
      case Measure::kViewY:
        return in_view(node, args[0], false);
      case Measure::kRobotX:
        return from_robot(args[0], frame_.ahead);
      case Measure::kRobotY:
        return from_robot(args[0], frame_.left);
      case Measure::kHalfHeight:
        return reg(Op::kVZ, builder_.emit(Op::kHALF, first));
      case Measure::kHalfSize:
        return reg(Op::kHALF, first);
      case Measure::kHalfDiagonal:
        return reg(Op::kVLENXY, builder_.emit(Op::kHALF, first));
      case Measure::kMovedXy: {
        const std::uint16_t now = builder_.emit(Op::kPOS, first);
        const std::uint16_t then = builder_.emit(Op::kSTART, first);
        return reg(Op::kVLENXY, builder_.emit(Op::kVSUB, now, then));
      }
      case Measure::kAxisX:
        return axis(args[0], 0);
      case Measure::kAxisY:
        return axis(args[0], 1);
      case Measure::kAxisZ:
        return axis(args[0], 2);
      case Measure::kUp:
        return Value::of_register(builder_.vector(0, 0, 1));
      case Measure::kTcp:
        return reg(Op::kTCP);
      case Measure::kGrip:
        return reg(Op::kGRIP);
      case Measure::kStep:
        return reg(Op::kSTEP);
      case Measure::kTime:
        return reg(Op::kTIME);
      case Measure::kAbs:
        if (args[0].kind == Value::kNumber)
          return Value::of_number(args[0].number < 0 ? -args[0].number : args[0].number);
        return reg(Op::kABS, first);
      case Measure::kMin:
        return builder_.arithmetic(Op::kMIN, args[0], args[1]);
      case Measure::kMax:
        return builder_.arithmetic(Op::kMAX, args[0], args[1]);
      case Measure::kTravel:
        return travel(node, args[0]);
      case Measure::kRange:
        return range(node, args[0]);
      case Measure::kRate:
        return rate(node, args[0]);
      case Measure::kSlide:
        return travel_as(node, args[0], true);
      case Measure::kTurn:
        return travel_as(node, args[0], false);
      case Measure::kWithin:
        return within(args[0], args[1]);
      case Measure::kCentre:
        return centre(args[0]);
      case Measure::kHalf:
        return Value::of_register(vector_of(to_vec(args[0].region->half())));
      case Measure::kLatest: {
        if (args[0].kind == Value::kNumber || args[1].kind == Value::kTruth) return args[0];
        const Value gated = reg(Op::kGATED, first, args[1].index);
        return builder_.monitor(Op::kKEPT, gated);
      }
      case Measure::kLocal:
        return reg(Op::kLOCAL, args[1].index, point(args[0]));
    }
    return fail(node.span, "this cannot be measured");
  }

  const sema::Model& model_;
  const std::vector<Body>& bodies_;
  const sema::Frame& frame_;
  Diagnostics& diagnostics_;
  Builder builder_;
  std::vector<Value> variables_;
  std::optional<Bodies> alike_;
  std::set<Span> empty_;  // of the metric that is being lowered
  unsigned motions_ = 0;  // kSlidesMet, kTurnsMet: of the travels in what is being lowered
  bool ok_ = true;
};

}  // namespace

namespace {

std::uint32_t role_number(const sema::Task& task, sema::ObjectId object) {
  const sema::RoleId role = task.role_of(object);
  if (role != sema::RoleId::kNone) return static_cast<std::uint32_t>(role);
  const auto& others = task.distractors;
  return std::find(others.begin(), others.end(), object) != others.end()
             ? kDistractorRole
             : static_cast<std::uint32_t>(sema::RoleId::kNone);
}

void set_regions(Body& body, const std::vector<sema::Region>& regions, std::uint32_t owner) {
  if (regions.empty()) return;
  body.regions = &regions;
  body.owner = owner + 1;
}

// The part that a thing is, or that has it, gets its role.
void fill_role(const sema::Model& model, sema::RoleId role, sema::ObjectId thing,
               std::vector<Body>& bodies) {
  const sema::Object& object = model.objects[thing];
  for (Body& body : bodies) {
    if (body.kind != plan::BodyKind::kPart ||
        body.index != static_cast<std::uint32_t>(object.of->fixture) ||
        body.part != object.of->part)
      continue;
    if (object.of->is_part()) {
      body.role = static_cast<std::uint32_t>(role);
      continue;
    }
    const sema::Fixture& fixture = model.fixtures[object.of->fixture];
    body.filled.push_back({static_cast<std::uint32_t>(role), *object.of->region,
                           &fixture.regions[*object.of->region].region, object.name});
  }
}

}  // namespace

std::vector<Body> bodies_of(const sema::Model& model, const sema::Task& task) {
  const sema::Scene& scene = model.scenes[task.scene];
  const sema::Robot& robot = model.robots[scene.robot];
  PROBE_CHECK(robot.model.has_value(), "a task is lowered only after its robot was read");
  std::vector<Body> bodies;
  for (const sema::ObjectId id : task.objects()) {
    bodies.push_back({plan::BodyKind::kObject, static_cast<std::uint32_t>(id),
                      model.objects[id].name, role_number(task, id)});
    set_regions(bodies.back(), model.objects[id].regions, static_cast<std::uint32_t>(id));
  }
  bodies.push_back({plan::BodyKind::kSurface, 0, "surface"});
  set_regions(bodies.back(), scene.surface_regions, static_cast<std::uint32_t>(task.scene));
  if (scene.fixture) {
    bodies.push_back({plan::BodyKind::kFixture, 0, scene.fixture->text});
    set_regions(bodies.back(), scene.fixture_regions, static_cast<std::uint32_t>(task.scene));
  }
  std::uint32_t link = 0;
  for (const sema::Finger& finger : robot.fingers) {
    bodies.push_back({plan::BodyKind::kLink, link++, finger.link.text});
    bodies.back().is_finger = true;
  }
  for (const robot::Link& known : robot.model->links) {
    const bool is_finger =
        std::any_of(robot.fingers.begin(), robot.fingers.end(),
                    [&](const sema::Finger& finger) { return finger.link.text == known.name; });
    if (is_finger || !known.can_collide()) continue;
    bodies.push_back({plan::BodyKind::kLink, link++, known.name});
  }
  for (const sema::FixtureId id : scene.fixtures) {
    const sema::Fixture& fixture = model.fixtures[id];
    for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) {
      bodies.push_back({plan::BodyKind::kPart, static_cast<std::uint32_t>(id),
                        fixture.body_name(fixture.parts[i]),
                        static_cast<std::uint32_t>(sema::RoleId::kNone), i});
    }
  }
  for (const auto& [role, thing] : task.things()) fill_role(model, role, thing, bodies);
  return bodies;
}

std::vector<std::uint32_t> shape_of(const sema::Model& model, std::span<const sema::Metric> metrics,
                                    const std::vector<Body>& bodies) {
  std::vector<std::uint32_t> shape;
  shape.reserve(1 + 6 * bodies.size() + 9 * metrics.size());
  shape.push_back(static_cast<std::uint32_t>(bodies.size()));
  for (const Body& body : bodies) {
    // Which object it is counts for nothing: instructions name bodies by their place in the list,
    // unless some metric of the text calls one by its name.
    const bool is_any = body.kind == plan::BodyKind::kObject && !model.exprs.names_objects;
    shape.push_back(static_cast<std::uint32_t>(body.kind));
    shape.push_back(is_any ? 0 : body.index);
    shape.push_back(body.role);
    shape.push_back(body.owner);  // of its regions
    shape.push_back(body.part);
    for (const Body::Filled& filled : body.filled)
      shape.insert(shape.end(), {0xfffffffdu, filled.role, filled.number});
    shape.push_back(body.is_finger ? 1 : 0);
  }
  for (const sema::Metric& metric : metrics) {
    // A metric's name stands at its span.
    shape.insert(shape.end(),
                 {metric.expr, metric.variables, static_cast<std::uint32_t>(metric.readout),
                  metric.span.file.value, metric.span.begin, metric.span.end});
    shape.insert(shape.end(), {metric.readout_span.file.value, metric.readout_span.begin,
                               metric.readout_span.end});
  }
  return shape;
}

Room room_of(const sema::Model& model, const sema::Task& task) {
  const sema::Scene& scene = model.scenes[task.scene];
  // Objects start within the area, and a plan may have that a kilometre away.
  double farthest = std::abs(scene.surface_z) + model.layouts[task.layout].drop;
  const auto reach = [&](const auto& coordinates) {
    for (const double c : coordinates) farthest = std::max(farthest, std::abs(c));
  };
  reach(scene.area);
  reach(scene.base_position);
  if (scene.fixture) reach(scene.fixture_position);
  Room room;
  for (const sema::FixtureId id : scene.fixtures) {
    const sema::Fixture& fixture = model.fixtures[id];
    reach(fixture.position);
    for (const sema::Fixture::Joint& joint : fixture.joints) {
      constexpr double kNone = std::numeric_limits<double>::infinity();
      room.joints.emplace_back(joint.is_endless ? -kNone : joint.lower,
                               joint.is_endless ? kNone : joint.upper);
    }
  }
  room.farthest += farthest;
  for (const sema::ObjectId id : task.objects()) {
    const sema::Object& object = model.objects[id];
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double extent = object.box_max[i] - object.box_min[i];
      square += extent * extent;
    }
    room.largest = std::max(room.largest, std::sqrt(square) / 2);
  }
  return room;
}

std::optional<Program> lower_metrics(const sema::Model& model,
                                     std::span<const sema::Metric> metrics,
                                     const std::vector<Body>& bodies, const sema::Frame& frame,
                                     Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  for (const sema::Metric& metric : metrics) {
    if (!lowering.metric(metric)) return std::nullopt;
  }
  return lowering.finish();
}

std::optional<Program> lower_relation(const sema::Model& model, const sema::Predicate& relation,
                                      std::span<const std::uint16_t> of,
                                      const std::vector<std::uint16_t>& alike,
                                      const std::vector<Body>& bodies, const sema::Frame& frame,
                                      Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  if (!lowering.relation(relation, of, alike)) return std::nullopt;
  return lowering.finish();
}

std::optional<Program> lower_put(const sema::Model& model, const PutBody& put, const Span& span,
                                 const std::vector<Body>& bodies, const sema::Frame& frame,
                                 Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  if (!lowering.put(put, span)) return std::nullopt;
  return lowering.finish();
}

std::optional<Program> lower_claim(const sema::Model& model, std::span<const ClaimedBody> claimed,
                                   const std::vector<Body>& bodies, const sema::Frame& frame,
                                   Diagnostics& diagnostics) {
  Lowering lowering(model, bodies, frame, diagnostics);
  for (const ClaimedBody& body : claimed) {
    if (!lowering.claimed(body)) return std::nullopt;
  }
  return lowering.finish();
}

}  // namespace probe::lower
