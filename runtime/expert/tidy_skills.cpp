#include "runtime/expert/tidy_skills.h"

#include <algorithm>
#include <limits>

namespace probe::expert {
namespace {

using policy::Skill;

constexpr double kInnerBox = 0.7;  // of half an object's box: a square within a round plate
constexpr double kOverBox = 0.03;  // m over its box

// On or in one object, whichever of the two is said.
bool is_same_place(const Skill& a, const Skill& b) {
  const auto goes_there = [](const Skill& skill) {
    return skill.kind == Skill::Kind::kPut && skill.place != Skill::Place::kBeside &&
           skill.to_object >= 0;
  };
  return goes_there(a) && goes_there(b) && a.to_object == b.to_object && a.object != b.object;
}

// In the object's frame.
Skill::Box top_of(const policy::PrivilegedObject& object) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(kNone), high = -low;
  for (const std::vector<Vec3>& part : object.parts) {
    for (const Vec3& v : part) low = low.cwiseMin(v), high = high.cwiseMax(v);
  }
  const Vec3 middle = 0.5 * (low + high), half = 0.5 * kInnerBox * (high - low);
  return {{middle.x() - half.x(), middle.y() - half.y(), low.z()},
          {middle.x() + half.x(), middle.y() + half.y(), high.z() + kOverBox},
          {}};
}

}  // namespace

std::vector<Skill> tidied(const policy::Privileged& view, std::vector<Skill> skills) {
  std::vector<Skill> out;
  for (std::size_t i = 0; i < skills.size(); ++i) {
    Skill skill = skills[i];
    const bool is_held = i + 1 < skills.size() && skills[i + 1].kind == Skill::Kind::kPut &&
                         skills[i + 1].object == skill.object;
    if (skill.kind == Skill::Kind::kPick && is_held) continue;
    const auto shares = [&](const Skill& other) { return is_same_place(skill, other); };
    skill.shares = std::ranges::any_of(skills, shares) && !skill.region;
    if (skill.shares)
      skill.region = top_of(view.objects[static_cast<std::size_t>(skill.to_object)]);
    out.push_back(skill);
  }
  return out;
}

bool is_shared(const std::vector<Skill>& skills, std::size_t put) {
  for (std::size_t i = put + 1; i < skills.size(); ++i) {
    if (is_same_place(skills[put], skills[i])) return true;
  }
  return false;
}

}  // namespace probe::expert
