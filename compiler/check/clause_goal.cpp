#include "compiler/check/clause_goal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace probe::sema {
namespace {

using Does = Clause::Does;

class ClauseGoal {
 public:
  ClauseGoal(const Model& model, const Task& task, const Clauses& clauses, const Goal& goal)
      : model_(model), task_(task), clauses_(clauses), goal_(goal) {}

  std::optional<std::string> lack() const {
    for (const Clause& clause : clauses_.all) {
      if (!clause.certain) continue;
      std::optional<std::string> why;
      if (clause.denied) {
        if (why = denied_lack(clause); why) return "says \"not " + clause.words + "\" and " + *why;
        continue;
      }
      if (clause.does == Does::kPuts && clause.goes) why = put_lack(clause);
      if (!why && (clause.does == Does::kPuts || clause.does == Does::kTakes))
        why = count_lack(clause);
      if (!why && (clause.does == Does::kOpens || clause.does == Does::kCloses))
        why = joint_lack(clause);
      if (why) return "says \"" + clause.words + "\" and " + *why;
    }
    return std::nullopt;
  }

 private:
  std::string name(ObjectId id) const { return "`" + model_.objects[id].name + "`"; }
  const std::optional<OfFixture>& of(ObjectId id) const { return model_.objects[id].of; }
  bool is_spoken(ObjectId id) const { return goal_.spoken.contains(id); }

  // Whether a region or a part stands for the other, or for the fixture that both are of. Two parts
  // with regions of their own are two places.
  bool is_same_place(ObjectId a, ObjectId b) const {
    if (a == b) return true;
    if (!of(a) || !of(b) || of(a)->fixture != of(b)->fixture) return false;
    return of(a)->part == of(b)->part || !has_own_region(a) || !has_own_region(b);
  }
  bool has_own_region(ObjectId id) const {
    const Fixture& fixture = model_.fixtures[of(id)->fixture];
    const Fixture::Part& part = fixture.parts[of(id)->part];
    return part.declared && part.joint &&
           std::any_of(fixture.regions.begin(), fixture.regions.end(),
                       [&](const Fixture::OwnRegion& own) { return own.part == of(id)->part; });
  }

  // How success measures a thing against a place, of all its comparisons of the two.
  std::optional<Goal::Bearing> bearing(ObjectId thing, ObjectId place) const {
    std::optional<Goal::Bearing> found;
    for (const auto& [two, one] : goal_.bearings) {
      if (two.first != thing && two.second != thing) continue;
      const ObjectId other = two.first == thing ? two.second : two.first;
      if (!is_same_place(other, place)) continue;
      if (!found) found.emplace();
      found->near = found->near || one.near;
      found->apart = found->apart || one.apart;
      found->other = found->other || one.other;
      found->asked = found->asked || one.asked;
    }
    return found;
  }

  // Where success wants a thing to be: near to another, or somewhere in a region, by whatever
  // coordinates.
  Things wanted_at(ObjectId thing) const {
    Things found;
    for (const auto& [two, one] : goal_.bearings) {
      if (!one.asked || (two.first != thing && two.second != thing)) continue;
      const ObjectId other = two.first == thing ? two.second : two.first;
      if (one.near || (one.other && of(other) && of(other)->region)) found.insert(other);
    }
    return found;
  }

  // Other objects that success measures it against.
  Things measured_against(ObjectId thing) const {
    Things found = wanted_at(thing);
    for (const auto& [two, one] : goal_.bearings) {
      if (!one.asked || (two.first != thing && two.second != thing)) continue;
      const ObjectId other = two.first == thing ? two.second : two.first;
      if (task_.is_object(other)) found.insert(other);
    }
    return found;
  }

  // "asks `on_top_of` of `cube` and `plate`", by the predicate that is of the fewest things.
  std::string asks(ObjectId thing, ObjectId place) const {
    const Goal::Asked* least = nullptr;
    for (const Goal::Asked& asked : goal_.asked) {
      const auto has = [&](ObjectId id) {
        return std::any_of(asked.of.begin(), asked.of.end(),
                           [&](const Things& things) { return things.contains(id); });
      };
      if (has(thing) && has(place) && (least == nullptr || asked.of.size() < least->of.size()))
        least = &asked;
    }
    const std::string both = " of " + name(thing) + " and " + name(place);
    if (least == nullptr) return "measures " + name(thing) + " against " + name(place);
    return "asks `" + model_.predicates[least->predicate].name + "`" + both;
  }

  std::optional<std::string> put_lack(const Clause& clause) const {
    if (goal_.asks_of_all) return std::nullopt;
    for (const Clause::What& what : clause.what) {
      std::vector<ObjectId> moved;
      for (const ObjectId id : what.of) {
        if (task_.is_object(id) && !clause.where.contains(id)) moved.push_back(id);
      }
      if (auto why = moved_lack(moved, clause)) return why;
    }
    return std::nullopt;
  }

