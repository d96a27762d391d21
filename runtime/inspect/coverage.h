// What a suite varies and what it does not: for each task without a baseline the number of
// comparisons below it on each axis. Knows only what a plan holds, so nothing of phrases.
#pragma once

#include <span>
#include <string>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// {axes[], bases[], total{}, empty, cells, objects{never_source[], never_target[],
// never_distractor[]}}. A base is {task, variants, confounded, axes{name: number}, tasks,
// ood{source, target, relation}}: variants count wherever they hang below it, on each axis that
// differs from their own baseline; `confounded` ones differ on more than one; `tasks` are the base
// itself and all below it, of which `ood` counts those with something that was not seen in
// training. Objects are those of the plan; of `tasks` alone is counted.
Json coverage(const plan::Plan& plan, std::span<const std::uint32_t> tasks);
// Axis by base, with a dot in every empty cell; bases side by side as far as a screen is wide. Also
// says `unused_phrases`, an array of "object.phrase", where somebody added it.
std::string coverage_text(const Json& coverage);

}  // namespace probe::inspect
