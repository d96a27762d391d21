// `sample N episodes of S seed K` in a suite: some starts of tasks in place of all.
#pragma once

#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

struct EpisodeSample {
  const syntax::SuiteSampleStmt* stmt = nullptr;
  std::vector<TaskId> of;
};

// Adds to the suite, behind the members that it runs whole, those of which it runs some starts; and
// which of these are without what they are compared with. Every episode draws from the name of its
// task and its number, so another task or start changes at most one of the choice.
void sample_episodes(Context& context, const std::vector<EpisodeSample>& samples, Suite& suite);

// Whether the starts of two tasks correspond one by one: what is compared is then compared start by
// start, else only in the mean. As the report pairs them: one scene, as many starts, and what fills
// roles at the same places.
bool starts_correspond(const Task& a, const Task& b);

}  // namespace probe::sema
