// The objects of one task as questions speak of them: what they are called, which of them the
// instruction means, and which objects of the catalogue are certainly not there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// What all objects are called, with case folded.
class ObjectNames {
 public:
  explicit ObjectNames(const Model& model);

  const std::string& name(ObjectId id) const { return names_[static_cast<std::size_t>(id)]; }
  const std::string& phrase(ObjectId id, std::size_t index) const {
    return phrases_[static_cast<std::size_t>(id)][index];
  }
  // Whether the words for one could be taken for the other.
  bool are_alike(ObjectId a, ObjectId b) const;

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> phrases_;
};

// Of a complete task. Model and names outlive it.
class SceneObjects {
 public:
  SceneObjects(const Model& model, const ObjectNames& names, TaskId task);

  const Task& task() const { return task_; }
  TaskId task_id() const { return task_id_; }
  const ObjectNames& names() const { return names_; }
  const std::string& name(ObjectId id) const { return names_.name(id); }

  // Source, target, distractors.
  const std::vector<ObjectId>& all() const { return objects_; }
  // Its place among them; nothing when it is not in the scene.
  std::optional<std::uint32_t> body_of(ObjectId id) const;

  // The object that fills a role, of a set the first; kNone where nothing does.
  ObjectId filled_by(RoleId role) const {
    const std::vector<ObjectId> objects = task_.objects_in(role);
    return objects.empty() ? ObjectId::kNone : objects.front();
  }

  // What the instruction says to leave alone, each once.
  const std::vector<ObjectId>& avoided() const { return avoided_; }
  bool is_avoided(ObjectId id) const;
  // Whether the instruction speaks of it otherwise than to warn of it: by a slot; or by its name.
  bool is_slot(ObjectId id) const;
  bool is_told(ObjectId id) const;
  // The phrase that the task's words use for an object, if they do.
  const Phrase* phrase_for(ObjectId id) const;

  // Whether an object of the catalogue is certainly not in the scene, whatever it is called and
  // shown as: no name there is like its own, nothing there looks like it, and no words of the
  // instruction could mean it.
  bool is_absent(ObjectId id) const { return absent_[static_cast<std::size_t>(id)]; }

 private:
  std::optional<ObjectId> object_of(const SlotRef& slot) const;
  bool find_absent(ObjectId id, const std::string& fixture) const;

  const Model& model_;
  const ObjectNames& names_;
  TaskId task_id_;
  const Task& task_;
  std::vector<ObjectId> objects_, avoided_;
  std::string prompt_;  // folded
  std::vector<bool> absent_;
};

}  // namespace probe::sema
