#include "runtime/plan/skills.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace probe::plan {
namespace {

constexpr SkillInfo kSkills[] = {
#define PROBE_SKILL(number, name, word, takes) {Skill::k##name, #word, SkillTakes::takes},
#include "runtime/plan/skills.def"
};

// Without the last bits of radians.
std::string degrees_text(double rad) {
  return fmt::format("{:.6g}deg", rad * 180 / std::numbers::pi);
}

}  // namespace

const SkillInfo& info_of(Skill skill) { return *find_skill(static_cast<std::uint32_t>(skill)); }

const SkillInfo* find_skill(std::uint32_t number) {
  for (const SkillInfo& info : kSkills) {
    if (static_cast<std::uint32_t>(info.skill) == number) return &info;
  }
  return nullptr;
}

std::string_view to_text(SkillRelation relation) {
  switch (relation) {
    case SkillRelation::kNothing:
      return "";
    case SkillRelation::kOn:
      return "on";
    case SkillRelation::kIn:
      return "in";
    case SkillRelation::kBeside:
      return "beside";
    case SkillRelation::kTo:
      return "to";
    case SkillRelation::kBy:
      return "by";
  }
  return "";
}

std::span<const SkillRecord> skills_of(const Tables& tables, std::uint32_t task) {
  const auto is_before = [](const SkillRecord& skill, std::uint32_t of) { return skill.task < of; };
  const auto begin = std::lower_bound(tables.skills.begin(), tables.skills.end(), task, is_before);
  const auto end = std::lower_bound(begin, tables.skills.end(), task + 1, is_before);
  return {begin, end};
}

std::string skill_text(const Tables& tables, const SkillRecord& skill) {
  const TaskRecord& task = tables.tasks[skill.task];
  const auto name_of = [&](std::uint32_t body) {
    return tables.text(slice_of(tables.bodies, task.bodies)[body].name);
  };
  std::string text(find_skill(skill.skill)->word);
  text.append(" ").append(name_of(skill.body));
  const auto relation = static_cast<SkillRelation>(skill.relation);
  if (relation == SkillRelation::kNothing) return text;
  text.append(" ").append(to_text(relation)).append(" ");
  if (skill.region != kNone) return text.append(tables.text(tables.regions[skill.region].name));
  if (skill.to != kNone) return text.append(name_of(skill.to));
  return text + degrees_text(skill.amount);
}

}  // namespace probe::plan
