// Verbs that say one thing of all tasks of a file: F, --suite, --json; one function makes JSON of
// the chosen tasks, another text of that JSON.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "runtime/base/json.h"
#include "runtime/cli/load.h"

namespace probe::cli {

struct PlanTable {
  const char* name;
  const char* about;
  const char* footer;
  const char* json;  // what --json gives
  std::function<Json(const LoadedPlan&, std::span<const std::uint32_t>)> make;
  std::string (*text)(const Json&);
};
void add_plan_table(Verb app, int& exit, PlanTable table);

}  // namespace probe::cli
