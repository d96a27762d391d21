// In which starts of a task words that say where things are do not mean one object alone. Tasks
// that share their starts and see the same things in the same roles from one camera share the
// answer.
#pragma once

#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/define/in_start.h"

namespace probe::sema {

// Start numbers: the phrase does not denote the object that is meant, or another one too, or it
// cannot be told.
struct Unclear {
  std::vector<std::size_t> unfit, ambiguous, unknown;
  std::size_t count() const { return unfit.size() + ambiguous.size() + unknown.size(); }
};

class UnclearStarts {
 public:
  // Both outlive it, and starts stay where they are.
  UnclearStarts(const Model& model, Relations& relations) : model_(model), relations_(relations) {}

  const Unclear& find(const Task& task, const Phrase& phrase, ObjectId wanted);

 private:
  // Starts and how many, scene, camera, phrase and object; who has which role; where joints begin.
  using Key = std::tuple<const Start*, std::size_t, SceneId, CameraId, const Phrase*, ObjectId,
                         std::vector<std::pair<RoleId, ObjectId>>, std::vector<double>>;

  const Model& model_;
  Relations& relations_;
  std::map<Key, Unclear> known_;
};

}  // namespace probe::sema
