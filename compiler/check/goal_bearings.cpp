#include "compiler/check/goal_bearings.h"

#include <algorithm>
#include <tuple>

#include "compiler/check/goal_things.h"

namespace probe::sema {
namespace {

// What a goal does to a condition or a number: it has to hold, or to be small; the opposite; or
// either may do.
enum class Sense : std::int8_t { kAgainst = -1, kEither = 0, kFor = 1 };
Sense against(Sense sense) { return static_cast<Sense>(-static_cast<int>(sense)); }

class BearingReader : GoalThings {
 public:
  BearingReader(const Model& model, const Task& task, Goal& goal)
      : GoalThings(model, task), goal_(goal) {}

  void condition(ExprRef ref, const Given& given, Sense sense) {
    if (ref == kNoExpr) return;
    const ExprNode& node = at(ref);
    // Of several ways that will do none is certain.
    const bool was_certain = certain_;
    const bool is_all = node.op == ExprOp::kAnd || node.op == ExprOp::kAll;
    const bool is_any = node.op == ExprOp::kOr || node.op == ExprOp::kAny || node.op == ExprOp::kNo;
    if (is_any ? sense != (node.op == ExprOp::kNo ? Sense::kFor : Sense::kAgainst)
               : is_all && sense != Sense::kFor)
      certain_ = false;
    look(node, given, sense);
    certain_ = was_certain;
  }

 private:
  void look(const ExprNode& node, const Given& given, Sense sense) {
    switch (node.op) {
      case ExprOp::kNot:
        condition(node.args[0], given, against(sense));
        return;
      case ExprOp::kAny:
      case ExprOp::kAll:
      case ExprOp::kNo:
        each(node, given, node.op == ExprOp::kNo ? against(sense) : sense);
        return;
      case ExprOp::kLess:
      case ExprOp::kLessEqual:
        compare(node, given, sense);
        return;
      case ExprOp::kEqual:
        compare(node, given, Sense::kEither);
        return;
      case ExprOp::kCall:
        call(node, given, sense,
             [&](ExprRef body, const Given& inner) { condition(body, inner, sense); });
        return;
      case ExprOp::kMeasure:
        // The one measure that is a condition: a point in a region.
        is_asked_ = sense != Sense::kAgainst;
        if (node.args.size() == 2)
          pairs(things(node.args[0], given), things(node.args[1], given), sense);
        return;
      default:
        for (const ExprRef arg : node.args) condition(arg, given, sense);
    }
  }

  // One after the other where it is known who they are: what holds of each holds of no two of them.
  void each(const ExprNode& node, const Given& given, Sense sense) {
    Given inner = given;
    const Things among = things_in(node.set, given);
    if (among.empty()) {
      goal_.asks_of_all =
          goal_.asks_of_all || (sense != Sense::kAgainst && may_hold_things(node.set));
      bind(inner, node.a, {});
      condition(node.args[0], inner, sense);
    }
    for (const ObjectId one : among) {
      bind(inner, node.a, {one});
      condition(node.args[0], inner, sense);
    }
  }

  // Whether anything but the robot and what carries the scene may be in it.
  bool may_hold_things(SetRef ref) const {
    const SetNode& set = model_.exprs.sets[ref];
    switch (set.op) {
      case SetOp::kFingers:
      case SetOp::kLinks:
        return false;
      case SetOp::kUnion:
        return may_hold_things(set.left) || may_hold_things(set.right);
      case SetOp::kIntersection:
        return may_hold_things(set.left) && may_hold_things(set.right);
      case SetOp::kDifference:
        return may_hold_things(set.left) && !takes_objects(ref);
      default:
        return true;
    }
  }
  // `bodies - objects`, or that and more.
  bool takes_objects(SetRef ref) const {
    const SetNode& set = model_.exprs.sets[ref];
    return set.op == SetOp::kDifference &&
           (model_.exprs.sets[set.right].op == SetOp::kObjects || takes_objects(set.left));
  }

  template <typename Look>
  void call(const ExprNode& node, const Given& given, Sense sense, Look look) {
    const Given inner = given_to(node, given);
    if (called_.insert({node.predicate, inner, sense, certain_}).second)
      look(called(node).body, inner);
  }

  // `a < b` is so where a is small and b is large.
  void compare(const ExprNode& node, const Given& given, Sense sense) {
    is_asked_ = sense != Sense::kAgainst;
    if (sense == Sense::kFor) {
      const ObjectId low = whose_height(node.args[0], given),
                     high = whose_height(node.args[1], given);
      if (low != ObjectId::kNone && high != ObjectId::kNone && low != high)
        goal_.above.insert({high, low});
    }
    decided_.clear();
    grows_now_.clear();
    shrinks_then_.clear();
    number(node.args[0], given, sense);
    number(node.args[1], given, against(sense));
    if (certain_ && sense == Sense::kFor) take_changes();
    Things all = things(node.args[0], given);
    all.merge(things(node.args[1], given));
    for (auto a = all.begin(); a != all.end(); ++a) {
      for (auto b = std::next(a); b != all.end(); ++b) {
        if (decided_.contains({*a, *b})) continue;
        Goal::Bearing& bearing = goal_.bearings[{*a, *b}];
        bearing.other = true;
        bearing.asked = bearing.asked || sense != Sense::kAgainst;
      }
    }
  }

