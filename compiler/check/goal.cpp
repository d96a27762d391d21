#include "compiler/check/goal.h"

#include <algorithm>

#include "compiler/check/goal_bearings.h"
#include "compiler/check/goal_things.h"

namespace probe::sema {
namespace {

class Reader : GoalThings {
 public:
  Reader(const Model& model, const Task& task, Goal& goal) : GoalThings(model, task), goal_(goal) {}

  // What a metric speaks of at all.
  void speak(const Metric& metric) { measure(metric.expr, Given(metric.variables)); }

  void read(const Metric& metric) {
    const Given given(metric.variables);
    measure(metric.expr, given);
    look_for_sides(metric.expr, std::vector<bool>(metric.variables));
    ask(metric.expr, given);
    goal_.forgets = metric.readout == plan::Readout::kAtEnd && !remembers_;
    if (metric.readout == plan::Readout::kOnce) order_within(metric.expr, given);
    order(metric.expr, given);
  }

 private:
  // Whether this call has not been looked at yet, for one purpose.
  using Calls = std::set<std::pair<PredicateId, Given>>;
  static bool is_new(Calls& calls, const ExprNode& call, const Given& inner) {
    return calls.insert({call.predicate, inner}).second;
  }

  // Whether a number, or what a vector is made of, becomes its opposite where left and right
  // change places. `odd`: by variable.
  bool is_odd(ExprRef ref, const std::vector<bool>& odd) const {
    if (ref == kNoExpr) return false;
    const ExprNode& node = at(ref);
    const auto any = [&] {
      return std::any_of(node.args.begin(), node.args.end(),
                         [&](ExprRef arg) { return is_odd(arg, odd); });
    };
    switch (node.op) {
      case ExprOp::kVariable:
        return node.a < odd.size() && odd[node.a];
      case ExprOp::kAdd:
      case ExprOp::kSubtract:
      case ExprOp::kNegate:
        return any();
      case ExprOp::kMultiply:
      case ExprOp::kDivide:
        return is_odd(node.args[0], odd) != is_odd(node.args[1], odd);
      case ExprOp::kCall:
        return is_odd(model_.predicates[node.predicate].body, odd_of(node, odd));
      case ExprOp::kMeasure:
        break;
      default:
        return false;
    }
    switch (node.measure) {
      case Measure::kX:
      case Measure::kY:
      case Measure::kZ: {
        // Of a size, which has no side; the height of a place, but not of one in another's frame.
        const ExprNode& of = at(node.args[0]);
        const bool is_size = of.op == ExprOp::kMeasure &&
                             (of.measure == Measure::kHalfSize || of.measure == Measure::kHalf);
        return !is_size && (node.measure != Measure::kZ || is_odd(node.args[0], odd));
      }
      case Measure::kViewX:
      case Measure::kViewY:
      case Measure::kRobotX:
      case Measure::kRobotY:
      case Measure::kAxisX:
      case Measure::kAxisY:
      case Measure::kLocal:
      case Measure::kCentre:
        return true;
      case Measure::kAngle:
        // To the vertical: how a thing stands.
        return any() && std::none_of(node.args.begin(), node.args.end(), [&](ExprRef arg) {
                 return at(arg).op == ExprOp::kMeasure && at(arg).measure == Measure::kUp;
               });
      case Measure::kMin:
      case Measure::kMax:
      case Measure::kLatest:
        return any();
      default:
        return false;
    }
  }
  std::vector<bool> odd_of(const ExprNode& call, const std::vector<bool>& odd) const {
    std::vector<bool> inner(model_.predicates[call.predicate].variables);
    for (std::size_t i = 0; i < call.args.size() && i < inner.size(); ++i)
      inner[i] = is_odd(call.args[i], odd);
    return inner;
  }
  void look_for_sides(ExprRef ref, const std::vector<bool>& odd) {
    if (ref == kNoExpr || goal_.tells_sides) return;
    const ExprNode& node = at(ref);
    switch (node.op) {
      case ExprOp::kLess:
      case ExprOp::kLessEqual:
      case ExprOp::kEqual:
        goal_.tells_sides = is_odd(node.args[0], odd) || is_odd(node.args[1], odd);
        break;
      case ExprOp::kCall: {
        std::vector<bool> inner = odd_of(node, odd);
        if (sided_.insert({node.predicate, inner}).second)
          look_for_sides(model_.predicates[node.predicate].body, inner);
        break;
      }
      default:
        break;
    }
    for (const ExprRef arg : node.args) look_for_sides(arg, odd);
  }

