#include "runtime/render/top_scene.h"

#include <cmath>

#include "runtime/render/placing_check.h"

namespace probe::render {

Result<TopScene> TopScene::create(const std::vector<Visual>& visuals,
                                  std::vector<std::shared_ptr<const MeshGeometry>> meshes,
                                  Kind kind) {
  TopScene top;
  PROBE_ASSIGN(top.device_, EmbreeDevice::shared());
  RTCDevice device = top.device_->get();
  top.scene_.reset(rtcNewScene(device));
  const bool dynamic = kind == Kind::kDynamic;
  rtcSetSceneFlags(top.scene_.get(), dynamic ? static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                                          RTC_SCENE_FLAG_DYNAMIC)
                                             : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(top.scene_.get(),
                          dynamic ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_HIGH);
  for (std::size_t i = 0; i < visuals.size(); ++i) {
    const Visual& visual = visuals[i];
    PROBE_TRY(check_origin(visual));
    Instance instance;
    instance.geometry = std::move(meshes[i]);
    instance.origin = visual.origin;
    instance.id = static_cast<std::uint16_t>(visual.body + 1);
    instance.robot = visual.robot;
    instance.name = visual.name;
    GeometryPtr handle(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(handle.get(), instance.geometry->scene.get());
    if (dynamic) rtcSetGeometryMask(handle.get(), instance_bit(i));
    rtcAttachGeometryByID(top.scene_.get(), handle.get(),
                          static_cast<unsigned>(top.handles_.size()));
    top.instances_.push_back(std::move(instance));
    top.handles_.push_back(std::move(handle));
  }
  PROBE_TRY(top.device_->check("making instances"));
  return top;
}

Status TopScene::place(std::span<const Pose> poses) {
  PROBE_TRY(check_poses(poses, instances_.size(),
                        [this](std::size_t i) { return std::string(instances_[i].name); }));
  const bool is_first = !placed_;
  moved_ = is_first ? kAllInstances : 0;
  placed_ = true;
  bool any = is_first;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Instance& instance = instances_[i];
    const Pose pose = poses[i] * instance.origin;
    instance.exact_rotation = pose.rotation.toRotationMatrix();
    instance.exact_translation = pose.position;
    bool is_elsewhere = is_first;
    float columns[12];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const float value = static_cast<float>(instance.exact_rotation(r, c));
        if (instance.rotation[3 * r + c] != value) is_elsewhere = true;
        instance.rotation[3 * r + c] = value;
        instance.rows[r][c] = instance.columns[c][r] = value;
        columns[3 * c + r] = value;
      }
      const float value = static_cast<float>(pose.position[r]);
      if (instance.translation[r] != value) is_elsewhere = true;
      instance.translation[r] = columns[9 + r] = value;
    }
    if (!is_elsewhere) continue;  // as fixtures do most of the time
    any = true;
    moved_ |= instance_bit(i);
    rtcSetGeometryTransform(handles_[i].get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(handles_[i].get());
  }
  if (!any) return {};
  rtcCommitScene(scene_.get());
  return device_->check("placing instances");
}

InstanceSet RayOrigins::set(const TopScene& scene, const std::array<float, 3>& point) {
  InstanceSet changed = points_.size() == scene.instances().size() ? 0 : kAllInstances;
  points_.resize(scene.instances().size());
  const Vec3 from(point[0], point[1], point[2]);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Instance& instance = scene.instances()[i];
    const Vec3 eye = instance.exact_rotation.transpose() * (from - instance.exact_translation);
    for (int k = 0; k < 3; ++k) {
      float& coordinate = points_[i][static_cast<std::size_t>(k)];
      if (coordinate != static_cast<float>(eye[k])) changed |= instance_bit(i);
      coordinate = static_cast<float>(eye[k]);
    }
  }
  return changed;
}

}  // namespace probe::render
