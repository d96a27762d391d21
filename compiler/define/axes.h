// What differs between a variant and its baseline, and what lies outside the training data.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// A mask of plan::Axis over the normalised records; names do not count.
std::uint32_t axes_between(const Model& model, const Task& task, const Task& baseline);
// "object.source", "language.action" ...
std::string_view axis_name(plan::Axis axis);
std::vector<plan::Axis> axes_in(std::uint32_t mask);

// Bits 1 source, 2 target, 4 relation. The relation is new only when both objects are known.
std::uint32_t out_of_distribution(const Model& model, const Task& task);

// Whether the verb frame differs from that of the first task along the baselines.
bool uses_action(const Model& model, const Task& task);
// Whether other words than those of that first task are said, in the same verb frame.
bool uses_paraphrase(const Model& model, const Task& task);
bool uses_phrase(const Model& model, const Task& task, PhraseAxis axis);

// The scene's views with the task's own cameras in their places; the first is the main one.
std::vector<View> views_of(const Model& model, const Task& task);
// Whether the plan keeps their names: a scene's only camera has its own, unless `as` gave one.
bool has_names(const std::vector<View>& views);
// Null when there is none.
const View* view_named(const Scene& scene, std::string_view name);
LightId light_of(const Model& model, const Task& task);

}  // namespace probe::sema