  std::optional<std::string> moved_lack(const std::vector<ObjectId>& moved,
                                        const Clause& clause) const {
    Goal::Bearing all;
    bool is_measured = false;
    for (const ObjectId thing : moved) {
      for (const ObjectId place : clause.where) {
        const auto one = bearing(thing, place);
        if (!one) continue;
        is_measured = true;
        all.near = all.near || one->near;
        all.apart = all.apart || one->apart;
        all.other = all.other || one->other;
        all.asked = all.asked || one->asked;
      }
    }
    if (is_measured) {
      if (auto why = height_lack(moved, clause)) return why;
      // Not there is all that it wants.
      if (all.near || !all.apart || (all.other && all.asked) || moved.size() != 1 ||
          clause.where.empty())
        return std::nullopt;
      return "success wants " + name(moved.front()) + " not to be there";
    }
    const bool speaks =
        std::any_of(moved.begin(), moved.end(), [&](ObjectId thing) { return is_spoken(thing); });
    if (!speaks) return unspoken(moved, clause);
    if (moved.size() != 1) return std::nullopt;
    const ObjectId thing = moved.front();
    const bool is_beside = clause.lies == Clause::Where::kBeside;
    for (const ObjectId place : is_beside ? measured_against(thing) : wanted_at(thing)) {
      const bool may_be_there = std::any_of(
          clause.where.begin(), clause.where.end(),
          [&](ObjectId said) { return is_same_place(said, place) || lies_on(said, place); });
      if (!may_be_there) return "success " + asks(thing, place);
    }
    return std::nullopt;
  }

  // "do not put the cube on the tray" of which success is that it is there.
  std::optional<std::string> denied_lack(const Clause& clause) const {
    if (clause.what.size() != 1 || clause.what[0].of.size() != 1) return std::nullopt;
    const ObjectId thing = *clause.what[0].of.begin();
    if (clause.does == Does::kPuts && clause.goes && clause.where.size() == 1) {
      const auto one = bearing(thing, *clause.where.begin());
      if (one && one->near && one->asked && !one->apart)
        return "success wants " + name(thing) + " to be there";
    }
    if (clause.does != Does::kOpens && clause.does != Does::kCloses) return std::nullopt;
    const auto way = goal_.ways.find(thing);
    if (way == goal_.ways.end() || way->second.other) return std::nullopt;
    const bool closes = clause.does == Does::kCloses;
    if (!(closes ? way->second.closes && !way->second.opens
                 : way->second.opens && !way->second.closes))
      return std::nullopt;
    return "success is that " + name(thing) + " has moved at " + (closes ? "most" : "least") +
           " so far";
  }

  // "put the plate on the carrot" of which success wants the carrot to be higher.
  std::optional<std::string> height_lack(const std::vector<ObjectId>& moved,
                                         const Clause& clause) const {
    const bool is_on = clause.lies == Clause::Where::kOn;
    if (moved.size() != 1 || clause.where.size() != 1 ||
        (!is_on && clause.lies != Clause::Where::kUnder))
      return std::nullopt;
    const ObjectId thing = moved.front(), place = *clause.where.begin();
    const ObjectId high = is_on ? thing : place, low = is_on ? place : thing;
    if (!goal_.above.contains({low, high}) || goal_.above.contains({high, low}))
      return std::nullopt;
    return "success wants " + name(low) + " to be higher than " + name(high);
  }

  // Success is about other things.
  std::optional<std::string> unspoken(const std::vector<ObjectId>& moved,
                                      const Clause& clause) const {
    if (goal_.spoken.empty() && goal_.ways.empty()) return std::nullopt;
    // Another metric may judge it; and what is not understood may say why it is not judged.
    const auto& beside = goal_.measured_beside;
    const bool is_judged_beside = std::any_of(beside.begin(), beside.end(), [&](const auto& two) {
      return std::any_of(moved.begin(), moved.end(),
                         [&](ObjectId id) { return two.first == id || two.second == id; });
    });
    if (is_judged_beside || !clauses_.is_whole) return std::nullopt;
    if (moved.size() == 1) return "success asks nothing of " + name(moved.front());
    const auto& spoken = goal_.spoken;
    const bool moves_none = std::none_of(spoken.begin(), spoken.end(),
                                         [&](ObjectId id) { return task_.is_object(id); });
    const bool is_there = std::any_of(clause.where.begin(), clause.where.end(), [&](ObjectId said) {
      return is_spoken(said) || std::any_of(spoken.begin(), spoken.end(),
                                            [&](ObjectId id) { return is_same_place(id, said); });
    });
    if (!moves_none || is_there || clause.where.empty()) return std::nullopt;
    return "success asks nothing of " + name(*clause.where.begin());
  }

