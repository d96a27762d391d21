#include "runtime/expert/open_first.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace probe::expert {
namespace {

constexpr double kHalfOpen = 0.5;  // of the way, as in runtime/vm/derived_solution

// Whether a point lies within the box around a part, as it stands.
bool is_within(const policy::PrivilegedFixture& part, const Vec3& point) {
  const Vec3 own = part.pose.inverse().apply(point);
  Vec3 low = Vec3::Constant(1e9), high = Vec3::Constant(-1e9);
  for (const auto& convex : part.parts) {
    for (const Vec3& vertex : convex) low = low.cwiseMin(vertex), high = high.cwiseMax(vertex);
  }
  return (own.array() >= low.array()).all() && (own.array() <= high.array()).all();
}

bool is_closed(const policy::PrivilegedFixture::Joint& joint) {
  const double way = joint.upper - joint.lower;
  return !joint.endless && way > 0 &&
         std::abs(joint.position - joint.closed) < kHalfOpen * way;
}

// What stands about an object and slides or turns open; -1 for nothing.
int closed_about(const policy::Privileged& view, int object) {
  const auto& thing = view.objects[static_cast<std::size_t>(object)];
  const Vec3 at = thing.pose.apply(thing.center_of_mass.value_or(Vec3::Zero()));
  for (std::size_t i = 0; i < view.fixtures.size(); ++i) {
    const policy::PrivilegedFixture& part = view.fixtures[i];
    if (part.joint && part.joint->slides && is_closed(*part.joint) && is_within(part, at))
      return static_cast<int>(i);
  }
  return -1;
}

// What the goal asks of the source, as skills.
std::optional<policy::Skill> skill_of_goal(const policy::Privileged& view) {
  policy::Skill skill;
  skill.object = view.source;
  if (view.source < 0) return std::nullopt;
  if (view.goal == policy::Goal::kLifted) return skill;
  if (view.goal != policy::Goal::kOnTarget || view.target < 0) return std::nullopt;
  skill.kind = policy::Skill::Kind::kPut;
  skill.to_object = view.target;
  return skill;
}

}  // namespace

std::vector<policy::Skill> opened_first(const policy::Privileged& view,
                                        std::vector<policy::Skill> skills) {
  const auto takes = [](const policy::Skill& skill) { return skill.object >= 0; };
  const auto goal = skill_of_goal(view);
  const auto first = std::ranges::find_if(skills, takes);
  const int object = first != skills.end()         ? first->object
                     : skills.empty() && goal      ? goal->object
                                                   : -1;
  if (object < 0) return skills;
  const int part = closed_about(view, object);
  if (part < 0) return skills;
  const auto& joint = *view.fixtures[static_cast<std::size_t>(part)].joint;
  const bool is_moved = std::any_of(skills.begin(), first, [&](const policy::Skill& skill) {
    if (skill.fixture < 0) return false;
    const auto& moved = view.fixtures[static_cast<std::size_t>(skill.fixture)].joint;
    return moved && moved->number == joint.number;
  });
  if (is_moved) return skills;
  policy::Skill opening;
  opening.kind = policy::Skill::Kind::kOpen;
  opening.fixture = part;
  const std::string name = view.objects[static_cast<std::size_t>(object)].name;
  opening.name = "opening `" + view.fixtures[static_cast<std::size_t>(part)].name + "`, in which `" +
                 name + "` begins";
  if (skills.empty()) {
    skills.push_back(*goal);
    skills.back().name = goal->kind == policy::Skill::Kind::kPut
                             ? "putting `" + name + "` on `" +
                                   view.objects[static_cast<std::size_t>(view.target)].name + "`"
                             : "picking `" + name + "`";
  }
  skills.insert(skills.begin(), std::move(opening));
  return skills;
}

}  // namespace probe::expert