  // What is measured at all, of whatever condition.
  void measure(ExprRef ref, const Given& given) {
    if (ref == kNoExpr) return;
    const ExprNode& node = at(ref);
    switch (node.op) {
      case ExprOp::kOnce:
      case ExprOp::kAlways:
      case ExprOp::kHold:
        remembers_ = true;
        break;
      case ExprOp::kRole:
      case ExprOp::kObject:
      case ExprOp::kPart:
      case ExprOp::kJoint:
        goal_.spoken.merge(things(ref, given));
        break;
      case ExprOp::kVector:
      case ExprOp::kRegion:
      case ExprOp::kRegionOf:
        goal_.tells_sides = true;
        break;
      case ExprOp::kMeasure:
        remembers_ = remembers_ || node.measure == Measure::kLatest;
        goal_.tells_sides = goal_.tells_sides || tells_sides(node.measure);
        if (node.args.size() > 1) compare(things(ref, given));
        break;
      case ExprOp::kLess:
      case ExprOp::kLessEqual:
      case ExprOp::kEqual:
        compare(things(ref, given));
        break;
      case ExprOp::kCall: {
        const Given inner = given_to(node, given);
        // A number of two things is measured inside.
        if (is_new(measured_, node, inner)) measure(model_.predicates[node.predicate].body, inner);
        break;
      }
      case ExprOp::kAny:
      case ExprOp::kAll:
      case ExprOp::kNo: {
        Given inner = given;
        Things among = things_in(node.set, given);
        goal_.speaks_of_all = goal_.speaks_of_all || among.empty();
        goal_.spoken.insert(among.begin(), among.end());
        bind(inner, node.a, std::move(among));
        measure(node.args[0], inner);
        return;
      }
      default:
        break;
    }
    for (const ExprRef arg : node.args) measure(arg, given);
  }

  static bool tells_sides(Measure measure) {
    switch (measure) {
      case Measure::kTravel:
      case Measure::kRate:
      case Measure::kSlide:
      case Measure::kTurn:
      case Measure::kWithin:
        return true;
      default:
        return false;
    }
  }

  void compare(const Things& of) {
    for (auto a = of.begin(); a != of.end(); ++a) {
      for (auto b = std::next(a); b != of.end(); ++b) goal_.compared.insert({*a, *b});
    }
  }

  // What a call is of, but for the numbers behind it: `by: length = 3cm`.
  std::vector<Things> of_things(const ExprNode& call, const Given& inner) const {
    const auto& parameters = called(call).parameters;
    std::size_t count = std::min({call.args.size(), inner.size(), parameters.size()});
    const auto is_number = [](TypeKind kind) {
      return kind == TypeKind::kReal || kind == TypeKind::kVector || kind == TypeKind::kBool;
    };
    while (count > 0 && inner[count - 1].empty() && is_number(parameters[count - 1].type.kind))
      --count;
    return {inner.begin(), inner.begin() + static_cast<std::ptrdiff_t>(count)};
  }

  // What has to hold for certain.
  void ask(ExprRef ref, const Given& given) {
    if (ref == kNoExpr) return;
    const ExprNode& node = at(ref);
    switch (node.op) {
      case ExprOp::kAnd:
      case ExprOp::kHold:
      case ExprOp::kOnce:
      case ExprOp::kAlways:
        for (const ExprRef arg : node.args) ask(arg, given);
        return;
      case ExprOp::kAll: {
        Given inner = given;
        for (const ObjectId one : things_in(node.set, given)) {
          bind(inner, node.a, {one});
          ask(node.args[0], inner);
        }
        return;
      }
      case ExprOp::kAny: {
        const Things among = things_in(node.set, given);
        if (among.size() > 1) goal_.one_of.insert(among);
        return;
      }
      case ExprOp::kOr:
        ask_either(ref, given);
        return;
      case ExprOp::kCall: {
        const Given inner = given_to(node, given);
        goal_.asked.insert({node.predicate, of_things(node, inner)});
        if (is_new(asked_, node, inner)) ask(model_.predicates[node.predicate].body, inner);
        return;
      }
      default:
        return;
    }
  }

  // Of several ways none is certain. What they ask of one thing each, alike but for the thing, is
  // asked of either.
  void ask_either(ExprRef ref, const Given& given) {
    std::vector<std::set<Goal::Asked>> ways;
    collect_ways(ref, given, ways);
    for (auto a = ways.begin(); a != ways.end(); ++a) {
      for (auto b = std::next(a); b != ways.end(); ++b) {
        for (const Goal::Asked& one : *a) {
          for (const Goal::Asked& other : *b) {
            if (one.predicate != other.predicate || one.of.size() != other.of.size()) continue;
            if (one.of.empty() || one.of[0].size() != 1 || other.of[0].size() != 1) continue;
            if (one.of[0] == other.of[0] ||
                !std::equal(one.of.begin() + 1, one.of.end(), other.of.begin() + 1))
              continue;
            goal_.either.insert({*one.of[0].begin(), *other.of[0].begin()});
          }
        }
      }
    }
  }

  void collect_ways(ExprRef ref, const Given& given, std::vector<std::set<Goal::Asked>>& ways) {
    if (at(ref).op == ExprOp::kOr) {
      for (const ExprRef arg : at(ref).args) collect_ways(arg, given, ways);
      return;
    }
    Goal way;
    Reader(model_, task_, way).ask(ref, given);
    ways.push_back(std::move(way.asked));
  }

  // One of several conditions that hold together.
  struct Part {
    enum Kind : std::uint8_t { kNow, kNot, kNever } kind = kNow;
    Things of;
    PredicateId predicate = PredicateId::kNone;  // called
  };

