// Which way the comparisons of a goal go: whether what they measure of two things is small or large
// when the goal holds, and how far joints have moved then.
#pragma once

#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

// Adds to `goal.bearings` and `goal.ways` what a metric says of the task.
void read_bearings(const Model& model, const Task& task, const Metric& metric, Goal& goal);

}  // namespace probe::sema
