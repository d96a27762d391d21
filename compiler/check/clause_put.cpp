// Where a clause puts things, held to where success wants them.
#include <algorithm>
#include <vector>

#include "compiler/check/clause_lacks.h"
#include "compiler/check/relation_words.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

bool is_measured_beside(const ClauseFacts& facts, const Things& things) {
  const auto& beside = facts.goal.measured_beside;
  return std::any_of(beside.begin(), beside.end(), [&](const auto& two) {
    return things.contains(two.first) || things.contains(two.second);
  });
}

// "put the cube between the can and the tray" of which success is that the can is between.
Lack between_lack(const ClauseFacts& facts, const Clause& clause) {
  if (clause.lies != Clause::Where::kBeside || clause.what.size() != 1 ||
      clause.what[0].of.size() != 1 || clause.where.size() < 2)
    return std::nullopt;
  const Things& said = clause.what[0].of;
  const Goal::Asked* turned = nullptr;
  for (const Goal::Asked& asked : facts.goal.asked) {
    const Predicate& relation = facts.model.predicates[asked.predicate];
    if (!relation.is_relation || asked.of.size() != 3) continue;
    if (asked.of[0] == said) return std::nullopt;
    const bool is_in_it = asked.of[1] == said || asked.of[2] == said;
    if (is_in_it && asked.of[0].size() == 1 && clause.where.contains(*asked.of[0].begin()))
      turned = &asked;
  }
  if (turned == nullptr) return std::nullopt;
  return "success asks `" + facts.model.predicates[turned->predicate].name + "` of " +
         facts.name(*turned->of[0].begin());
}

// Whether success asks something of the first of two and the second, in this order: what hangs on a
// hook is put on it, and is lower.
bool asks_in_turn(const ClauseFacts& facts, ObjectId a, ObjectId b) {
  return std::any_of(facts.goal.asked.begin(), facts.goal.asked.end(), [&](const auto& asked) {
    return asked.of.size() > 1 && asked.of[0] == Things{a} && asked.of[1] == Things{b};
  });
}

// "put the plate on the carrot" of which success wants the carrot to be higher.
Lack height_lack(const ClauseFacts& facts, const std::vector<ObjectId>& moved,
                 const Clause& clause) {
  const bool is_on = clause.lies == Clause::Where::kOn;
  if (moved.size() != 1 || clause.where.empty() || (!is_on && clause.lies != Clause::Where::kUnder))
    return std::nullopt;
  const ObjectId thing = moved.front();
  for (const ObjectId place : clause.where) {
    const ObjectId high = is_on ? thing : place, low = is_on ? place : thing;
    if (!facts.goal.above.contains({low, high}) || facts.goal.above.contains({high, low}))
      return std::nullopt;
    if (is_on && (!asks_in_turn(facts, place, thing) || asks_in_turn(facts, thing, place)))
      return std::nullopt;
  }
  const ObjectId place = *clause.where.begin();
  return "success wants " + facts.name(is_on ? place : thing) + " to be higher than " +
         facts.name(is_on ? thing : place);
}

// "next to the plate" of which success wants it to be on the plate; "on the plate" of which it is
// to be apart from it.
Lack beside_lack(const ClauseFacts& facts, const std::vector<ObjectId>& moved, const Clause& clause,
                 const Goal::Bearing& all) {
  if (moved.size() != 1 || clause.where.size() != 1 || !all.near || !all.asked) return std::nullopt;
  const ObjectId thing = moved.front(), place = *clause.where.begin();
  if (clause.lies == Clause::Where::kBeside && !all.apart &&
      facts.goal.above.contains({thing, place}) && !facts.goal.above.contains({place, thing}))
    return "success wants " + facts.name(thing) + " to be higher than " + facts.name(place);
  if (clause.lies != Clause::Where::kOn) return std::nullopt;
  for (const Goal::Asked& asked : facts.goal.asked) {
    const Predicate& relation = facts.model.predicates[asked.predicate];
    if (!relation.is_relation || asked.of.size() < 2 || facts.goal.above.contains({thing, place}))
      continue;
    const bool is_of_both = (asked.of[0] == Things{thing} && asked.of[1] == Things{place}) ||
                            (asked.of[0] == Things{place} && asked.of[1] == Things{thing});
    if (is_of_both && !relation.words.empty() && !says(fold_case(clause.words), relation))
      return "success asks `" + relation.name + "`, which is said by \"" + relation.words.front() +
             "\"";
  }
  return std::nullopt;
}

