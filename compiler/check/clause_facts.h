// How a task's success measures what the clauses of its instruction speak of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/check/clauses.h"
#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

using Does = Clause::Does;

bool shares(const Things& a, const Things& b);

// What of a clause is handled: not the place it goes to.
std::vector<ObjectId> handled(const Clause& clause, const Clause::What& what);

// In: all of one complete task, which live as long.
struct ClauseFacts {
  const Model& model;
  const Task& task;
  const Clauses& clauses;
  const Goal& goal;
  bool is_alone = true;  // the only sentence: none before it has done or said something

  std::string name(ObjectId id) const { return "`" + model.objects[id].name + "`"; }
  const std::optional<OfFixture>& of(ObjectId id) const { return model.objects[id].of; }
  bool is_spoken(ObjectId id) const { return goal.spoken.contains(id); }
  // Whether a region or a part stands for the other, or for the fixture that both are of. Two parts
  // that move by themselves are two places.
  bool is_same_place(ObjectId a, ObjectId b) const;
  // How success measures a thing against a place, of all its comparisons of the two.
  std::optional<Goal::Bearing> bearing(ObjectId thing, ObjectId place) const;
  // Where success wants a thing to be: near to another, or somewhere in a region, by whatever
  // coordinates.
  Things wanted_at(ObjectId thing) const;
  // Other objects that success measures it against.
  Things measured_against(ObjectId thing) const;
  // "asks `on_top_of` of `cube` and `plate`", by the predicate that is of the fewest things.
  std::string asks(ObjectId thing, ObjectId place) const;
  // The one object that success wants above another and near it; none where it is not one.
  std::optional<ObjectId> lies_upon(ObjectId thing) const;
  // Whether one begins on or in the other, seen from above: then it may be said for it.
  bool lies_on(ObjectId a, ObjectId b) const;
  // Whether a later clause may do something with it.
  bool is_moved_later(const Clause& clause, ObjectId thing) const;
  // The parts of a clause that opens or closes.
  Things parts_of(const Clause::What& what) const;
  Things parts_of(const Clause& clause) const;
};

}  // namespace probe::sema
