// How a task can be solved, in terms of what policies that see everything see.
#pragma once

#include <span>
#include <vector>

#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/stage/task_bodies.h"

namespace probe::stage {

// Of one task, as its plan says or as it was derived. What is picked and put at once is put.
std::vector<policy::Skill> solution_of(const plan::Plan& plan,
                                       std::span<const plan::SkillRecord> skills,
                                       const TaskBodies& bodies);

// The parts among a task's distractors, in Privileged::fixtures.
std::vector<int> wrong_fixtures_of(const plan::Plan& plan, const plan::TaskRecord& task,
                                   const TaskBodies& bodies);

}  // namespace probe::stage
