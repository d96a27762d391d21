// What a goal asks of whom, and in which order it can be done: from its facts and what holds first
// alone.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/libero/bddl.h"

namespace probe::libero {

// Who fills a role, as facts call them; empty where nobody does. A place is an object, or a region
// of one or of a fixture.
struct GoalRoles {
  std::string source, target;  // what is put, where; of a goal about one joint its region or
                               // fixture
  std::string helper,
      helper_target;  // of a second thing that is put; no place where both go to one
  std::vector<std::string> distractors;  // the other objects, in the order of the problem

  bool empty() const { return source.empty() && target.empty(); }
};

// Of a goal that puts one thing, or two that do not carry one another, or moves one joint; empty of
// others. A part of the table or the floor fills no role.
GoalRoles roles_of(const BddlProblem& problem);

// The facts of the goal that do not hold first, in an order in which they can be made so: what
// carries is put before what it carries, what something is put into is opened before if a joint
// closes it (`is_closable`, of a region) and nothing says that it is open, and closed at the end.
std::vector<BddlFact> steps_of(const BddlProblem& problem,
                               const std::function<bool(const BddlRegion&)>& is_closable);

// The skill that makes such a fact so, with names as a text has them: "put source in target".
std::string skill_text(const BddlFact& fact, const std::vector<std::string>& arguments);

}  // namespace probe::libero
