// Of which things an expression of a goal speaks, for one task: what its roles, names and variables
// stand for.
#pragma once

#include <vector>

#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

using Given = std::vector<Things>;  // by variable of a predicate or metric

class GoalThings {
 public:
  GoalThings(const Model& model, const Task& task) : model_(model), task_(task) {}

  const ExprNode& at(ExprRef ref) const { return model_.exprs.nodes[ref]; }
  const Predicate& called(const ExprNode& call) const { return model_.predicates[call.predicate]; }

  // Of what an expression speaks, but for what is inside the predicates that it calls.
  Things things(ExprRef ref, const Given& given) const;
  // Of a set that names what is in it, and of parts; of all other bodies nothing is certain.
  Things things_in(SetRef ref, const Given& given) const;
  bool is_certain(SetRef ref) const;
  // What the predicate that is called is of.
  Given given_to(const ExprNode& call, const Given& given) const;

  static void bind(Given& given, std::uint32_t variable, Things to) {
    if (variable >= given.size()) given.resize(variable + 1);
    given[variable] = std::move(to);
  }

 protected:
  const Model& model_;
  const Task& task_;
};

}  // namespace probe::sema
