// The benchmark's kinds of scene: scenes.def as a table.
#pragma once

#include <string_view>

#include "runtime/libero/bddl.h"

namespace probe::libero {

struct SceneKind {
  std::string_view problem_class, scene, robot;
  double x, y, z;  // m, the workspace's offset
  double surface;  // m, its height
  double regions;  // m, of the sites of its regions above its surface
};

// Of a problem's class; none: it is not known.
const SceneKind* scene_kind(const BddlProblem& problem);

}  // namespace probe::libero
