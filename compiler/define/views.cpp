#include "compiler/define/views.h"

#include <algorithm>

namespace probe::sema {

const View* view_named(const Scene& scene, std::string_view name) {
  const auto found = std::find_if(scene.views.begin(), scene.views.end(),
                                  [&](const View& view) { return view.name == name; });
  return found == scene.views.end() ? nullptr : &*found;
}

std::vector<View> views_of(const Model& model, const Task& task) {
  const Scene& scene = model.scenes[task.scene];
  std::vector<View> views = scene.views;
  for (const Task::OtherCamera& other : task.cameras) {
    const View* named = other.as ? view_named(scene, other.as->text) : nullptr;
    if (views.empty() || (other.as && named == nullptr)) continue;  // reported
    View& view = views[named == nullptr ? 0 : static_cast<std::size_t>(named - scene.views.data())];
    view.camera = other.camera;
    view.is_named = view.is_named || other.as.has_value();
  }
  return views;
}

bool has_names(const std::vector<View>& views) {
  return views.size() > 1 || (views.size() == 1 && views.front().is_named);
}

LightId light_of(const Model& model, const Task& task) {
  return task.light != LightId::kNone ? task.light : model.scenes[task.scene].light;
}

}  // namespace probe::sema
