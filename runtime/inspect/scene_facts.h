// Where a scene's robot, surface and fixtures are, what is behind them and its physics, as people
// read it: what a task may change of a scene in place, so that the scene's name stays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/plan/plan.h"

namespace probe::inspect {

struct SceneFact {
  const char* name;  // "base", "area", "physics", ...
  std::string text;
  bool operator==(const SceneFact& other) const { return text == other.text; }
};

std::vector<SceneFact> scene_facts(const plan::Plan& plan, std::uint32_t scene);

// Of a scene whose name another one of the plan has, too: those that differ from some such scene.
std::vector<SceneFact> facts_in_place(const plan::Plan& plan, std::uint32_t scene);

}  // namespace probe::inspect
