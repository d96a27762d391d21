// Drop, settle, look: once a scene.
#include "runtime/doctor/golden_starts.h"

#include <set>

#include "runtime/stage/assets.h"
#include "runtime/stage/stage.h"

namespace probe::doctor {
namespace {

Result<std::vector<GoldenFrame>> draw_task(const plan::Plan& plan, const std::string& root,
                                           std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[index];
  const std::uint32_t tasks[] = {index};
  PROBE_ASSIGN(const auto assets, stage::SharedAssets::load(plan, root, tasks));
  const plan::CameraRecord& camera = plan.cameras()[task.camera];
  const stage::ImageSize half{static_cast<int>(camera.width + 1) / 2,
                              static_cast<int>(camera.height + 1) / 2};
  PROBE_ASSIGN(const auto stage, stage::Stage::create(plan, index, assets, {.image = half}));
  PROBE_TRY(stage->reset(0));
  PROBE_TRY(stage->observe());
  std::string name = "start_";
  name.append(plan.text(plan.scenes()[task.scene].name)).append("_").append(plan.text(task.name));
  std::vector<GoldenFrame> frames;
  for (const stage::CameraFrame& picture : stage->frames()) {
    const render::FrameView& frame = picture.frame;
    frames.push_back({frames.empty() ? name : name + "_" + std::string(picture.camera),
                      frame.width,
                      frame.height,
                      {frame.rgb.begin(), frame.rgb.end()},
                      {frame.depth.begin(), frame.depth.end()},
                      {frame.segmentation.begin(), frame.segmentation.end()}});
  }
  return frames;
}

}  // namespace

Result<std::vector<GoldenFrame>> draw_first_frames(const plan::Plan& plan,
                                                   const std::string& root) {
  std::vector<GoldenFrame> frames;
  std::set<std::uint32_t> shown;
  for (std::uint32_t index = 0; index < plan.tasks().size(); ++index) {
    if (!shown.insert(plan.tasks()[index].scene).second) continue;
    PROBE_ASSIGN(auto drawn, draw_task(plan, root, index));
    for (GoldenFrame& frame : drawn) frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace probe::doctor
