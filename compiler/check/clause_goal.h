// The clauses of an instruction, held to what success is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/check/clauses.h"
#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

// What success surely lacks of what some clause asks for, or wants the other way round: "says \"put
// the cube on the towel\" and success asks `on_top_of` of `cube` and `plate`". Nothing where all of
// it is there, or it is not certain what is meant.
// `is_alone`: no other sentence of the task comes before it.
std::optional<std::string> clause_lack(const Model& model, const Task& task, const Clauses& clauses,
                                       const Goal& goal, bool is_alone);

// Words of an instruction that are held to nothing: they were not understood, or success measures
// nothing that they ask for. Of all other words clause_lack() knows that they fit, or says that
// they do not.
struct NotHeld {
  std::string words, why;
};
std::vector<NotHeld> words_not_held(const Model& model, const Task& task, const Clauses& clauses,
                                    const Goal& goal);

}  // namespace probe::sema
