// What the expert is asked of in place of a point: the same things in the same places, seen by
// nobody.
#pragma once

#include <vector>

#include "compiler/model/model.h"
#include "runtime/search/points_file.h"

namespace probe::search {

// The points in their order, then those that prove others. PlannedPoint::proof of each is set:
// itself, where all that is changed moves things; one of those behind, NAME_placed, where other
// things are changed, too; kBase, where nothing is moved.
std::vector<PlannedPoint> with_proofs(const sema::Space& space, std::vector<space::Point> points);

}  // namespace probe::search
