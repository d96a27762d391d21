// Lights as records.
#include <fmt/format.h>

#include <string>

#include "compiler/define/views.h"
#include "compiler/emit/emitter.h"

namespace probe::emit {

void Emitter::add_light(sema::LightId id) {
  if (!lights_.add(id, size32(records().lights))) return;
  const sema::Light& light = model_.lights[id];
  plan::LightRecord record;
  record.name = writer_.text(light.name);
  record.ambient = light.ambient;
  record.occlusion = light.occlusion;
  record.color = light.color;
  record.suns = plan::append(records().suns, std::span<const plan::SunRecord>(light.suns));
  record.shading = light.lights_vertices ? 1 : 0;
  record.lamps = plan::append(records().lamps, std::span<const plan::LampRecord>(light.lamps));
  records().lights.push_back(record);
}

void Emitter::check_shading(const sema::Task& task, const std::vector<sema::View>& views) {
  const sema::LightId id = light_of(model_, task);
  const sema::Light& light = model_.lights[id];
  if (!light.lights_vertices) return;
  const sema::Scene& scene = model_.scenes[task.scene];
  const robot::RobotModel& robot = *model_.robots[scene.robot].model;
  const auto tell = [&](const sema::Camera& camera, const std::string& message) -> Diagnostic& {
    return diagnostics_.report(Situation::kShading, camera.span, message)
        .label(light.span, "has `shading vertex`")
        .label(task.span, "is seen so");
  };
  for (std::size_t i = 0; i < views.size(); ++i) {
    const sema::Camera& camera = model_.cameras[views[i].camera];
    constexpr std::uint32_t kMostSamples = 4;
    // A camera that moves sees meshes, whatever photo is there.
    const int mount = robot.find_link(camera.mount_link.text);
    const bool has_photo = (i == 0 ? records().scenes[scenes_[task.scene]].photo != plan::kNone
                                   : views[i].overlay.has_value()) &&
                           mount >= 0 && robot.is_fixed(mount);
    if (!has_photo && camera.samples <= kMostSamples) continue;
    if (!shading_told_.emplace(id, views[i].camera).second) continue;
    if (has_photo)
      tell(camera, "`shading vertex` has no photo, and there is one behind this camera's picture")
          .help("a `backdrop` of meshes stands behind such a picture");
    if (camera.samples > kMostSamples)
      tell(camera, fmt::format("`shading vertex` has 1 or 4 samples a pixel, this camera {}",
                               camera.samples));
  }
}

}  // namespace probe::emit
