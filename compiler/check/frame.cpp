// P0505 as a warning: an object outside the image of every camera that does not move.
#include <algorithm>
#include <cmath>

#include "compiler/check/starts.h"
#include "compiler/define/camera_shake.h"
#include "compiler/define/views.h"
#include "compiler/geometry/in_frame.h"

namespace probe::sema {

// One warning for the task, of the object that is the farthest out of every camera that does not
// move.
void check_frame(const TaskStarts& starts) {
  const Scene& scene = starts.model.scenes[starts.task.scene];
  const std::vector<View> views = views_of(starts.model, starts.task);
  const Camera* first = nullptr;
  bool jitters = false;
  // Of cameras that jitter as they stand in one start. A frustum speaks of its camera.
  std::vector<Camera> seen;
  std::vector<Frustum> fixed;
  const auto look = [&](std::size_t start) {
    const std::vector<double> shakes = shakes_of(starts.model, views, start);
    seen.clear();
    fixed.clear();
    seen.reserve(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
      seen.push_back(shaken(starts.model.cameras[views[i].camera], shakes, i));
      const auto frustum = Frustum::of(starts.model, scene, seen.back());
      if (!frustum) continue;
      if (fixed.empty()) first = &starts.model.cameras[views[i].camera];
      fixed.push_back(*frustum);
      jitters = jitters || seen.back().jitters();
    }
  };
  look(0);
  if (fixed.empty()) return;
  const Camera& camera = *first;
  constexpr double kBehind = 1e9;  // px
  double most = 0;
  std::size_t bad = 0, all = 0, episode = 0;
  const Start::Placed* worst = nullptr;
  for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
    if (jitters && e > 0) look(e);
    for (const Start::Placed& placed : starts.task.starts[e].placed) {
      ++all;
      double out = kBehind;
      for (const Frustum& frustum : fixed)
        out = std::min(out, frustum.outside(starts.object(placed), placed).value_or(1e10));
      if (out < 1) continue;  // part of a pixel is no loss
      ++bad;
      if (out <= most) continue;
      most = out;
      episode = e;
      worst = &placed;
    }
  }
  if (worst == nullptr) return;
  const std::string how = most < kBehind
                              ? "lies " + std::to_string(static_cast<long>(std::ceil(most))) +
                                    " pixels outside the image of"
                              : "lies behind";
  Diagnostic& said = starts.reporter.report(Situation::kOutOfFrame, starts.place({worst->object}),
                                            "`" + starts.object(*worst).name + "` " + how + " `" +
                                                camera.name + "` in `" + starts.task.name + "`; " +
                                                std::to_string(bad) + " of " + std::to_string(all) +
                                                " objects are mostly out of view in this task");
  said.severity = Severity::kWarning;
  said.cause = cause_of(starts.layout.span, {camera.name, starts.object(*worst).name});
  said.point("episode " + std::to_string(episode) + ": " + at(starts.object(*worst), *worst))
      .label(camera.span, "the camera")
      .label(starts.layout.span, "the layout");
}

}  // namespace probe::sema
