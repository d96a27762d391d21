#include "compiler/define/scene_objects.h"

#include <algorithm>

#include "compiler/define/likeness.h"
#include "compiler/define/query.h"
#include "compiler/define/telling.h"
#include "compiler/define/template.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {

ObjectNames::ObjectNames(const Model& model) {
  for (const Object& object : model.objects) {
    names_.push_back(fold_case(object.text.text));
    std::vector<std::string>& phrases = phrases_.emplace_back();
    for (const Phrase& phrase : object.phrases) phrases.push_back(fold_case(phrase.text.text));
  }
}

bool ObjectNames::are_alike(ObjectId a, ObjectId b) const {
  return is_part_of_name(name(a), name(b)) || is_part_of_name(name(b), name(a));
}

SceneObjects::SceneObjects(const Model& model, const ObjectNames& names, TaskId task)
    : model_(model),
      names_(names),
      task_id_(task),
      task_(model.tasks[task]),
      objects_(task_.objects()),
      prompt_(fold_case(whole_prompt(task_))) {
  for_each_telling(task_, [&](const Task& told) {
    for (const Template::Part& part : model_.templates[told.say].parts) {
      if (!part.slot || !part.slot->avoid) continue;
      const std::optional<ObjectId> id = object_of(*part.slot);
      if (id && !is_avoided(*id)) avoided_.push_back(*id);
    }
  });
  // A folder of assets is all the name that a fixture has.
  const auto& fixture = model_.scenes[task_.scene].fixture;
  std::string folder = fixture ? fold_case(fixture->text) : "";
  std::replace(folder.begin(), folder.end(), '_', ' ');
  for (std::size_t i = 0; i < model_.objects.size(); ++i)
    absent_.push_back(find_absent(model_.objects.id(i), folder));
}

std::optional<ObjectId> SceneObjects::object_of(const SlotRef& slot) const {
  if (slot.role != RoleId::kNone) {
    const std::vector<ObjectId> filled = task_.objects_in(slot.role);
    return filled.size() == 1 ? std::optional(filled.front()) : std::nullopt;
  }
  for (const ObjectId id : objects_) {
    if (model_.objects[id].name == slot.name.text) return id;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> SceneObjects::body_of(ObjectId id) const {
  const auto at = std::find(objects_.begin(), objects_.end(), id);
  if (at == objects_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(at - objects_.begin());
}

bool SceneObjects::is_avoided(ObjectId id) const {
  return std::find(avoided_.begin(), avoided_.end(), id) != avoided_.end();
}

bool SceneObjects::is_slot(ObjectId id) const {
  bool is_meant = false;
  for_each_telling(task_, [&](const Task& told) {
    const Template& say = model_.templates[told.say];
    is_meant = is_meant || std::any_of(say.parts.begin(), say.parts.end(),
                                       [&](const Template::Part& part) {
                                         if (!part.slot || part.slot->avoid) return false;
                                         const auto meant = meant_by(model_, told, say, *part.slot);
                                         return std::ranges::find(meant, id) != meant.end();
                                       });
  });
  return is_meant;
}

bool SceneObjects::is_told(ObjectId id) const {
  return is_slot(id) || (has_words(prompt_, name(id)) && !is_avoided(id));
}

const Phrase* SceneObjects::phrase_for(ObjectId id) const {
  return task_.role_of(id) == RoleId::kNone ? nullptr : referring(model_, task_, id).phrase;
}

bool SceneObjects::find_absent(ObjectId id, const std::string& fixture) const {
  const Object& object = model_.objects[id];
  if (object.of || object.broken || is_blank(object.text.text) || body_of(id)) return false;
  for (const ObjectId other : objects_) {
    if (names_.are_alike(id, other) || model_.objects[other].mesh.text == object.mesh.text ||
        look_alike(model_, id, other))
      return false;
  }
  for (const ObjectId said : objects_) {
    const Phrase* phrase = phrase_for(said);
    if (phrase != nullptr && evaluate(phrase->means, object) != Truth::kNo) return false;
  }
  return !has_words(prompt_, name(id)) && !is_part_of_name(name(id), fixture);
}

}  // namespace probe::sema
