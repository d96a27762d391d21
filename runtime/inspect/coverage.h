// What a suite varies and what it does not: for each task without a baseline the number of
// comparisons below it on each axis. Knows only what a plan holds, so nothing of phrases.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "runtime/plan/plan.h"

namespace probe::inspect {

// {axes[], bases[], total{}, empty, cells, objects{never_source[], never_target[],
// never_distractor[]}}. A base is {task, variants, confounded, axes{name: number}}: variants count
// wherever they hang below it, on each axis that differs from their own baseline; `confounded`
// ones differ on more than one. Objects are those of the plan; of `tasks` alone is counted.
nlohmann::ordered_json coverage(const plan::Plan& plan, std::span<const std::uint32_t> tasks);
// A table with a dot in every empty cell.
std::string coverage_text(const nlohmann::ordered_json& coverage);

}  // namespace probe::inspect
