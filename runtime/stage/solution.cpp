#include "runtime/stage/solution.h"

#include <fmt/format.h>

#include "runtime/plan/regions.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"

namespace probe::stage {
namespace {

using Kind = policy::Skill::Kind;

Kind kind_of(plan::Skill skill) {
  switch (skill) {
    case plan::Skill::kPick:
      return Kind::kPick;
    case plan::Skill::kPut:
      return Kind::kPut;
    case plan::Skill::kOpen:
      return Kind::kOpen;
    case plan::Skill::kClose:
      return Kind::kClose;
    case plan::Skill::kTurn:
      return Kind::kTurn;
    case plan::Skill::kPress:
      return Kind::kPress;
    case plan::Skill::kPush:
      return Kind::kPush;
  }
  return Kind::kPick;
}

policy::Skill::Place place_of(std::uint32_t relation) {
  using Place = policy::Skill::Place;
  switch (static_cast<plan::SkillRelation>(relation)) {
    case plan::SkillRelation::kIn:
      return Place::kIn;
    case plan::SkillRelation::kBeside:
      return Place::kBeside;
    case plan::SkillRelation::kNothing:
    case plan::SkillRelation::kOn:
    case plan::SkillRelation::kTo:
    case plan::SkillRelation::kBy:
      break;
  }
  return Place::kOn;
}

// Where a body of the task stands in the privileged view: make_privileged()'s order.
struct Seen {
  int object = -1, fixture = -1;
};
Seen seen_of(std::uint32_t body, const TaskBodies& bodies) {
  if (body < bodies.objects) return {static_cast<int>(body), -1};
  const bool stands = bodies.fixture != TaskBodies::kNone;
  if (stands && body == bodies.fixture) return {-1, 0};
  const std::size_t first = bodies.first_link + bodies.robot_links;
  if (body < first) return {};
  return {-1, static_cast<int>(body - first) + (stands ? 1 : 0)};
}

Vec3 vec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

std::vector<policy::Skill> solution_of(const plan::Plan& plan,
                                       std::span<const plan::SkillRecord> skills,
                                       const TaskBodies& bodies) {
  std::vector<policy::Skill> solution;
  for (std::size_t number = 1; const plan::SkillRecord& record : skills) {
    const plan::TaskRecord& task = plan.tasks()[record.task];
    policy::Skill skill;
    skill.name = fmt::format("{}{} `{}`", policy::kSkillCannot, number++,
                             plan::skill_text(plan.tables(), record));
    skill.kind = kind_of(static_cast<plan::Skill>(record.skill));
    const Seen what = seen_of(record.body, bodies);
    skill.object = what.object;
    skill.fixture = what.fixture;
    skill.amount = record.amount;
    skill.by = record.relation == static_cast<std::uint32_t>(plan::SkillRelation::kBy);
    if (skill.kind == Kind::kPut) {
      skill.place = place_of(record.relation);
      Seen to;
      if (record.region == plan::kNone) {
        to = seen_of(record.to, bodies);
      } else {
        const plan::RegionRecord& region = plan.regions()[record.region];
        const plan::SceneRecord& scene = plan.scenes()[task.scene];
        Vec3 origin = Vec3::Zero();  // what stands has the world's frame in the view
        if (region.kind == static_cast<std::uint32_t>(plan::BodyKind::kSurface))
          origin.z() = scene.surface_z;
        if (region.kind == static_cast<std::uint32_t>(plan::BodyKind::kFixture))
          origin = vec(scene.fixture_position);
        skill.region = policy::Skill::Box{vec(region.low) + origin, vec(region.high) + origin, {}};
        if (const auto box = plan::turned_box(plan.tables(), record.region))
          skill.region = policy::Skill::Box{
              -vec(box->half), vec(box->half), {vec(box->middle) + origin, to_quat(box->rotation)}};
        if (const auto owner = plan::owner_of(plan.tables(), task, region))
          to = seen_of(*owner, bodies);
      }
      skill.to_object = to.object;
      skill.to_fixture = to.fixture;
    }
    const bool was_picked = !solution.empty() && solution.back().kind == Kind::kPick &&
                            solution.back().object == skill.object;
    if (skill.kind == Kind::kPut && was_picked) solution.pop_back();
    solution.push_back(skill);
  }
  return solution;
}

std::vector<int> wrong_fixtures_of(const plan::Plan& plan, const plan::TaskRecord& task,
                                   const TaskBodies& bodies) {
  std::vector<int> found;
  for (const plan::RoleRecord& role : plan::roles_of(plan.tables(), task).things) {
    if (role.kind != static_cast<std::uint32_t>(plan::RoleKind::kPartDistractor)) continue;
    if (const int at = seen_of(role.first, bodies).fixture; at >= 0) found.push_back(at);
  }
  return found;
}

}  // namespace probe::stage
