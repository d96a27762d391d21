// Two plans: which tasks are only in one, and in which identities the others changed. Episodes of
// equal identity are the same experiment, so their results can be kept.
#pragma once

#include <string>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// {a, b, only_a[], only_b[], changed[], equal, questions}: the roots, names of tasks, how many
// tasks are equal in all four, and diff_questions of question_json.h. A changed task is {task,
// prompt, judge, claims, solution (the last two false where they differ), starts, episodes, of_a,
// of_b}: whether the ids are equal, how many of starts and episodes are at equal index, and their
// numbers.
Json diff_plans(const plan::Plan& a, const plan::Plan& b);
std::string plan_diff_text(const Json& diff);

}  // namespace probe::inspect
