// The words of an instruction that say where things are, as claims that can be judged of any state:
// the same relations, objects and rivals of which `InStart` proves them in every start.
#pragma once

#include <vector>

#include "compiler/lower/lower.h"
#include "compiler/model/model.h"

namespace probe::sema {

struct Claim {
  const Phrase* phrase = nullptr;
  ObjectId object = ObjectId::kNone;        // that the phrase means
  std::uint16_t body = 0;                   // which it is
  std::vector<lower::ClaimedBody> claimed;  // it, and those that the phrase may denote as well
};

// One for each object that the task's instruction calls by a phrase of places, in the order in
// which it speaks of them. `task` is complete, and its phrases are clear in every start.
std::vector<Claim> claims_of(const Model& model, const Task& task);

}  // namespace probe::sema
