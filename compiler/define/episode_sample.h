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

}  // namespace probe::sema
