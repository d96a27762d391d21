#include "runtime/expert/wrong_skills.h"

#include <algorithm>
#include <optional>

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

// A part among the task's distractors for a right one (-1: for none), at best one that moves alike;
// -1 where none moves.
int wrong_part(const policy::Privileged& view, int right) {
  const auto joint = [&](int at) -> const std::optional<policy::PrivilegedFixture::Joint>& {
    return view.fixtures[static_cast<std::size_t>(at)].joint;
  };
  int found = -1;
  for (const int wrong : view.wrong_fixtures) {
    if (wrong == right || !joint(wrong)) continue;
    const bool has_right = right >= 0 && joint(right).has_value();
    if (has_right && joint(wrong)->number == joint(right)->number) continue;
    if (!has_right || joint(wrong)->slides == joint(right)->slides) return wrong;
    if (found < 0) found = wrong;
  }
  return found;
}

// The solution about parts that are wrong.
std::vector<policy::Skill> with_wrong_parts(const policy::Privileged& view) {
  std::vector<policy::Skill> skills = view.solution;
  bool is_other = false;
  for (policy::Skill& skill : skills) {
    for (int* part : {&skill.fixture, &skill.to_fixture}) {
      if (*part < 0 || !view.fixtures[static_cast<std::size_t>(*part)].joint) continue;
      const int wrong = wrong_part(view, *part);
      if (wrong < 0) continue;
      *part = wrong;
      is_other = true;
    }
  }
  if (is_other) return skills;
  const int wrong = wrong_part(view, -1);
  if (wrong < 0) return {};
  policy::Skill open;
  open.kind = policy::Skill::Kind::kOpen;
  open.fixture = wrong;
  return {open};
}

}  // namespace

std::vector<policy::Skill> wrong_skills(const policy::Privileged& view, int role) {
  std::vector<policy::Skill> skills = view.solution;
  const auto first =
      std::ranges::find_if(skills, [](const policy::Skill& skill) { return skill.object >= 0; });
  // Without a solution the errand itself says what is put where.
  const bool has_wrong_object =
      (first != skills.end() || skills.empty()) && view.object_of(role) >= 0;
  if (!has_wrong_object && !view.wrong_fixtures.empty()) return with_wrong_parts(view);
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