  // What is other than it began.
  void take_changes() {
    for (const auto& one : grows_now_) {
      if (!shrinks_then_.contains(one)) continue;
      const auto& [measure, thing, grows] = one;
      using Went = Goal::Went;
      if (measure == Measure::kHeight && grows) goal_.raised.insert(thing);
      if (measure == Measure::kViewX)
        goal_.went.insert({thing, grows ? Went::kRight : Went::kLeft});
      if (measure == Measure::kViewY)
        goal_.went.insert({thing, grows ? Went::kNearer : Went::kFarther});
    }
  }
  // A coordinate of one thing, as it is or as it began.
  void note_change(Measure measure, ExprRef point, const Given& given, Sense small) {
    const Things of = things(point, given);
    if (of.size() != 1 || small == Sense::kEither) return;
    const bool is_start = at(point).op == ExprOp::kMeasure && at(point).measure == Measure::kStart;
    const bool grows = (small == Sense::kAgainst) != is_start;
    (is_start ? shrinks_then_ : grows_now_).insert({measure, *of.begin(), grows});
  }
  void note_distance(const ExprNode& node, const Given& given, Sense small) {
    const auto is_start = [&](ExprRef point) {
      return at(point).op == ExprOp::kMeasure && at(point).measure == Measure::kStart;
    };
    const Things a = things(node.args[0], given), b = things(node.args[1], given);
    if (certain_ && small == Sense::kAgainst && a.size() == 1 && a == b &&
        is_start(node.args[0]) != is_start(node.args[1]))
      goal_.shifted.insert(*a.begin());
  }

  // Where a number is the height of one thing and nothing else.
  ObjectId whose_height(ExprRef ref, const Given& given) const {
    const ExprNode& node = at(ref);
    if (node.op != ExprOp::kMeasure ||
        (node.measure != Measure::kHeight && node.measure != Measure::kZ))
      return ObjectId::kNone;
    const ExprNode& point = at(node.args[0]);
    const bool is_of_body = point.op != ExprOp::kMeasure || point.measure == Measure::kPosition ||
                            point.measure == Measure::kOrigin;
    const Things of = things(node.args[0], given);
    return is_of_body && of.size() == 1 ? *of.begin() : ObjectId::kNone;
  }

  void number(ExprRef ref, const Given& given, Sense small) {
    if (ref == kNoExpr) return;
    const ExprNode& node = at(ref);
    switch (node.op) {
      case ExprOp::kSubtract:
      case ExprOp::kDivide:
        number(node.args[0], given, small);
        number(node.args[1], given, against(small));
        return;
      case ExprOp::kNegate:
        number(node.args[0], given, against(small));
        return;
      case ExprOp::kAdd:
      case ExprOp::kMultiply:
        for (const ExprRef arg : node.args) number(arg, given, small);
        return;
      case ExprOp::kCall:
        call(node, given, small,
             [&](ExprRef body, const Given& inner) { number(body, inner, small); });
        return;
      case ExprOp::kMeasure:
        measure(node, given, small);
        return;
      default:
        return;
    }
  }

  void measure(const ExprNode& node, const Given& given, Sense small) {
    switch (node.measure) {
      case Measure::kHeight:
      case Measure::kZ:
        note_change(Measure::kHeight, node.args[0], given, small);
        return;
      case Measure::kViewX:
      case Measure::kViewY:
        note_change(node.measure, node.args[0], given, small);
        return;
      case Measure::kMovedXy:
        if (const Things of = things(node.args[0], given);
            certain_ && small == Sense::kAgainst && is_asked_ && of.size() == 1)
          goal_.shifted.insert(*of.begin());
        return;
      case Measure::kDistance:
      case Measure::kDistanceXy:
        note_distance(node, given, small);
        pairs(things(node.args[0], given), things(node.args[1], given), small);
        return;
      case Measure::kImpulse:
        pairs(things(node.args[0], given), things(node.args[1], given), against(small));
        return;
      case Measure::kTravel:
      case Measure::kSlide:
      case Measure::kTurn:
        way(node.args[0], given, small);
        return;
      case Measure::kMin:
      case Measure::kMax:
      case Measure::kAbs:
        for (const ExprRef arg : node.args) number(arg, given, small);
        return;
      case Measure::kLatest:
        number(node.args[0], given, Sense::kEither);
        condition(node.args[1], given, Sense::kEither);
        return;
      default:
        return;
    }
  }

  void pairs(const Things& of, const Things& with, Sense near) {
    for (const ObjectId a : of) {
      for (const ObjectId b : with) {
        if (a == b) continue;
        const std::pair<ObjectId, ObjectId> two = std::minmax(a, b);
        decided_.insert(two);
        Goal::Bearing& bearing = goal_.bearings[two];
        (near == Sense::kFor       ? bearing.near
         : near == Sense::kAgainst ? bearing.apart
                                   : bearing.other) = true;
        bearing.asked = bearing.asked || is_asked_;
      }
    }
  }

  void way(ExprRef joint, const Given& given, Sense small) {
    const Things moved = things(joint, given);
    goal_.moves_unnamed = goal_.moves_unnamed || moved.empty();
    for (const ObjectId part : moved) {
      Goal::Way& found = goal_.ways[part];
      (small == Sense::kFor       ? found.closes
       : small == Sense::kAgainst ? found.opens
                                  : found.other) = true;
    }
  }

  Goal& goal_;
  bool certain_ = true;  // no other way will do
  // Of one comparison: which numbers of a thing as it is are to be large, and of it as it began to
  // be small; or the other way round.
  std::set<std::tuple<Measure, ObjectId, bool>> grows_now_, shrinks_then_;
  bool is_asked_ = true;                                          // what is looked at has to hold
  std::set<std::tuple<PredicateId, Given, Sense, bool>> called_;  // looked at
  std::set<std::pair<ObjectId, ObjectId>> decided_;  // by the comparison that is looked at
};

}  // namespace

void read_bearings(const Model& model, const Task& task, const Metric& metric, Goal& goal) {
  BearingReader(model, task, goal).condition(metric.expr, Given(metric.variables), Sense::kFor);
}

}  // namespace probe::sema
