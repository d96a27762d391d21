// Who has which role in a task, as `show` and `diff` say it.
#pragma once

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// Adds source and target (null where there is none), distractors[]; of tasks that have them roles
// {name: object or objects[]} and placed[], what the layout placed by name.
void add_roles(const plan::Plan& plan, const plan::TaskRecord& task, Json& json);

}  // namespace probe::inspect
