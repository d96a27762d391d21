// What a task is seen by: the scene's cameras and light with the task's own in their places.
#pragma once

#include <string_view>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// The scene's views with the task's own cameras in their places; the first is the main one.
std::vector<View> views_of(const Model& model, const Task& task);
// Whether the plan keeps their names: a scene's only camera has its own, unless `as` gave one.
bool has_names(const std::vector<View>& views);
// Null when there is none.
const View* view_named(const Scene& scene, std::string_view name);
LightId light_of(const Model& model, const Task& task);

}  // namespace probe::sema
