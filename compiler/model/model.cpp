// What the tables of the model say of themselves. Which words and checks fill them is define's.
#include "compiler/model/model.h"

#include <algorithm>
#include <numeric>

namespace probe::sema {

bool Phrase::is_spatial() const {
  return std::any_of(means.begin(), means.end(),
                     [](const QueryOp& op) { return op.kind == QueryOp::kRelation; });
}

std::array<double, 3> Region::middle() const {
  if (turned) return turned->middle;
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

std::array<double, 3> Region::half() const {
  if (turned) return turned->half;
  return {(high[0] - low[0]) / 2, (high[1] - low[1]) / 2, (high[2] - low[2]) / 2};
}

const Phrase* Object::find_phrase(std::string_view phrase) const {
  for (const Phrase& known : phrases) {
    if (known.name == phrase) return &known;
  }
  return nullptr;
}

bool Camera::has_sensor() const { return !(sensor == plan::SensorRecord{}); }

bool Camera::operator==(const Camera& other) const {
  return mount_link.text == other.mount_link.text && aim == other.aim &&
         position == other.position && aim_values == other.aim_values && width == other.width &&
         height == other.height && samples == other.samples && fx == other.fx && fy == other.fy &&
         cx == other.cx && cy == other.cy && jitter_place == other.jitter_place &&
         jitter_turn == other.jitter_turn;
}

bool Light::operator==(const Light& other) const {
  if (ambient != other.ambient || occlusion != other.occlusion || color != other.color ||
      suns.size() != other.suns.size() || lights_vertices != other.lights_vertices ||
      lamps != other.lamps)
    return false;
  for (std::size_t i = 0; i < suns.size(); ++i) {
    if (suns[i].direction != other.suns[i].direction || suns[i].power != other.suns[i].power ||
        suns[i].shadow != other.suns[i].shadow) {
      return false;
    }
  }
  return true;
}

std::vector<ObjectId> Task::objects() const {
  std::vector<ObjectId> all;
  std::size_t most = 2 + distractors.size() + placed.size();
  for (const Filled& role : others) most += role.objects.size();
  all.reserve(most);
  for (const ObjectId id : {source, target}) {
    if (id != ObjectId::kNone && is_object(id)) all.push_back(id);
  }
  for (const Filled& role : others) {
    for (const ObjectId id : role.objects) {
      if (is_object(id)) all.push_back(id);
    }
  }
  all.insert(all.end(), distractors.begin(), distractors.end());
  all.insert(all.end(), placed.begin(), placed.end());
  return all;
}

std::vector<std::pair<RoleId, ObjectId>> Task::things() const {
  std::vector<std::pair<RoleId, ObjectId>> all;
  const auto add = [&](RoleId role, ObjectId id) {
    if (id != ObjectId::kNone && !is_object(id)) all.emplace_back(role, id);
  };
  add(RoleId::kSource, source);
  add(RoleId::kTarget, target);
  for (const Filled& filled : others) {
    for (const ObjectId id : filled.objects) add(filled.role, id);
  }
  return all;
}

std::vector<ObjectId> Task::objects_in(RoleId role) const {
  if (role == RoleId::kSource || role == RoleId::kTarget) {
    const ObjectId id = role == RoleId::kSource ? source : target;
    return id == ObjectId::kNone ? std::vector<ObjectId>() : std::vector<ObjectId>{id};
  }
  for (const Filled& filled : others) {
    if (filled.role == role) return filled.objects;
  }
  return {};
}

RoleId Task::role_of(ObjectId object) const {
  if (object == ObjectId::kNone) return RoleId::kNone;
  if (object == source) return RoleId::kSource;
  if (object == target) return RoleId::kTarget;
  for (const Filled& filled : others) {
    if (std::find(filled.objects.begin(), filled.objects.end(), object) != filled.objects.end())
      return filled.role;
  }
  return RoleId::kNone;
}

std::vector<std::uint32_t> Suite::starts_of(TaskId member, const Task& task) const {
  const auto some = drawn.find(member);
  if (some != drawn.end()) return some->second;
  std::vector<std::uint32_t> all(task.starts.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace probe::sema
