// A plan as text for people: programs with body, constant and metric names, and source lines where
// the plan has them. Stable, so that tests of the compiler can compare it; nothing reads it back.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/plan/plan.h"

namespace probe::plan {

// Tables in short, then every program once, named by the tasks that use it.
std::string disassemble(const Plan& plan);
// The program of one task alone, with its own bodies' names. `task` is an index of plan.tasks().
std::string disassemble(const Plan& plan, std::uint32_t task);

}  // namespace probe::plan
