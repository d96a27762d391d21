// Stage 2, skills: that each can be done with what its task has.
#include <fmt/format.h>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/regions.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {

Status RecordCheck::check(const SkillRecord& s) const {
  PROBE_TRY(check_index(s.task, t.tasks.size(), "TASK"));
  if (s.region != kNone) PROBE_TRY(check_index(s.region, t.regions.size(), "REGN"));
  return check_magnitude(s.amount, Magnitude::kJointPosition);
}

namespace {

class SkillCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() const {
    std::uint32_t last = 0;
    for (const SkillRecord& skill : t.skills) {
      if (skill.task < last)
        return fail(
            Rule::kSkillOrder, &skill.task,
            fmt::format("a skill of task {} stands behind one of task {}", skill.task, last));
      last = skill.task;
      PROBE_TRY(one(skill));
    }
    return {};
  }

 private:
  Status one(const SkillRecord& skill) const {
    const SkillInfo* info = find_skill(skill.skill);
    if (info == nullptr)
      return fail(Rule::kSkillKind, &skill.skill,
                  fmt::format("skill {} is not known", skill.skill));
    PROBE_TRY(relation(skill, *info));
    const TaskRecord& task = t.tasks[skill.task];
    const std::uint32_t objects = roles_of(t, task).objects;
    if (skill.body >= task.bodies.count)
      return fail(Rule::kSkillBody, &skill.body,
                  fmt::format("task `{}` has no body {}", t.text(task.name), skill.body));
    const auto bodies = slice_of(t.bodies, task.bodies);
    const bool moves_object =
        info->takes == SkillTakes::kObject || info->takes == SkillTakes::kObjectPlace;
    if (moves_object ? skill.body >= objects : !moves(bodies[skill.body]))
      return fail(
          Rule::kSkillBody, &skill.body,
          fmt::format("`{}` is no {} of task `{}`", t.text(bodies[skill.body].name),
                      moves_object ? "object" : "part that a joint moves", t.text(task.name)));
    if (info->skill == Skill::kTurn && slides_of(bodies[skill.body]))
      return fail(Rule::kSkillBody, &skill.body,
                  fmt::format("`{}` slides and cannot be turned", t.text(bodies[skill.body].name)));
    if (info->takes != SkillTakes::kObjectPlace) return {};
    return place(skill, task);
  }

  Status relation(const SkillRecord& skill, const SkillInfo& info) const {
    const bool is_place = skill.relation >= static_cast<std::uint32_t>(SkillRelation::kOn) &&
                          skill.relation <= static_cast<std::uint32_t>(SkillRelation::kBeside);
    const bool is_amount = skill.relation == static_cast<std::uint32_t>(SkillRelation::kTo) ||
                           skill.relation == static_cast<std::uint32_t>(SkillRelation::kBy);
    const bool wants_place = info.takes == SkillTakes::kObjectPlace;
    const bool wants_amount = info.takes == SkillTakes::kPartAmount;
    const bool fits = wants_place ? is_place : wants_amount ? is_amount : skill.relation == 0;
    if (!fits)
      return fail(Rule::kSkillKind, &skill.relation,
                  fmt::format("relation {} is none of `{}`", skill.relation, info.word));
    if (!wants_amount && skill.amount != 0)
      return fail(Rule::kSkillKind, &skill.amount, fmt::format("`{}` has no amount", info.word));
    const bool has_one = (skill.to == kNone) != (skill.region == kNone);
    if (wants_place ? !has_one : skill.to != kNone || skill.region != kNone)
      return fail(Rule::kSkillKind, &skill.to,
                  fmt::format("`{}` goes to one body or region, or to none", info.word));
    return {};
  }

  Status place(const SkillRecord& skill, const TaskRecord& task) const {
    if (skill.to != kNone) {
      if (skill.to < task.bodies.count && skill.to != skill.body) return {};
      return fail(Rule::kSkillBody, &skill.to,
                  fmt::format("body {} of task `{}` cannot be put to body {}", skill.body,
                              t.text(task.name), skill.to));
    }
    const RegionRecord& region = t.regions[skill.region];
    if (has_region(t, task, region)) return {};
    return fail(Rule::kSkillRegion, &skill.region,
                fmt::format("region `{}` is of nothing in task `{}`", t.text(region.name),
                            t.text(task.name)));
  }

  const PartRecord* part_of(const BodyRecord& body) const {
    return body.kind == static_cast<std::uint32_t>(BodyKind::kPart) ? &t.parts[body.index]
                                                                    : nullptr;
  }
  bool moves(const BodyRecord& body) const {
    const PartRecord* part = part_of(body);
    return part != nullptr && part->joint != kNone;
  }
  bool slides_of(const BodyRecord& body) const {
    for (const FixtureRecord& fixture : t.fixtures) {
      const std::uint32_t first = fixture.parts.first;
      if (body.index < first || body.index >= first + fixture.parts.count) continue;
      return slides(slice_of(t.fixture_joints, fixture.joints)[t.parts[body.index].joint]);
    }
    return false;
  }
};

}  // namespace

Status verify_skills(std::span<const std::byte> bytes, const Tables& tables) {
  return SkillCheck(bytes, tables).run();
}

}  // namespace probe::plan