// "into a drawer" of which success wants a certain one.
Lack anywhere_lack(const ClauseFacts& facts, const std::vector<ObjectId>& moved,
                   const Clause& clause) {
  if (!clause.is_anywhere || moved.size() != 1) return std::nullopt;
  Things wanted, free;
  for (const ObjectId place : clause.where) {
    const auto one = facts.bearing(moved[0], place);
    (one && one->asked ? wanted : free).insert(place);
  }
  // A part and its region are one place.
  for (const ObjectId place : wanted)
    std::erase_if(free, [&](ObjectId other) { return facts.is_same_place(place, other); });
  if (wanted.empty() || free.empty()) return std::nullopt;
  const ObjectId other = *wanted.begin();
  const bool is_one = std::all_of(wanted.begin(), wanted.end(),
                                  [&](ObjectId id) { return facts.is_same_place(id, other); });
  if (!is_one) return std::nullopt;
  return "success " + facts.asks(moved[0], other) + " alone";
}

// Success is about other things.
Lack unspoken(const ClauseFacts& facts, const std::vector<ObjectId>& moved, const Clause& clause) {
  if (facts.goal.speaks_of_all && facts.goal.spoken.empty() && facts.goal.ways.empty())
    return std::nullopt;
  // Another metric may judge it; and what is not understood may say why it is not judged.
  if (is_measured_beside(facts, {moved.begin(), moved.end()}) || !facts.clauses.is_whole)
    return std::nullopt;
  if (moved.size() == 1) return "success asks nothing of " + facts.name(moved.front());
  const auto& spoken = facts.goal.spoken;
  const bool moves_none = std::none_of(spoken.begin(), spoken.end(),
                                       [&](ObjectId id) { return facts.task.is_object(id); });
  const bool is_there = std::any_of(clause.where.begin(), clause.where.end(), [&](ObjectId said) {
    return facts.is_spoken(said) || std::any_of(spoken.begin(), spoken.end(), [&](ObjectId id) {
             return facts.is_same_place(id, said);
           });
  });
  if (!moves_none || is_there || clause.where.empty()) return std::nullopt;
  return "success asks nothing of " + facts.name(*clause.where.begin());
}

// "put the cube on the tray" of which success is that the cube was lifted.
Lack nowhere_lack(const ClauseFacts& facts, ObjectId thing, const Clause& clause) {
  const Goal& goal = facts.goal;
  const bool is_somewhere =
      goal.tells_sides || goal.speaks_of_all || goal.asks_of_all || !goal.ways.empty() ||
      std::any_of(goal.bearings.begin(), goal.bearings.end(), [&](const auto& one) {
        return one.first.first == thing || one.first.second == thing;
      });
  const bool goes_to_objects = std::all_of(clause.where.begin(), clause.where.end(),
                                           [&](ObjectId id) { return facts.task.is_object(id); });
  const bool is_changed = goal.raised.contains(thing) || goal.shifted.contains(thing);
  if (!is_changed || is_somewhere || clause.where.empty() || !goes_to_objects ||
      !facts.clauses.is_whole || facts.is_moved_later(clause, thing) ||
      is_measured_beside(facts, {thing}))
    return std::nullopt;
  return "success measures " + facts.name(thing) + " against nothing";
}

// "put the cup beside the cabinet" or "on the cabinet" of which success wants it in a drawer.
Lack outside_lack(const ClauseFacts& facts, const std::vector<ObjectId>& moved,
                  const Clause& clause) {
  if (moved.size() != 1 ||
      (clause.lies != Clause::Where::kBeside && clause.lies != Clause::Where::kOn))
    return std::nullopt;
  const Things wanted = facts.wanted_at(moved[0]);
  if (wanted.size() != 1) return std::nullopt;
  const ObjectId region = *wanted.begin();
  const auto& of = facts.of(region);
  if (!of || !of->region) return std::nullopt;
  const Fixture& fixture = facts.model.fixtures[of->fixture];
  if (!fixture.parts[fixture.regions[*of->region].part].joint) return std::nullopt;
  // "On the rack" may be in what slides out; "on the dishwasher" is not.
  const bool is_elsewhere =
      clause.lies == Clause::Where::kBeside ||
      std::any_of(clause.where.begin(), clause.where.end(), [&](ObjectId place) {
        return facts.of(place) && facts.of(place)->part != of->part;
      });
  if (!is_elsewhere) return std::nullopt;
  return "success wants " + facts.name(moved[0]) + " to be in " + facts.name(region);
}

