// Where a robot's joints begin an episode.
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// Of start number `index` of a task, in the order of the robot's drives, rad and m: the scene's, or
// what a file of starts says, each joint that turns moved by up to the layout's `joints jitter` and
// kept within its limits. Every draw has its own key, the number of the start and the joint's name.
// Empty where the layout says none.
std::vector<double> arm_start_of(const Model& model, const Task& task, std::size_t index);

}  // namespace probe::sema
