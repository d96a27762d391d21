// Whether what a task names fits together: its phrases, bodies, fixtures, cameras, joints and
// times. What does not is reported, and the task is poisoned: what follows from it is not said
// again.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// Every object that fills the role has the phrase.
void check_refer(Context& context, const Task& task, RoleId role, const Spelled& refer,
                 bool& poisoned);

// A record with a mistake of its own: what it does to the task is not said.
bool has_broken_part(const Model& model, const Task& task);

// Of a task that has all its statements. A delay that is a time becomes steps of its robot.
// A horizon that is a time in control steps of the task's robot, once it has one.
void count_horizon(Context& context, Task& task, bool& poisoned);

void check_fit(Context& context, Task& task, bool& poisoned);

}  // namespace probe::sema