Lack moved_lack(const ClauseFacts& facts, const std::vector<ObjectId>& moved,
                const Clause& clause) {
  Goal::Bearing all;
  bool is_measured = false;
  for (const ObjectId thing : moved) {
    for (const ObjectId place : clause.where) {
      const auto one = facts.bearing(thing, place);
      if (!one) continue;
      is_measured = true;
      all.add(*one);
    }
  }
  if (is_measured) {
    if (auto why = height_lack(facts, moved, clause)) return why;
    if (auto why = beside_lack(facts, moved, clause, all)) return why;
    if (auto why = anywhere_lack(facts, moved, clause)) return why;
    if (auto why = outside_lack(facts, moved, clause)) return why;
    // Not there is all that it wants.
    if (all.near || !all.apart || (all.other && all.asked) || moved.size() != 1 ||
        clause.where.empty())
      return std::nullopt;
    return "success wants " + facts.name(moved.front()) + " not to be there";
  }
  const bool speaks = std::any_of(moved.begin(), moved.end(),
                                  [&](ObjectId thing) { return facts.is_spoken(thing); });
  if (!speaks) return unspoken(facts, moved, clause);
  if (moved.size() != 1) return std::nullopt;
  const ObjectId thing = moved.front();
  for (const ObjectId place :
       clause.is_aside() ? facts.measured_against(thing) : facts.wanted_at(thing)) {
    const bool may_be_there =
        std::any_of(clause.where.begin(), clause.where.end(), [&](ObjectId said) {
          return facts.is_same_place(said, place) || facts.lies_on(said, place);
        });
    if (!may_be_there) return "success " + facts.asks(thing, place);
  }
  return nowhere_lack(facts, thing, clause);
}

// What success asks of a thing and, alike, of one that the clause handles: of two things each.
const Goal::Asked* asked_of_both(const ClauseFacts& facts, const Clause& clause, ObjectId spared) {
  const auto is_handled = [&](const Things& of) {
    return std::any_of(clause.what.begin(), clause.what.end(),
                       [&](const Clause::What& what) { return what.of == of; });
  };
  for (const Goal::Asked& one : facts.goal.asked) {
    if (one.of.size() < 2 || one.of[0] != Things{spared}) continue;
    for (const Goal::Asked& other : facts.goal.asked) {
      if (other.predicate == one.predicate && is_handled(other.of[0]) &&
          std::equal(one.of.begin() + 1, one.of.end(), other.of.begin() + 1, other.of.end()))
        return &one;
    }
  }
  return nullptr;
}

}  // namespace

Lack spared_lack(const ClauseFacts& facts, const Clause& clause) {
  if (clause.denied) return std::nullopt;
  for (const ObjectId spared : clause.spared) {
    const auto way = facts.goal.ways.find(spared);
    const bool is_way = way != facts.goal.ways.end() && !way->second.other &&
                        (clause.does == Does::kOpens    ? way->second.opens && !way->second.closes
                         : clause.does == Does::kCloses ? way->second.closes && !way->second.opens
                                                        : false);
    if (is_way)
      return "success is that " + facts.name(spared) + " has moved " +
             (clause.does == Does::kOpens ? "at least so far as well" : "at most so far as well");
    const auto one = clause.does == Does::kPuts && clause.where.size() == 1
                         ? facts.bearing(spared, *clause.where.begin())
                         : std::nullopt;
    if (one && one->near && one->asked && !one->apart)
      return "success wants " + facts.name(spared) + " to be there as well";
    if (const Goal::Asked* alike = asked_of_both(facts, clause, spared))
      return "success asks `" + facts.model.predicates[alike->predicate].name + "` of " +
             facts.name(spared) + " as well";
  }
  return std::nullopt;
}

Lack put_lack(const ClauseFacts& facts, const Clause& clause) {
  if (facts.goal.asks_of_all) return std::nullopt;
  if (auto why = between_lack(facts, clause)) return why;
  for (const Clause::What& what : clause.what) {
    std::vector<ObjectId> moved;
    for (const ObjectId id : what.of) {
      if (facts.task.is_object(id) && !clause.where.contains(id)) moved.push_back(id);
    }
    if (auto why = moved_lack(facts, moved, clause)) return why;
  }
  return std::nullopt;
}

}  // namespace probe::sema