  void collect_parts(ExprRef ref, const Given& given, std::vector<Part>& parts) const {
    const ExprNode& node = at(ref);
    const auto called = [&](ExprRef one) {
      return at(one).op == ExprOp::kCall ? at(one).predicate : PredicateId::kNone;
    };
    switch (node.op) {
      case ExprOp::kAnd:
      case ExprOp::kHold:
        for (const ExprRef arg : node.args) collect_parts(arg, given, parts);
        return;
      case ExprOp::kNot: {
        const ExprNode& denied = at(node.args[0]);
        const bool is_never = denied.op == ExprOp::kOnce;
        const ExprRef what = is_never ? denied.args[0] : node.args[0];
        parts.push_back({is_never ? Part::kNever : Part::kNot, things(what, given), called(what)});
        return;
      }
      case ExprOp::kCall: {
        // One that says itself what is not yet is several conditions.
        const ExprRef body = model_.predicates[node.predicate].body;
        const auto is_not_yet = [&](ExprRef one) {
          return at(one).op == ExprOp::kNot && at(at(one).args[0]).op == ExprOp::kOnce;
        };
        if (body != kNoExpr && at(body).op == ExprOp::kAnd &&
            std::any_of(at(body).args.begin(), at(body).args.end(), is_not_yet)) {
          collect_parts(body, given_to(node, given), parts);
          return;
        }
        break;
      }
      default:
        break;
    }
    parts.push_back({Part::kNow, things(ref, given), called(ref)});
  }

  void put_in_order(const Things& first, const Things& second) {
    Things before, after;
    std::set_difference(first.begin(), first.end(), second.begin(), second.end(),
                        std::inserter(before, before.end()));
    std::set_difference(second.begin(), second.end(), first.begin(), first.end(),
                        std::inserter(after, after.end()));
    if (!before.empty() && !after.empty()) goal_.order.insert({before, after});
  }

  // At one step all of it holds: what is now, before what has never been so, or before the same of
  // another that is not so. (`once a and b` wants no order: b may have been so all along.)
  void order_within(ExprRef ref, const Given& given) {
    std::vector<Part> parts;
    collect_parts(ref, given, parts);
    for (const Part& now : parts) {
      if (now.kind != Part::kNow) continue;
      for (const Part& other : parts) {
        const bool is_same =
            other.predicate == now.predicate && other.predicate != PredicateId::kNone;
        if (other.kind == Part::kNever || (other.kind == Part::kNot && is_same))
          put_in_order(now.of, other.of);
      }
    }
  }

  // `not once (b and not once a)`: b never was so before a had been.
  void never_before(ExprRef denied, const Given& given) {
    if (at(denied).op != ExprOp::kOnce) return;
    std::vector<Part> parts;
    collect_parts(at(denied).args[0], given, parts);
    for (const Part& now : parts) {
      if (now.kind != Part::kNow) continue;
      for (const Part& other : parts) {
        if (other.kind == Part::kNever) put_in_order(other.of, now.of);
      }
    }
  }

  void order(ExprRef ref, const Given& given) {
    if (ref == kNoExpr) return;
    const ExprNode& node = at(ref);
    switch (node.op) {
      case ExprOp::kOnce:
        order_within(node.args[0], given);
        break;
      case ExprOp::kNot:
        never_before(node.args[0], given);
        return;
      case ExprOp::kAnd:
      case ExprOp::kHold:
      case ExprOp::kAlways:
        break;
      case ExprOp::kCall: {
        const Given inner = given_to(node, given);
        if (is_new(ordered_, node, inner)) order(model_.predicates[node.predicate].body, inner);
        return;
      }
      default:
        return;
    }
    for (const ExprRef arg : node.args) order(arg, given);
  }

  Goal& goal_;
  bool remembers_ = false;
  Calls measured_, asked_, ordered_;
  std::set<std::pair<PredicateId, std::vector<bool>>> sided_;  // looked at for sides
};

}  // namespace

Goal goal_of(const Model& model, const Task& task) {
  Goal goal;
  Reader reader(model, task, goal);
  for (const Metric& metric : task.judged) {
    if (metric.name != "success") {
      Goal beside;
      read_bearings(model, task, metric, beside);
      for (const auto& [two, bearing] : beside.bearings) goal.measured_beside.insert(two);
      continue;
    }
    reader.read(metric);
    read_bearings(model, task, metric, goal);
  }
  return goal;
}

std::string content_with_any(const Things& of) {
  return "succeeds with one of " + std::to_string(of.size()) + " (`any`, not `all`)";
}
std::string content_with_either(const Things& of) {
  return "succeeds with one of " + std::to_string(of.size()) + " (`or`, not `and`)";
}

bool is_measured(const Model& model, const Task& task, ObjectId thing) {
  Goal goal;
  Reader reader(model, task, goal);
  for (const Metric& metric : task.judged) reader.speak(metric);
  return goal.speaks_of_all || goal.spoken.contains(thing);
}

}  // namespace probe::sema
