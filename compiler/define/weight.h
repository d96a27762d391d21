// What the weight of its parts does in a joint of a fixture.
#pragma once

#include "compiler/model/model.h"

namespace probe::sema {

// The most that weight moves a joint with, wherever all joints stand: N, or Nm where it turns. It
// counts all links that hang at the joint, and those that its followers move, by their ratio. The
// index is that of the model's joints. Infinite when a link slides without end.
double weight_on(const Fixture& fixture, int joint);

}  // namespace probe::sema
