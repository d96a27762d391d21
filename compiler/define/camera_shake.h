// Where cameras stand in a start: `jitter 3cm 5deg`.
#pragma once

#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// Of each view in their order plan::kShakeReals numbers for the start: how far its camera is moved
// in its mount's frame (m), and the turn about its own ahead, left and up (w, x, y, z). Empty where
// none jitters. Drawn for the start's number and the view's name: a camera that jitters more stands
// farther the same way, and no other task, object or camera shifts it.
std::vector<double> shakes_of(const Model& model, const std::vector<View>& views,
                              std::size_t start);

// The camera of that view as it stands there.
Camera shaken(const Camera& camera, const std::vector<double>& shakes, std::size_t view);

}  // namespace probe::sema
