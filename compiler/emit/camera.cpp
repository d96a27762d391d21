// Cameras as records, and the views that a task sees.
#include "compiler/emit/emitter.h"
#include "runtime/scene/photo_shape.h"

namespace probe::emit {

void Emitter::add_camera(sema::CameraId id) {
  if (!cameras_.add(id, size32(records().cameras))) return;
  const sema::Camera& camera = model_.cameras[id];
  plan::CameraRecord record;
  record.name = writer_.text(camera.name);
  record.mount_link = writer_.text(camera.mount_link.text);
  record.aim = static_cast<std::uint32_t>(camera.aim);
  record.width = camera.width;
  record.height = camera.height;
  record.samples = camera.samples;
  record.position = camera.position;
  record.aim_values = camera.aim_values;
  record.fx = camera.fx;
  record.fy = camera.fy;
  record.cx = camera.cx;
  record.cy = camera.cy;
  if (camera.has_sensor())
    record.sensor =
        plan::append(records().sensors, std::span<const plan::SensorRecord>(&camera.sensor, 1));
  records().cameras.push_back(record);
}

plan::Slice Emitter::add_views(const std::vector<sema::View>& views, sema::SceneId scene) {
  const AssetOwner owner{AssetOwner::Kind::kScene, static_cast<std::uint32_t>(scene)};
  std::vector<plan::ViewRecord> rows;
  std::vector<std::uint32_t> key;
  for (const sema::View& view : views) {
    const std::uint32_t photo =
        rows.empty() ? records().scenes[scenes_[scene]].photo : add_photo(view.overlay, owner);
    check_photo(view, scene, photo);
    rows.push_back({writer_.text(view.name), cameras_[view.camera], photo});
    const plan::ViewRecord& row = rows.back();
    key.insert(key.end(), {row.name.offset, row.name.length, row.camera, row.photo});
  }
  const auto [at, is_new] = views_.try_emplace(std::move(key), plan::Slice{});
  if (is_new) at->second = plan::append(records().views, std::span<const plan::ViewRecord>(rows));
  return at->second;
}

void Emitter::check_photo(const sema::View& view, sema::SceneId scene, std::uint32_t photo) {
  if (photo == plan::kNone) return;
  const sema::Camera& camera = model_.cameras[view.camera];
  const robot::RobotModel& robot = *model_.robots[model_.scenes[scene].robot].model;
  const int mount = robot.find_link(camera.mount_link.text);
  if (mount < 0 || !robot.is_fixed(mount)) return;  // one that moves sees meshes and no photo
  const auto size = assets_.image_size(photo);
  if (!size) return;  // told where files are looked at
  const auto defect = scene::photo_defect(*size, camera.width, camera.height);
  if (!defect || !photo_told_.emplace(photo, view.camera).second) return;
  const std::string& path = assets_.assets()[photo].path;
  Diagnostic& said = diagnostics_.report(Situation::kPhotoShape, camera.span,
                                         "`" + camera.name + "`, photo `" + path + "`: " + *defect);
  if (view.overlay) said.label(view.overlay->span, "the photo");
  said.label(model_.scenes[scene].span, "the scene");
}

}  // namespace probe::emit
