// Skills of a plan: how a task can be solved, as its text says. They stand in no id: words about a
// solution change neither what is asked for nor how it is judged.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "runtime/plan/tables.h"

namespace probe::plan {

enum class SkillTakes : std::uint8_t { kObject, kObjectPlace, kPart, kPartAmount };

struct SkillInfo {
  Skill skill;
  std::string_view word;
  SkillTakes takes;
};
const SkillInfo& info_of(Skill skill);
// Null for a number that is none.
const SkillInfo* find_skill(std::uint32_t number);

// "on", "in", "beside"; "to", "by" of a turn; empty for kNothing.
std::string_view to_text(SkillRelation relation);

// The skills of a task, in the order in which they are done; none where its text says nothing.
// `tables` has passed the verifier.
std::span<const SkillRecord> skills_of(const Tables& tables, std::uint32_t task);

// "put carrot in cabinet.inside_top", "turn stove.left_knob to 90deg".
std::string skill_text(const Tables& tables, const SkillRecord& skill);

}  // namespace probe::plan
