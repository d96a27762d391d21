// Two tasks of one plan side by side: which axes differ, and which of the four identities are
// equal.
#pragma once

#include <string>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// {a, b, baseline, axes[], declared_axes, equal{starts, episodes, of, prompt, judge, program},
// left, right, words_a[], words_b[]}. `baseline` is "a" or "b" when one is declared as the other's
// baseline, else null, and so is `declared_axes`. Starts and episodes are compared at equal index;
// `of` is the larger number of the two. `left` and `right` are {prompt, source, target,
// roles {} and placed[] where there are any, distractors[], baseline, scene, camera, light,
// horizon, metrics[], instructions, episodes}; a word is {text, differs}.
Json diff_tasks(const plan::Plan& plan, std::uint32_t a, std::uint32_t b);
// A table of two columns with a star at the lines that differ, then axes and identities.
std::string diff_text(const Json& diff);

}  // namespace probe::inspect
