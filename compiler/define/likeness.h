// Whether two objects look so much the same that no words about looks tell them apart: copies, bare
// or in one paint.
#pragma once

#include "compiler/model/model.h"

namespace probe::sema {

// One mesh in one size: both in one texture, one of them or both in paint and of one colour, or
// both bare where no attribute says that they differ. Or two meshes, one of them in paint, of one
// size, of which every attribute says the same. Not of parts and regions of fixtures.
bool look_alike(const Model& model, ObjectId a, ObjectId b);

}  // namespace probe::sema
