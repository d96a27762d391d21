// P1202 of an instruction that speaks of another relation, of another part or of fewer things than
// its success. Each reports the first of it, and is true where there is one.
#pragma once

#include <map>
#include <set>

#include "compiler/check/shared.h"
#include "compiler/check/told.h"
#include "compiler/model/model.h"
#include "compiler/names/reporter.h"

namespace probe::sema {

// An instruction that says the opposite of what success is, or another relation alone.
bool says_other_relation(const Model& model, const Task& task, Told& told, Shared& shared,
                         Reporter& reporter);

// "open the middle drawer" of which success is that the top drawer is open.
bool says_other_part(const Model& model, const Task& task, Shared& shared, Reporter& reporter);

// "put A on the plate" of which success is that A and B lie on it: what is asked of two, of two
// things each, is said of both or of none.
bool leaves_one_out(const Model& model, const Task& task, Told& told, Reporter& reporter);

// "put A on the plate" of which success wants C to have moved as well.
bool moves_unsaid(const Model& model, const Task& task, Told& told, Reporter& reporter);

// Whether some predicate may be asked of two things, before a task says of which.
class AskedTwice {
 public:
  explicit AskedTwice(const Model& model) : model_(model) {}

  bool operator()(const Task& task);

 private:
  bool look(ExprRef ref, std::set<PredicateId>& called) const;

  const Model& model_;
  std::map<ExprRef, bool> known_;
};

}  // namespace probe::sema
