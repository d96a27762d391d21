// What of the instructions of tasks is held to nothing, for an audit: where P1202 is silent of other
// words, success is what they say as far as the compiler knows.
#pragma once

#include <string>
#include <vector>

#include "compiler/check/called.h"
#include "compiler/check/clause_goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

// In: a complete task. Of several sentences each.
std::vector<NotHeld> not_held(const Model& model, const Task& task, Callings& callings);

}  // namespace probe::sema
