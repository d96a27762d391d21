#include "runtime/libero/goal.h"

#include <algorithm>
#include <iterator>

#include "runtime/base/check.h"

namespace probe::libero {
namespace {

enum class When { kFirst, kPut, kLast };

struct SkillRow {
  std::string_view predicate, skill;
  When when;
};
constexpr SkillRow kSkills[] = {
#define LIBERO_PREDICATE(word, arguments, skill, when) {#word, skill, When::when},
#include "runtime/libero/predicates.def"
#undef LIBERO_PREDICATE
};

const SkillRow& row_of(const BddlFact& fact) {
  const auto row = std::ranges::find(kSkills, fact.predicate, &SkillRow::predicate);
  PROBE_CHECK(row != std::end(kSkills), "predicates were checked when they were read");
  return *row;
}

bool is_same(const BddlFact& a, const BddlFact& b) {
  return a.predicate == b.predicate && a.arguments == b.arguments;
}

bool holds_first(const BddlProblem& problem, const BddlFact& fact) {
  return std::ranges::any_of(problem.init,
                             [&](const BddlFact& known) { return is_same(known, fact); });
}

// The thing itself, of a region as well.
const std::string& thing_at(const BddlProblem& problem, const std::string& place) {
  const BddlRegion* region = problem.find_region(place);
  return region == nullptr ? place : region->target;
}

// A role is filled by what has a body; a part of the table has none.
std::string place_in_role(const BddlProblem& problem, const std::string& place) {
  const BddlRegion* region = problem.find_region(place);
  return region != nullptr && !region->ranges.empty() ? std::string() : place;
}

}  // namespace

GoalRoles roles_of(const BddlProblem& problem) {
  GoalRoles roles;
  std::vector<const BddlFact*> puts, joints;
  for (const BddlFact& fact : problem.goal) {
    const bool is_put = row_of(fact).when == When::kPut;
    if (is_put || fact.predicate != "up") (is_put ? puts : joints).push_back(&fact);
  }
  if (puts.empty()) {
    if (joints.size() == 1) roles.target = joints.front()->arguments[0];
  } else if (puts.size() <= 2) {
    const BddlFact &one = *puts.front(), &two = *puts.back();
    const std::string &a = one.arguments[0], &b = two.arguments[0];
    const bool is_pair = puts.size() == 2;
    const bool is_stack = is_pair && (a == b || thing_at(problem, one.arguments[1]) == b ||
                                      thing_at(problem, two.arguments[1]) == a);
    if (is_stack) return {};
    roles.source = a;
    roles.target = place_in_role(problem, one.arguments[1]);
    if (is_pair) {
      roles.helper = b;
      const std::string other = place_in_role(problem, two.arguments[1]);
      if (other != roles.target) roles.helper_target = other;
    }
  }
  if (roles.empty()) return {};
  const auto is_in_role = [&](const std::string& name) {
    return name == roles.source || name == roles.helper ||
           name == thing_at(problem, roles.target) ||
           name == thing_at(problem, roles.helper_target);
  };
  for (const BddlThing& object : problem.objects) {
    if (!is_in_role(object.name)) roles.distractors.push_back(object.name);
  }
  return roles;
}

std::vector<BddlFact> steps_of(const BddlProblem& problem,
                               const std::function<bool(const BddlRegion&)>& is_closable) {
  std::vector<BddlFact> steps;
  for (const BddlFact& fact : problem.goal) {
    if (!holds_first(problem, fact)) steps.push_back(fact);
  }
  const auto is_put = [](const BddlFact& fact) { return row_of(fact).when == When::kPut; };
  // Joints alone move as they are said.
  if (std::ranges::none_of(steps, is_put)) return steps;
  std::vector<BddlFact> opened;
  for (const BddlFact& step : steps) {
    const BddlRegion* into =
        step.predicate == "in" ? problem.find_region(step.arguments[1]) : nullptr;
    if (into == nullptr || !is_closable(*into)) continue;
    const BddlFact open{"open", {into->name}, step.spot};
    const auto is_open = [&](const BddlFact& fact) { return is_same(fact, open); };
    const bool is_said =
        std::ranges::any_of(steps, is_open) || std::ranges::any_of(opened, is_open);
    if (!is_said && !holds_first(problem, open)) opened.push_back(open);
  }
  steps.insert(steps.end(), opened.begin(), opened.end());
  std::stable_sort(steps.begin(), steps.end(), [](const BddlFact& a, const BddlFact& b) {
    return row_of(a).when < row_of(b).when;
  });
  // What the other stands on comes first; of a circle, which nothing can make so, as it is said.
  const auto puts_from = std::ranges::find_if(steps, is_put);
  const auto puts_to = std::find_if_not(puts_from, steps.end(), is_put);
  for (auto at = puts_from; at != puts_to; ++at) {
    const auto free = std::find_if(at, puts_to, [&](const BddlFact& put) {
      return std::none_of(at, puts_to, [&](const BddlFact& other) {
        return other.arguments[0] != put.arguments[0] &&
               other.arguments[0] == thing_at(problem, put.arguments[1]);
      });
    });
    if (free != puts_to) std::rotate(at, free, free + 1);
  }
  return steps;
}

std::string skill_text(const BddlFact& fact, const std::vector<std::string>& arguments) {
  std::string_view rest = row_of(fact).skill;
  std::string text;
  for (const std::string& argument : arguments) {
    const std::size_t at = rest.find("{}");
    PROBE_CHECK(at != rest.npos, "a skill has a place for each argument");
    text += std::string(rest.substr(0, at)) + argument;
    rest.remove_prefix(at + 2);
  }
  return text + std::string(rest);
}

}  // namespace probe::libero
