// The scripted expert: shows that a task can be solved in its time by someone who sees everything.
// It looks at the privileged view and acts through the seven numbers like any policy.
#pragma once

#include <memory>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"

namespace probe::expert {

struct ExpertOptions {
  int source = 0;     // what to take, as Privileged::object_of() counts roles...
  int target = 1;     // ...and where to put it; not read if close is false
  bool close = true;  // false: goes to the source and stays there with open fingers
};

// Tasks that it has no skills for fail with kNoSkill, a status of their own: in begin() where
// actions are late or the hand is none that it knows, in act() where there is neither a solution in
// skills nor a goal that one pick and place reaches. act() also fails (kPolicy) without the
// privileged view.
Result<std::unique_ptr<policy::Policy>> make_expert(const ExpertOptions& options);

}  // namespace probe::expert
