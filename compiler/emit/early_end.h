// P0608: an `ends when` that ends an episode before its success can be true, which the judge finds
// in made-up worlds once the plan is there.
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/model/model.h"
#include "runtime/base/result.h"

namespace probe::emit {

// Whether some task has an `ends when` that may hold without its success: only then is there
// anything to ask the judge.
bool may_end_early(const sema::Model& model);

// `plan`: the bytes of a plan of the model's tasks, or of some of them. One warning a place, with
// the number of other tasks of which the same holds. Fails where the plan is not read.
Status note_early_ends(const sema::Model& model, const std::vector<std::byte>& plan,
                       Diagnostics& diagnostics);

}  // namespace probe::emit
