// What the axes of a comparison are called, in the order in which they are listed everywhere.
#pragma once

#include <array>
#include <string_view>

#include "runtime/plan/format.h"

namespace probe::plan {

struct AxisName {
  Axis axis;
  std::string_view name;
};

inline constexpr std::array<AxisName, 13> kAxisNames = {{
    {Axis::kObjectSource, "object.source"},
    {Axis::kObjectTarget, "object.target"},
    {Axis::kDistractors, "distractors"},
    {Axis::kLanguageAction, "language.action"},
    {Axis::kLanguageNegation, "language.negation"},
    {Axis::kLanguageAppearance, "language.appearance"},
    {Axis::kLanguageCommonsense, "language.commonsense"},
    {Axis::kLanguageParaphrase, "language.paraphrase"},
    {Axis::kLayout, "layout"},
    {Axis::kScene, "scene"},
    {Axis::kLight, "light"},
    {Axis::kCamera, "camera"},
    {Axis::kGoal, "goal"},
}};

}  // namespace probe::plan
