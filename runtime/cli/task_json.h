// What `list` and `show` say of a task, as JSON with the documented keys.
#pragma once

#include <nlohmann/json.hpp>

#include "runtime/plan/plan.h"

namespace probe::cli {

// {task, baseline, axes[], categories[], prompt, episodes}
nlohmann::ordered_json summarise(const plan::Plan& plan, std::uint32_t task);
// The same and source, target, distractors[], horizon, metrics, starts.
nlohmann::ordered_json describe(const plan::Plan& plan, std::uint32_t task);

}  // namespace probe::cli
