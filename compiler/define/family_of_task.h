// One family of questions and one task that it is asked of: what all look at who make a question of
// the two.
#pragma once

#include <optional>
#include <vector>

#include "compiler/define/ambiguities.h"
#include "compiler/define/in_start.h"
#include "compiler/define/scene_objects.h"

namespace probe::sema {

// Why nothing is asked; nothing where nothing is in the way.
using MayOmit = std::optional<plan::OmissionReason>;

// All outlive it.
struct FamilyOfTask {
  Context& context;
  Ambiguities& ambiguities;
  Relations& relations;
  const SceneObjects& scene;
  QuestionSetId set_id;
  std::uint32_t family_index;

  const Model& model() const { return context.model; }
  const QuestionSet& set() const { return model().question_sets[set_id]; }
  const Family& family() const { return set().families[family_index]; }
  const Task& task() const { return scene.task(); }
  const std::vector<ObjectId>& objects() const { return scene.all(); }

  // Begins what is said of it.
  std::string here() const {
    return "in `" + task().name + "`, question `" + family().name + "`: ";
  }
};

}  // namespace probe::sema
