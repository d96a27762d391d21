// Which parts of fixtures a judged question is about: those whose joints, contacts or places its
// program measures. Who is asked has to see them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/plan/plan.h"

namespace probe::ask {

struct MeasuredPart {
  std::string name;                   // as instructions call it, else as a body
  std::vector<std::uint32_t> bodies;  // task-local: the links that its joint moves, or itself
};

// In the order of the task's bodies; none where nothing is judged.
std::vector<MeasuredPart> measured_parts(const plan::Plan& plan,
                                         const plan::QuestionRecord& question);

}  // namespace probe::ask
