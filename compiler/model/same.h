// Whether two expressions measure the same, wherever and under whichever names they are written.
#pragma once

#include "compiler/model/model.h"

namespace probe::sema {

// Node by node, through the predicates that are called; quantities by their value. Expressions that
// are equal only by calculation are not found so: `a < b` and `b > a` are, `2 * a` and `a + a` are
// not.
bool same_expression(const Model& model, ExprRef a, ExprRef b);

}  // namespace probe::sema
