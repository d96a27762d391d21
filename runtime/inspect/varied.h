// What varies in a task without a new mesh, in words: sizes, paints and textures of its objects,
// the colour of its light, sensors, textures behind it, late actions, an arm that begins elsewhere.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/plan/plan.h"

namespace probe::inspect {

// "carrot scaled by 1.2", "actions late by 2 steps", ... Empty where all is as its meshes, cameras
// and scene are.
std::vector<std::string> varied_in(const plan::Plan& plan, const plan::TaskRecord& task);

}  // namespace probe::inspect
