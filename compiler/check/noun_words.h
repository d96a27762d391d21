// P0402 of nouns that are written out: "open the drawer" where the scene has three.
#pragma once

#include "compiler/check/said.h"
#include "compiler/model/model.h"
#include "compiler/names/reporter.h"

namespace probe::sema {

// Whether a noun may be one of several: the scene has furniture, or names that end with one noun
// beside words that say "the".
bool has_nouns_of_several(const Model& model, const Task& task);

// Reports the first noun of the instruction that leaves open which part or object is meant; true
// where there is one.
bool leaves_noun_open(const Model& model, const Task& task, const Said& said, Reporter& reporter);

}  // namespace probe::sema
