// What is measured: joints, regions, points, and the table of measures.
#include "compiler/lower/lowering.h"
#include "runtime/plan/regions.h"

namespace probe::lower {

Value Lowering::travel(const ExprNode& node, const Value& given) {
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

Value Lowering::range(const ExprNode& node, const Value& given) {
  const Value of = joint_of(node, given);
  if (!ok_) return of;
  motions_ |= of.joint->slides ? kSlidesMet : kTurnsMet;
  if (of.joint->is_endless)
    return fail(node.span, "joint `" + of.joint->name + "` turns without end, it has no range");
  return Value::of_number(of.joint->upper - of.joint->lower);
}

Value Lowering::rate(const ExprNode& node, const Value& given) {
  const Value of = joint_of(node, given);
  if (!ok_) return of;
  motions_ |= of.joint->slides ? kSlidesMet : kTurnsMet;
  const Value speed =
      Value::of_register(builder_.emit(of.joint->slides ? Op::kSLIDING : Op::kTURNING, of.index));
  return of.joint->closes_at_upper() ? builder_.negate(speed) : speed;
}

Value Lowering::travel_as(const ExprNode& node, const Value& given, bool slides) {
  const Value of = joint_of(node, given);
  if (!ok_) return of;
  if (of.joint->slides != slides) {
    return fail(node.span, "joint `" + of.joint->name + "` " +
                               (of.joint->slides ? "slides, `turn` measures what turns"
                                                 : "turns, `slide` measures what slides"));
  }
  return travel(node, of);
}

Value Lowering::within(const Value& where, const Value& of) {
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

Mat3 Lowering::turn_of(const sema::Region& region) {
  Mat3 turn = Mat3::Identity();
  if (!region.turned) return turn;
  const auto rows = plan::axes_of(*region.turned);
  for (std::size_t i = 0; i < 3; ++i)
    turn.row(static_cast<Eigen::Index>(i)) = to_vec(rows[i]).transpose();
  return turn;
}

std::uint16_t Lowering::from_body(std::uint16_t body, const Vec3& vector) {
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

Value Lowering::axis(const Value& of, std::uint16_t which) {
  if (of.kind != Value::kRegion || !of.region->turned)
    return Value::of_register(builder_.emit(Op::kAXIS, of.index, which));
  return Value::of_register(from_body(of.index, turn_of(*of.region).col(which)));
}

Value Lowering::centre(const Value& of) {
  const std::uint16_t origin = builder_.emit(Op::kORIGIN, of.index);
  const Vec3 middle = to_vec(of.region->middle());
  if (middle == Vec3::Zero()) return Value::of_register(origin);
  return Value::of_register(builder_.emit(Op::kVADD, origin, from_body(of.index, middle)));
}

std::uint16_t Lowering::point(const Value& value) {
  return value.kind == Value::kBody ? builder_.emit(Op::kPOS, value.index) : value.index;
}

Value Lowering::in_view(const ExprNode& node, const Value& of, bool is_across) {
  if (!frame_.sight) {
    const std::string measure = "`" + std::string(sema::info(node.measure).name) + "`";
    return fail(node.span,
                frame_.jitters
                    ? measure +
                          " needs a first camera that stands in one place; this one has "
                          "`jitter` and stands elsewhere in each start"
                    : measure + " needs a first camera that stands still and sees the area");
  }
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

Value Lowering::from_robot(const Value& of, const Vec3& axis) {
  const std::uint16_t base = vector_of(frame_.base);
  const std::uint16_t from_base = builder_.emit(Op::kVSUB, point(of), base);
  return Value::of_register(builder_.emit(Op::kVDOT, from_base, vector_of(axis)));
}

Value Lowering::measure(const ExprNode& node) {
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

}  // namespace probe::lower
