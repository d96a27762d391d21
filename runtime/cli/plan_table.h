// Verbs that say one thing of all tasks of a file: F, --suite, --json; one function makes JSON of
// the chosen tasks, another text of that JSON.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "runtime/cli/load.h"

namespace probe::cli {

struct PlanTable {
  const char* name;
  const char* about;
  const char* footer;
  const char* json;  // what --json gives
  std::function<nlohmann::ordered_json(const LoadedPlan&, std::span<const std::uint32_t>)> make;
  std::string (*text)(const nlohmann::ordered_json&);
};
void add_plan_table(Verb app, int& exit, PlanTable table);

}  // namespace probe::cli
