#include "compiler/check/clause_facts.h"

#include <algorithm>
#include <cmath>

namespace probe::sema {
namespace {

// A drawer, a door: a place of its own, whatever regions it has.
bool is_own_place(const Model& model, ObjectId id) {
  const OfFixture& of = *model.objects[id].of;
  const Fixture::Part& part = model.fixtures[of.fixture].parts[of.part];
  return part.declared && part.joint;
}

const Start::Placed* placed(const Task& task, ObjectId id) {
  const auto& all = task.starts.front().placed;
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const Start::Placed& one) { return one.object == id; });
  return at == all.end() ? nullptr : &*at;
}

}  // namespace

std::vector<ObjectId> handled(const Clause& clause, const Clause::What& what) {
  std::vector<ObjectId> found;
  for (const ObjectId id : what.of) {
    if (!clause.where.contains(id)) found.push_back(id);
  }
  return found;
}

bool shares(const Things& a, const Things& b) {
  return std::any_of(a.begin(), a.end(), [&](ObjectId id) { return b.contains(id); });
}

bool ClauseFacts::is_same_place(ObjectId a, ObjectId b) const {
  if (a == b) return true;
  if (!of(a) || !of(b) || of(a)->fixture != of(b)->fixture) return false;
  if (of(a)->part == of(b)->part || !is_own_place(model, a) || !is_own_place(model, b)) return true;
  // The bottom of a drawer goes with it.
  const auto& parts = model.fixtures[of(a)->fixture].parts;
  return parts[of(a)->part].joint == parts[of(b)->part].joint;
}

std::optional<Goal::Bearing> ClauseFacts::bearing(ObjectId thing, ObjectId place) const {
  std::optional<Goal::Bearing> found;
  for (const auto& [two, one] : goal.bearings) {
    if (two.first != thing && two.second != thing) continue;
    const ObjectId other = two.first == thing ? two.second : two.first;
    if (!is_same_place(other, place)) continue;
    if (!found) found.emplace();
    found->add(one);
  }
  return found;
}

Things ClauseFacts::wanted_at(ObjectId thing) const {
  Things found;
  for (const auto& [two, one] : goal.bearings) {
    if (!one.asked || (two.first != thing && two.second != thing)) continue;
    const ObjectId other = two.first == thing ? two.second : two.first;
    if (one.near || (one.other && of(other) && of(other)->region)) found.insert(other);
  }
  return found;
}

Things ClauseFacts::measured_against(ObjectId thing) const {
  Things found = wanted_at(thing);
  for (const auto& [two, one] : goal.bearings) {
    if (!one.asked || (two.first != thing && two.second != thing)) continue;
    const ObjectId other = two.first == thing ? two.second : two.first;
    if (task.is_object(other)) found.insert(other);
  }
  return found;
}

std::string ClauseFacts::asks(ObjectId thing, ObjectId place) const {
  const Goal::Asked* least = nullptr;
  for (const Goal::Asked& asked : goal.asked) {
    const auto has = [&](ObjectId id) {
      return std::any_of(asked.of.begin(), asked.of.end(),
                         [&](const Things& things) { return things.contains(id); });
    };
    // Of as many the last one declared, which speaks of the others.
    if (has(thing) && has(place) && (least == nullptr || asked.of.size() <= least->of.size()))
      least = &asked;
  }
  const std::string both = " of " + name(thing) + " and " + name(place);
  if (least == nullptr) return "measures " + name(thing) + " against " + name(place);
  return "asks `" + model.predicates[least->predicate].name + "`" + both;
}

std::optional<ObjectId> ClauseFacts::lies_upon(ObjectId thing) const {
  std::optional<ObjectId> found;
  for (const auto& [high, low] : goal.above) {
    if (high != thing || !task.is_object(low)) continue;
    const auto one = bearing(thing, low);
    if (!one || !one->near || !one->asked || one->apart) continue;
    if (found) return std::nullopt;
    found = low;
  }
  return found;
}

bool ClauseFacts::lies_on(ObjectId a, ObjectId b) const {
  if (task.starts.empty()) return true;
  if (!task.is_object(a) && !task.is_object(b)) return false;
  if (!task.is_object(a) || !task.is_object(b)) {
    // What is put into a fixture has a height of its own; in a table of starts all may have.
    if (!model.layouts[task.layout].given.empty()) return false;
    const ObjectId object = task.is_object(a) ? a : b;
    const auto at = placed(task, object);
    return at == nullptr || at->z.has_value();
  }
  const auto one = placed(task, a), other = placed(task, b);
  if (one == nullptr || other == nullptr) return true;
  const auto half = [&](ObjectId id) {
    const Object& object = model.objects[id];
    return std::hypot(object.box_max[0] - object.box_min[0],
                      object.box_max[1] - object.box_min[1]) /
           2;
  };
  return std::hypot(one->x - other->x, one->y - other->y) < std::max(half(a), half(b));
}

bool ClauseFacts::is_moved_later(const Clause& clause, ObjectId thing) const {
  if (!clauses.is_whole) return true;
  const Clause* end = clauses.all.data() + clauses.all.size();
  return std::any_of(&clause + 1, end, [&](const Clause& later) {
    return !later.certain || later.what.empty() ||
           std::any_of(later.what.begin(), later.what.end(),
                       [&](const Clause::What& what) { return what.of.contains(thing); });
  });
}

Things ClauseFacts::parts_of(const Clause::What& what) const {
  Things parts;
  for (const ObjectId id : what.of) {
    if (of(id) && of(id)->is_part()) parts.insert(id);
  }
  return parts;
}

Things ClauseFacts::parts_of(const Clause& clause) const {
  Things parts;
  for (const Clause::What& what : clause.what) parts.merge(parts_of(what));
  return parts;
}

}  // namespace probe::sema
