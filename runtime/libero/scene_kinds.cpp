#include "runtime/libero/scene_kinds.h"

#include <algorithm>
#include <iterator>

namespace probe::libero {
namespace {

constexpr SceneKind kScenes[] = {
#define LIBERO_SCENE(problem, scene, robot, x, y, z, surface, regions) \
  {#problem, #scene, #robot, x, y, z, surface, regions},
#include "runtime/libero/scenes.def"
};

}  // namespace

const SceneKind* scene_kind(const BddlProblem& problem) {
  const auto row = std::ranges::find(kScenes, problem.problem_class, &SceneKind::problem_class);
  return row == std::end(kScenes) ? nullptr : row;
}

}  // namespace probe::libero
