#include "runtime/expert/wrong_skills.h"

#include <algorithm>

namespace probe::expert {
namespace {

// The next part in the view, round, whose joint moves the same way; -1 for none.
int other_part(const policy::Privileged& view, int part) {
  const auto count = static_cast<int>(view.fixtures.size());
  const auto& own = view.fixtures[static_cast<std::size_t>(part)].joint;
  for (int step = 1; step < count; ++step) {
    const int at = (part + step) % count;
    const auto& joint = view.fixtures[static_cast<std::size_t>(at)].joint;
    if (joint && own && joint->number != own->number && joint->slides == own->slides) return at;
  }
  return -1;
}

}  // namespace

std::vector<policy::Skill> wrong_skills(const policy::Privileged& view, int role) {
  std::vector<policy::Skill> skills = view.solution;
  const auto first =
      std::ranges::find_if(skills, [](const policy::Skill& skill) { return skill.object >= 0; });
  if (first != skills.end()) {
    const int right = first->object, wrong = view.object_of(role);
    if (wrong < 0) return {};
    for (policy::Skill& skill : skills) {
      if (skill.object == right) skill.object = wrong;
    }
    return skills;
  }
  bool is_other = false;
  for (policy::Skill& skill : skills) {
    const int part = other_part(view, skill.fixture);
    if (part < 0) continue;
    skill.fixture = part;
    is_other = true;
  }
  return is_other ? skills : std::vector<policy::Skill>();
}

}  // namespace probe::expert