  // Whether one begins on or in the other, seen from above: then it may be said for it.
  bool lies_on(ObjectId a, ObjectId b) const {
    if (task_.starts.empty()) return true;
    if (!task_.is_object(a) || !task_.is_object(b)) {
      // What is put into a fixture has a height of its own; in a table of starts all may have.
      if (!model_.layouts[task_.layout].given.empty()) return false;
      const ObjectId object = task_.is_object(a) ? a : b;
      const auto at = placed(object);
      return at == nullptr || at->z.has_value();
    }
    const auto one = placed(a), other = placed(b);
    if (one == nullptr || other == nullptr) return true;
    const auto half = [&](ObjectId id) {
      const Object& object = model_.objects[id];
      return std::hypot(object.box_max[0] - object.box_min[0],
                        object.box_max[1] - object.box_min[1]) /
             2;
    };
    return std::hypot(one->x - other->x, one->y - other->y) < std::max(half(a), half(b));
  }
  const Start::Placed* placed(ObjectId id) const {
    const auto& all = task_.starts.front().placed;
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&](const Start::Placed& one) { return one.object == id; });
    return at == all.end() ? nullptr : &*at;
  }

  // "both cubes" of which success asks the same of three.
  std::optional<std::string> count_lack(const Clause& clause) const {
    for (const Clause::What& what : clause.what) {
      if (what.count == 0) continue;
      std::map<std::pair<PredicateId, std::vector<Things>>, Things> alike;
      for (const Goal::Asked& asked : goal_.asked) {
        if (asked.of.size() < 2 || asked.of[0].size() != 1) continue;
        const ObjectId thing = *asked.of[0].begin();
        if (what.of.contains(thing))
          alike[{asked.predicate, {asked.of.begin() + 1, asked.of.end()}}].insert(thing);
      }
      for (const auto& [same, things] : alike) {
        if (things.size() > what.count)
          return "success asks `" + model_.predicates[same.first].name + "` of " +
                 std::to_string(things.size());
      }
    }
    return std::nullopt;
  }

  // The parts of a clause that opens or closes.
  Things parts_of(const Clause& clause) const {
    Things parts;
    for (const Clause::What& what : clause.what) {
      for (const ObjectId id : what.of) {
        if (of(id) && of(id)->is_part()) parts.insert(id);
      }
    }
    return parts;
  }

  // "open the drawer and close it" of which success asks that it is open, or nothing of it.
  std::optional<std::string> joint_lack(const Clause& clause) const {
    const Things parts = parts_of(clause);
    if (clause.what.size() != 1 || parts.empty() || goal_.moves_unnamed) return std::nullopt;
    // What is done last is what is left.
    for (const Clause* later = &clause + 1; later != clauses_.all.data() + clauses_.all.size();
         ++later) {
      const bool moves = later->does == Does::kOpens || later->does == Does::kCloses ||
                         later->does == Does::kOther || !later->certain;
      const Things others = parts_of(*later);
      if (moves && (later->what.empty() || others.empty() ||
                    std::any_of(others.begin(), others.end(),
                                [&](ObjectId id) { return parts.contains(id); })))
        return std::nullopt;
    }
    const bool closes = clause.does == Does::kCloses;
    Goal::Way all;
    bool is_measured = false, is_any_free = false;  // of several it may be any that is meant
    for (const ObjectId part : parts) {
      if (is_spoken(part) && !goal_.ways.contains(part)) return std::nullopt;
      const auto way = goal_.ways.find(part);
      is_any_free = is_any_free || way == goal_.ways.end();
      if (way == goal_.ways.end()) continue;
      is_measured = true;
      all.opens = all.opens || way->second.opens;
      all.closes = all.closes || way->second.closes;
      all.other = all.other || way->second.other;
    }
    if (is_measured) {
      if (is_any_free || all.other || (closes ? all.closes : all.opens)) return std::nullopt;
      return "success is that " + name(*parts.begin()) + " has moved at " +
             (closes ? "least" : "most") + " so far";
    }
    const bool is_about = std::any_of(parts.begin(), parts.end(), [&](ObjectId part) {
      return std::any_of(goal_.bearings.begin(), goal_.bearings.end(), [&](const auto& one) {
        const auto is_of = [&](ObjectId id) {
          return of(id) && of(id)->fixture == of(part)->fixture;
        };
        return is_of(one.first.first) || is_of(one.first.second);
      });
    });
    // What lies in a drawer got there through its being open; what is not done last may be the way
    // to what is.
    const bool is_last = &clause == &clauses_.all.back();
    if ((!closes && is_about) || !is_last || !clauses_.is_whole) return std::nullopt;
    if (goal_.spoken.empty() && goal_.ways.empty() && goal_.bearings.empty()) return std::nullopt;
    return "success asks nothing of how far " + name(*parts.begin()) + " has moved";
  }

  const Model& model_;
  const Task& task_;
  const Clauses& clauses_;
  const Goal& goal_;
};

}  // namespace

std::optional<std::string> clause_lack(const Model& model, const Task& task, const Clauses& clauses,
                                       const Goal& goal) {
  return ClauseGoal(model, task, clauses, goal).lack();
}

}  // namespace probe::sema
