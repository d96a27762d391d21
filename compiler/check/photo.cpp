// P0304: a photo behind the picture of a camera that jitters. It was taken from one place, and the
// camera stands elsewhere in each start.
#include <set>
#include <utility>

#include "compiler/check/check.h"
#include "compiler/define/views.h"

namespace probe::sema {

void check_photos(const Model& model, Reporter& reporter) {
  std::set<std::pair<CameraId, SceneId>> said;
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    for (const View& view : views_of(model, task)) {
      const Camera& camera = model.cameras[view.camera];
      if (!camera.jitters() || !view.overlay || !said.emplace(view.camera, task.scene).second)
        continue;
      report_of(reporter, Situation::kPhotoShaken, task, camera.jitter_span,
                "`" + camera.name + "` jitters, and the photo `" + view.overlay->text +
                    "` behind its picture in `" + task.name + "` is from one place")
          .label(view.overlay->span, "the photo")
          .help("a scene without it, `scene S like " + model.scenes[task.scene].name +
                " { camera ... }`, shows its meshes instead");
    }
  }
}

}  // namespace probe::sema
