// P0608, of a plan that was made: what ends an episode of a task before success can be true, found
// by the judge in made-up worlds.
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/model/model.h"
#include "runtime/base/result.h"

namespace probe::emit {

// Whether some task has an `ends when` that may hold without its success, so that the plan has to
// be asked.
bool may_end_early(const sema::Model& model);

// `plan`: the bytes of a plan of the model's tasks, or of some of them.
Status note_early_ends(const sema::Model& model, const std::vector<std::byte>& plan,
                       Diagnostics& diagnostics);

}  // namespace probe::emit
