// Cameras as records, and the views that a task sees.
#include "compiler/emit/emitter.h"

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
    rows.push_back({writer_.text(view.name), cameras_[view.camera], photo});
    const plan::ViewRecord& row = rows.back();
    key.insert(key.end(), {row.name.offset, row.name.length, row.camera, row.photo});
  }
  const auto [at, is_new] = views_.try_emplace(std::move(key), plan::Slice{});
  if (is_new) at->second = plan::append(records().views, std::span<const plan::ViewRecord>(rows));
  return at->second;
}

}  // namespace probe::emit
