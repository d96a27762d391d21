#include "runtime/inspect/skills_json.h"

#include <algorithm>

#include "runtime/plan/skills.h"

namespace probe::inspect {

void add_solution(const plan::Plan& plan, std::uint32_t task, Json& json) {
  for (const plan::SkillRecord& skill : plan::skills_of(plan.tables(), task))
    json["solution"].push_back(plan::skill_text(plan.tables(), skill));
}

bool same_solution(const plan::Plan& a, std::uint32_t ours, const plan::Plan& b,
                   std::uint32_t theirs) {
  return std::ranges::equal(plan::skills_of(a.tables(), ours), plan::skills_of(b.tables(), theirs),
                            [&](const plan::SkillRecord& p, const plan::SkillRecord& q) {
                              return p.amount == q.amount && plan::skill_text(a.tables(), p) ==
                                                                 plan::skill_text(b.tables(), q);
                            });
}

}  // namespace probe::inspect
